/// Names of helpers, read from the sources. Several files of a folder are compiled at a time
/// (NEVE_UNITY), and which ones changes with every new file: a name that two files give to
/// different things would be an error, or quietly another overload, in one build and not in the
/// other.

#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace {

namespace fs = std::filesystem;

constexpr std::string_view letters =
    "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_";

/// Name declared by a line at the margin of an unnamed namespace, or nothing. clang-format has put
/// every declaration to the margin and all that belongs to it off it.
std::string declared_name(std::string_view line) {
  const auto word_at = [&](std::size_t begin) {
    return std::string(line.substr(begin, line.find_first_not_of(letters, begin) - begin));
  };
  if (const std::size_t end = line.find("]] "); line.starts_with("[[") && end != line.npos)
    line.remove_prefix(end + 3);
  if (line.empty() || !std::isalpha(static_cast<unsigned char>(line.front()))) return {};
  for (const char* other : {"TEST", "INSTANTIATE_", "template", "namespace", "using namespace"})
    if (line.starts_with(other)) return {};
  for (const std::string_view kind : {"struct ", "class ", "enum class ", "enum "})
    if (line.starts_with(kind)) return word_at(kind.size());
  const std::size_t end = line.find_first_of("({[=;");
  if (end == std::string_view::npos) return {};
  const std::size_t last = line.substr(0, end).find_last_of(letters);
  if (last == std::string_view::npos) return {};
  const std::size_t begin = line.substr(0, last + 1).find_last_not_of(letters);
  if (begin == std::string_view::npos) return {};
  // A member defined outside its class has the name of the class before it.
  const bool is_member = line[begin] == ':' && !line.starts_with("using ");
  return is_member ? "" : word_at(begin + 1);
}

struct Declaration {
  std::string name, line, file;
};

/// Names declared by the unnamed namespaces of a source, with the namespace around them.
std::vector<Declaration> helpers_of(const fs::path& file) {
  std::vector<Declaration> found;
  std::string around;
  bool is_unnamed = false, is_raw = false;
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);) {
    if (is_raw) {
      is_raw = line.find(")\"") == std::string::npos;
      continue;
    }
    if (line.starts_with("namespace {")) is_unnamed = true;
    if (line == "}  // namespace") is_unnamed = false;
    if (line.starts_with("namespace neve") && line.ends_with(" {"))
      around = line.substr(0, line.size() - 2);
    const std::size_t raw = line.find("R\"(");
    is_raw = raw != std::string::npos && line.find(")\"", raw) == std::string::npos;
    const std::string name = is_unnamed ? declared_name(line) : std::string();
    if (!name.empty()) found.push_back({name + " in " + around, line, file.string()});
  }
  return found;
}

bool is_compiled_with_others(const fs::path& file) {
  return file.extension() == ".cpp" && file.parent_path().filename() != "instruction_sets" &&
         file.stem().string().find("_avx") == std::string::npos;
}

/// All folders with sources.
std::vector<fs::path> source_folders() {
  std::vector<fs::path> folders;
  for (const char* top : {"app", "render", "sim", "tests"}) {
    folders.push_back(fs::path(NEVE_SOURCE_DIR) / top);
    for (const auto& entry : fs::recursive_directory_iterator(folders.back()))
      if (entry.is_directory()) folders.push_back(entry.path());
  }
  return folders;
}

TEST(Structure, HelpersOfAFolderHaveNamesOfTheirOwn) {
  std::size_t seen = 0;
  for (const fs::path& folder : source_folders()) {
    std::map<std::string, Declaration> first;
    for (const auto& entry : fs::directory_iterator(folder)) {
      if (!is_compiled_with_others(entry.path())) continue;
      for (const Declaration& d : helpers_of(entry.path())) {
        ++seen;
        const Declaration& other = first.emplace(d.name, d).first->second;
        // The same alias twice says the same.
        const bool is_alias = d.line.starts_with("using ") && d.line == other.line;
        EXPECT_TRUE(other.file == d.file || is_alias)
            << d.file << " and " << other.file << " both have a helper " << d.name
            << "; give them names of their own, or one header if they do the same";
      }
    }
  }
  EXPECT_GT(seen, 500u) << "the sources are not read as they are written";
}

TEST(Structure, NamesOfHelpersAreRead) {
  EXPECT_EQ(declared_name("double ratio(double a, double b) {"), "ratio");
  EXPECT_EQ(declared_name("constexpr std::array<int, 2> both{1, 2};"), "both");
  EXPECT_EQ(declared_name("const char* const text = R\"("), "text");
  EXPECT_EQ(declared_name("struct Case {"), "Case");
  EXPECT_EQ(declared_name("[[noreturn]] void fail(int line) {"), "fail");
  EXPECT_EQ(declared_name("using Cell = std::array<int, 3>;"), "Cell");
  EXPECT_EQ(declared_name("using sim::Vec3d;"), "Vec3d");
  EXPECT_EQ(declared_name("void Case::run() {"), "");
  EXPECT_EQ(declared_name("  int inside = 0;"), "");
  EXPECT_EQ(declared_name("TEST(Structure, NamesOfHelpersAreRead) {"), "");
}

}  // namespace

/// Every file includes what it uses of the standard library, itself or through headers of neve.
/// Precompiled headers, and files that are compiled together, would hide that it does not.

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "tests/structure/sources.h"

namespace neve::test {
namespace {

struct Header {
  std::string_view name, gives;
};

/// Names and their headers; headers that other headers contain (cstdint, utility) are omitted.
constexpr Header standard_headers[] = {
    {"algorithm",
     "all_of any_of binary_search clamp copy_if count_if equal_range fill_n find_if generate "
     "is_sorted "
     "lower_bound max_element min_element minmax_element none_of nth_element partial_sort "
     "remove_if "
     "replace reverse rotate set_difference set_intersection shuffle sort stable_sort transform "
     "unique "
     "upper_bound"},
    {"array", "array"},
    {"atomic", "atomic"},
    {"bit", "bit_cast bit_ceil bit_width countl_zero countr_zero popcount"},
    {"charconv", "from_chars to_chars"},
    {"chrono", "chrono"},
    {"cmath",
     "acos asin atan2 cbrt ceil copysign cos exp floor fmod hypot isfinite isnan llround log log10 "
     "log2 "
     "lround pow round sin sqrt tan trunc"},
    {"condition_variable", "condition_variable"},
    {"cstring", "memcmp memcpy memset strcmp strerror strlen"},
    {"deque", "deque"},
    {"filesystem", "filesystem"},
    {"fstream", "fstream ifstream ofstream"},
    {"functional", "function greater hash less plus"},
    {"iomanip", "setfill setprecision setw"},
    {"iostream", "cerr cin cout"},
    {"iterator", "back_inserter istreambuf_iterator ostream_iterator"},
    {"limits", "numeric_limits"},
    {"map", "map multimap"},
    {"memory", "make_shared make_unique shared_ptr unique_ptr"},
    {"mutex", "lock_guard mutex scoped_lock unique_lock"},
    {"numbers", "numbers"},
    {"numeric", "accumulate inner_product iota partial_sum"},
    {"optional", "nullopt optional"},
    {"random", "mt19937 mt19937_64 uniform_real_distribution"},
    {"regex", "regex"},
    {"set", "multiset set"},
    {"span", "span"},
    {"sstream", "istringstream ostringstream stringstream"},
    {"stdexcept", "invalid_argument logic_error out_of_range runtime_error"},
    {"string", "string to_string"},
    {"thread", "thread"},
    {"tuple", "make_tuple tie tuple"},
    {"unordered_map", "unordered_map"},
    {"unordered_set", "unordered_set"},
    {"variant", "get_if holds_alternative monostate variant visit"},
    {"vector", "vector"},
};

std::map<std::string, std::string> header_of_name() {
  std::map<std::string, std::string> header;
  for (const Header& h : standard_headers) {
    std::istringstream names{std::string(h.gives)};
    for (std::string name; names >> name;) header[name] = h.name;
  }
  return header;
}

/// One line without comments and texts.
std::string code_of(const std::string& line) {
  std::string code;
  bool is_text = false;
  for (std::size_t k = 0; k < line.size(); ++k) {
    if (is_text && line[k] == '\\') {
      ++k;
    } else if (line[k] == '"') {
      is_text = !is_text;
    } else if (!is_text && line.compare(k, 2, "//") == 0) {
      break;
    } else if (!is_text) {
      code += line[k];
    }
  }
  return code;
}

/// Includes of a file and its uses of std.
struct Source {
  std::set<std::string> standard, ours, used;
};

Source read_source(const std::string& file) {
  Source source;
  bool is_raw = false;
  for (const auto& [name, number, line] : lines_of(file)) {
    if (is_raw) {
      is_raw = line.find(")\"") == std::string::npos;
      continue;
    }
    if (const Include include = include_of(line); !include.name.empty()) {
      (include.is_ours ? source.ours : source.standard).insert(include.name);
      continue;
    }
    const std::size_t raw = line.find("R\"(");
    is_raw = raw != std::string::npos && line.find(")\"", raw) == std::string::npos;
    const std::string code = code_of(line.substr(0, raw));
    for (std::size_t at = 0; (at = code.find("std::", at)) != std::string::npos;) {
      at += 5;
      const std::size_t end = code.find_first_not_of(
          "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_", at);
      source.used.insert(code.substr(at, end - at));
    }
  }
  return source;
}

/// The standard headers that a file of neve brings, through others of neve too.
void add_standard(const std::string& file, const std::map<std::string, Source>& sources,
                  std::set<std::string>& seen, std::set<std::string>& standard) {
  const auto found = sources.find(file);
  if (found == sources.end() || !seen.insert(file).second) return;
  standard.insert(found->second.standard.begin(), found->second.standard.end());
  for (const std::string& next : found->second.ours) add_standard(next, sources, seen, standard);
}

TEST(Structure, FilesIncludeWhatTheyUseOfTheStandardLibrary) {
  std::map<std::string, Source> sources;
  for (const std::string& file : sources_below({"app", "render", "sim", "tests"}))
    sources[file] = read_source(file);
  const std::map<std::string, std::string> headers = header_of_name();
  std::size_t uses = 0;
  for (const auto& [file, source] : sources) {
    std::set<std::string> seen, standard;
    add_standard(file, sources, seen, standard);
    for (const std::string& name : source.used) {
      const auto header = headers.find(name);
      if (header == headers.end()) continue;
      ++uses;
      EXPECT_TRUE(standard.contains(header->second))
          << file << " uses std::" << name << " and does not include <" << header->second << ">";
    }
  }
  EXPECT_GT(uses, 1000u) << "the sources are not read as they are written";
}

TEST(Structure, UsesOfTheStandardLibraryAreRead) {
  EXPECT_EQ(code_of(R"(std::sort(a); // as std::map does)"), "std::sort(a); ");
  EXPECT_EQ(code_of(R"(f("std::set \" // ", std::less{});)"), "f(, std::less{});");
}

}  // namespace
}  // namespace neve::test

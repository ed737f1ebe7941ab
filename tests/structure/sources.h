#pragma once
/// The files of the repository as the structure tests read them. Files are named from its root.

#include <filesystem>
#include <fstream>
#include <initializer_list>
#include <string>
#include <vector>

namespace neve::test {

inline std::filesystem::path source_root() {
  return NEVE_SOURCE_DIR;
}

struct SourceLine {
  std::string file;
  int number;  ///< from 1
  std::string text;
};

/// Every line of a file; none if the file does not exist.
inline std::vector<SourceLine> lines_of(const std::string& file) {
  std::vector<SourceLine> lines;
  std::ifstream in(source_root() / file);
  for (std::string text; std::getline(in, text);)
    lines.push_back({file, static_cast<int>(lines.size()) + 1, text});
  return lines;
}

/// Headers and sources below some folders.
inline std::vector<std::string> sources_below(std::initializer_list<const char*> folders) {
  std::vector<std::string> files;
  for (const char* folder : folders)
    for (const auto& entry : std::filesystem::recursive_directory_iterator(source_root() / folder))
      if (entry.path().extension() == ".h" || entry.path().extension() == ".cpp")
        files.push_back(entry.path().lexically_relative(source_root()).generic_string());
  return files;
}

struct Include {
  std::string name;
  bool is_ours = false;  ///< between quotes
};

/// The file that a line includes; without a name for any other line.
inline Include include_of(const std::string& line) {
  if (!line.starts_with("#include")) return {};
  const std::size_t begin = line.find_first_of("<\"") + 1;
  return {line.substr(begin, line.find_first_of(">\"", begin) - begin), line[begin - 1] == '"'};
}

}  // namespace neve::test

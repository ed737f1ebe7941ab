/// The documentation names files and folders that exist, and its map has every folder.

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include "tests/structure/folders.h"

namespace neve::test {
namespace {

namespace fs = std::filesystem;

struct PageLine {
  std::string page;  ///< from the root
  int number;
  std::string text;
};

/// Every line of the README and of the pages in docs.
std::vector<PageLine> lines_of_pages() {
  const fs::path root = NEVE_SOURCE_DIR;
  std::vector<fs::path> pages{root / "README.md"};
  for (const auto& entry : fs::directory_iterator(root / "docs"))
    if (entry.path().extension() == ".md") pages.push_back(entry.path());
  std::vector<PageLine> lines;
  for (const fs::path& page : pages) {
    std::ifstream in(page);
    int number = 0;
    for (std::string text; std::getline(in, text);)
      lines.push_back({page.lexically_relative(root).generic_string(), ++number, text});
  }
  return lines;
}

/// All texts that fit the first group of a pattern.
std::vector<std::string> found_in(const std::string& text, const char* pattern) {
  const std::regex expression(pattern);
  std::vector<std::string> found;
  for (std::sregex_iterator at(text.begin(), text.end(), expression), end; at != end; ++at)
    found.push_back((*at)[1]);
  return found;
}

TEST(Structure, DocumentsNameFilesThatExist) {
  const std::vector<PageLine> lines = lines_of_pages();
  int paths = 0;
  for (const PageLine& line : lines)
    for (std::string path : found_in(line.text,
                                     "(?:^|[^A-Za-z0-9_/.-])((?:app|sim|render|tests|scenes|docs|"
                                     "shaders|cmake)/[A-Za-z0-9_./-]+)")) {
      while (path.ends_with('.')) path.pop_back();
      ++paths;
      EXPECT_TRUE(fs::exists(fs::path(NEVE_SOURCE_DIR) / path))
          << line.page << ":" << line.number << " names " << path
          << ", which does not exist; name its new place";
    }
  EXPECT_GT(paths, 60) << "the pages are not read as they are written";
}

TEST(Structure, DocumentsLinkToFilesThatExist) {
  int links = 0;
  for (const PageLine& line : lines_of_pages())
    for (const std::string& link : found_in(line.text, R"(\]\(([^)#]+)[^)]*\))")) {
      if (link.find("://") != std::string::npos) continue;
      ++links;
      EXPECT_TRUE(fs::exists(fs::path(NEVE_SOURCE_DIR) / fs::path(line.page).parent_path() / link))
          << line.page << ":" << line.number << " links to " << link << ", which does not exist";
    }
  EXPECT_GT(links, 40) << "the pages are not read as they are written";
}

TEST(Structure, TheMapForDevelopersHasEveryFolder) {
  std::set<std::string> rows;
  for (const PageLine& line : lines_of_pages()) {
    if (line.page != "docs/developers.md") continue;
    for (const std::string& folder : found_in(line.text, "^\\| `([a-z_/]+)` \\| .+ \\|$"))
      EXPECT_TRUE(rows.insert(folder).second) << folder << " has two rows";
  }
  for (const Folder& folder : folders)
    EXPECT_EQ(rows.erase(std::string(folder.path)), 1u)
        << "docs/developers.md has no row for " << folder.path
        << "; write one sentence about what it holds";
  for (const std::string& row : rows)
    ADD_FAILURE() << "docs/developers.md has a row for " << row
                  << ", which is no folder of tests/structure/folders.h";
}

}  // namespace
}  // namespace neve::test

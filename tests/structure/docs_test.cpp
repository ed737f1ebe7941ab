/// The documentation names files and folders that exist, and its map has every folder.

#include <gtest/gtest.h>

#include <filesystem>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include "tests/mutation/mistakes.h"
#include "tests/structure/folders.h"
#include "tests/structure/sources.h"

namespace neve::test {
namespace {

namespace fs = std::filesystem;

/// Every line of the README, of the changelog, and of the pages in docs and its reports.
std::vector<SourceLine> lines_of_pages() {
  std::vector<SourceLine> lines = lines_of("README.md");
  const auto add = [&](const std::string& file) {
    const std::vector<SourceLine> more = lines_of(file);
    lines.insert(lines.end(), more.begin(), more.end());
  };
  add("CHANGELOG.md");
  for (const std::string folder : {"docs", "docs/reports"})
    for (const auto& entry : fs::directory_iterator(source_root() / folder))
      if (entry.path().extension() == ".md") add(folder + "/" + entry.path().filename().string());
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
  const std::vector<SourceLine> lines = lines_of_pages();
  int paths = 0;
  for (const SourceLine& line : lines)
    for (std::string path : found_in(line.text,
                                     "(?:^|[^A-Za-z0-9_/.-])((?:app|sim|render|tests|scenes|docs|"
                                     "shaders|cmake)/[A-Za-z0-9_./-]+)")) {
      while (path.ends_with('.')) path.pop_back();
      ++paths;
      EXPECT_TRUE(fs::exists(source_root() / path))
          << line.file << ":" << line.number << " names " << path
          << ", which does not exist; name its new place";
    }
  EXPECT_GT(paths, 60) << "the pages are not read as they are written";
}

/// Names of all tests: "Suite.Name".
std::set<std::string> tests_with_suites() {
  std::set<std::string> names;
  for (const auto& entry : fs::recursive_directory_iterator(source_root() / "tests")) {
    if (entry.path().extension() != ".cpp") continue;
    const std::regex test(R"(^TEST(?:_F|_P)?\(([A-Za-z0-9]+), ([A-Za-z0-9]+)\))");
    const fs::path file = fs::relative(entry.path(), source_root());
    for (const SourceLine& line : lines_of(file.string()))
      if (std::smatch found; std::regex_search(line.text, found, test))
        names.insert(found[1].str() + "." + found[2].str());
  }
  return names;
}

TEST(Structure, EveryFindingOfNewcomersHasATest) {
  const std::set<std::string> names = tests_with_suites();
  int findings = 0;
  for (const SourceLine& line : lines_of("docs/reports/trial.md")) {
    if (!line.text.starts_with("| ") || line.text.starts_with("| ---")) continue;
    if (line.text.starts_with("| finding")) continue;
    const std::vector<std::string> tests = found_in(line.text, R"(\| `([A-Za-z0-9.]+)` \|$)");
    ASSERT_EQ(tests.size(), 1u) << line.text;
    EXPECT_TRUE(names.contains(tests[0])) << "docs/reports/trial.md names no test: " << tests[0];
    ++findings;
  }
  EXPECT_GE(findings, 30);
}

TEST(Structure, DocumentsLinkToFilesThatExist) {
  int links = 0;
  for (const SourceLine& line : lines_of_pages())
    for (const std::string& link : found_in(line.text, R"(\]\(([^)#]+)[^)]*\))")) {
      if (link.find("://") != std::string::npos) continue;
      ++links;
      EXPECT_TRUE(fs::exists(source_root() / fs::path(line.file).parent_path() / link))
          << line.file << ":" << line.number << " links to " << link << ", which does not exist";
    }
  EXPECT_GT(links, 40) << "the pages are not read as they are written";
}

/// A page that no index names is found by nobody.
TEST(Structure, TheIndexOfTheDocumentationHasEveryPage) {
  std::set<std::string> named;
  for (const SourceLine& line : lines_of("docs/README.md"))
    for (const std::string& link : found_in(line.text, R"(\]\(([^)#]+)[^)]*\))"))
      named.insert(link);
  for (const std::string folder : {"", "reports/"})
    for (const auto& entry : fs::directory_iterator(source_root() / "docs" / folder)) {
      const std::string page = folder + entry.path().filename().string();
      if (!page.ends_with(".md") || page == "README.md") continue;
      EXPECT_TRUE(named.contains(page)) << "docs/README.md does not name " << page;
    }
}

/// The past, and who wanted something, is for reports and the changelog. The page of verification
/// is made by a script, which names the commit of its run.
TEST(Structure, PagesTellWhatIsTrueNow) {
  for (const SourceLine& line : lines_of_pages()) {
    if (line.file.starts_with("docs/reports/") || line.file == "CHANGELOG.md" ||
        line.file == "docs/verification.md")
      continue;
    for (const std::string& word : found_in(line.text, "((?:were|are) asked|commit [0-9a-f]{7})"))
      ADD_FAILURE() << line.file << ":" << line.number << " has \"" << word << "\"";
  }
}

TEST(Structure, TheMapForDevelopersHasEveryFolder) {
  std::set<std::string> rows;
  for (const SourceLine& line : lines_of_pages()) {
    if (line.file != "docs/developers.md") continue;
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

TEST(Structure, TheReadmeCountsTheRowsOfTheTableOfMistakes) {
  std::size_t rows = 0;
  bool is_in_table = false;
  for (const SourceLine& line : lines_of("docs/mistakes.md")) {
    if (line.text.starts_with("| mistake |")) is_in_table = true;
    if (line.text.empty()) is_in_table = false;
    if (is_in_table) ++rows;
  }
  ASSERT_GT(rows, 2u) << "docs/mistakes.md is not read as it is written";
  rows -= 2;  // the heading and the line below it
  EXPECT_EQ(rows, all_mistakes().size()) << "docs/mistakes.md does not list every mistake";
  int counts = 0;
  for (const SourceLine& line : lines_of_pages())
    for (const std::string& count : found_in(line.text, "([0-9]+) classic mistakes")) {
      ++counts;
      EXPECT_EQ(count, std::to_string(rows))
          << line.file << ":" << line.number << ": docs/mistakes.md lists " << rows;
    }
  EXPECT_GT(counts, 0) << "no page says how many mistakes there are";
}

/// Rows of a table that the page leaves out would stop docs/verification/make.
TEST(Structure, ThePageOfVerificationShowsEveryTableOfTheTests) {
  std::set<std::string> shown;
  for (const SourceLine& line : lines_of("docs/verification/page.md"))
    for (const std::string& table : found_in(line.text, "^@table (.+)$")) shown.insert(table);
  int rows = 0;
  for (const std::string& file : sources_below({"tests/analytic", "tests/analytic_long"})) {
    std::string text;
    for (const SourceLine& line : lines_of(file)) text += line.text + " ";
    for (const std::string& table :
         found_in(text, R"re((?:verify_[a-z_]+\( *|Quantity [a-z_]+)\{"([a-z_ ]+)")re")) {
      ++rows;
      EXPECT_TRUE(shown.contains(table))
          << file << " has rows for the table \"" << table << "\"; add \"@table " << table
          << "\" to docs/verification/page.md";
    }
  }
  EXPECT_GT(rows, 20) << "the tests are not read as they are written";
}

}  // namespace
}  // namespace neve::test

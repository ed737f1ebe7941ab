/// Tests that CMake names exist: a filter that fits no test would silently fit nothing.

#include <gtest/gtest.h>

#include <cctype>
#include <fstream>
#include <set>
#include <sstream>
#include <string>

#include "tests/structure/sources.h"

namespace neve::test {
namespace {

/// "Suite.Name" of every test in the sources.
std::set<std::string> names_of_tests() {
  std::set<std::string> names;
  for (const std::string& file : sources_below({"tests"})) {
    std::ifstream in(source_root() / file);
    for (std::string line; std::getline(in, line);) {
      if (!line.starts_with("TEST")) continue;
      // A long name is on the next line.
      if (std::string more; line.find(')') == std::string::npos && std::getline(in, more))
        line += more;
      for (char& c : line)
        if (!std::isalnum(static_cast<unsigned char>(c)) && c != '_') c = ' ';
      std::istringstream words(line);
      std::string macro, suite, name;
      if (words >> macro >> suite >> name) names.insert(suite + "." + name);
    }
  }
  return names;
}

TEST(Structure, TestsThatCMakeNamesExist) {
  const std::set<std::string> names = names_of_tests();
  ASSERT_GT(names.size(), 900u) << "the sources are not read as they are written";
  int seen = 0;
  for (const SourceLine& line : lines_of("tests/CMakeLists.txt")) {
    std::istringstream words(line.text.substr(0, line.text.find('#')));
    for (std::string word; words >> word;) {
      while (word.ends_with(')')) word.pop_back();
      const std::size_t dot = word.find('.');
      const bool is_test = dot != std::string::npos && std::isupper(word[0]) &&
                           dot + 1 < word.size() && std::isupper(word[dot + 1]);
      if (!is_test) continue;
      ++seen;
      EXPECT_TRUE(names.contains(word))
          << "tests/CMakeLists.txt names " << word
          << ", which no test is called; give it the new name, or remove it";
    }
  }
  EXPECT_GT(seen, 10);
}

}  // namespace
}  // namespace neve::test

/// A law is one file: its name is in that file and in the list, and nowhere else.

#include <gtest/gtest.h>

#include <regex>
#include <string>
#include <vector>

#include "tests/structure/sources.h"
#include "tests/structure/texts.h"

namespace neve::test {
namespace {

constexpr const char* list = "sim/laws/list.h";

/// The text of a scene, which names what its snow is.
constexpr const char* scene_text = "app/scene/first_scene.cpp";

/// The words of LAW(word) in the list.
std::vector<std::string> names_of_laws() {
  std::vector<std::string> names;
  const std::regex law(R"(LAW\(([a-z_]+)\))");
  std::string text = text_of(list);
  text.resize(text.find("#include"));
  text.erase(0, text.find("NEVE_LAWS(LAW)"));
  for (std::sregex_iterator at(text.begin(), text.end(), law), end; at != end; ++at)
    names.push_back((*at)[1]);
  return names;
}

/// Ways to name a law in a source. Snow and sand are words as well, and snow is what most materials
/// are called: they count as a law only where code would mean it.
std::regex mention_of(const std::string& name) {
  const std::string code = R"(\b(model|laws|Model)::)" + name + R"(\b|\blaws/)" + name + R"(\.h)";
  if (name == "snow") return std::regex(code);
  if (name == "sand") return std::regex(code + "|\"sand[\"_]");
  return std::regex(code + R"(|\b)" + name + R"(\b)");
}

TEST(Structure, OnlyItsOwnFileAndTheListNameALaw) {
  const std::vector<std::string> names = names_of_laws();
  ASSERT_GE(names.size(), 5u) << list << " is not read as it is written";
  for (const std::string& file : sources_below({"app", "render", "sim"})) {
    const std::vector<SourceLine> lines = lines_of(file);
    for (const std::string& name : names) {
      const std::string own = "sim/laws/" + name + ".h";
      if (file == own || file == list || file == scene_text) continue;
      const std::regex mention = mention_of(name);
      for (const SourceLine& line : lines)
        if (line.text.find(name) != line.text.npos && std::regex_search(line.text, mention))
          ADD_FAILURE() << file << ":" << line.number << " names the law " << name << ": "
                        << line.text << "\n  Say in " << own << " what this file wants to know, by "
                        << "a member of laws::Law.";
    }
  }
  for (const std::string& name : names)
    EXPECT_FALSE(text_of("sim/laws/" + name + ".h").empty()) << name << " has no file";
}

/// The files of all laws are read by what is compiled with every law alone: a change of one of them
/// compiles nothing else.
TEST(Structure, FewFilesAreCompiledWithALaw) {
  int readers = 0;
  for (const std::string& file : sources_below({"app", "render", "sim"}))
    for (const SourceLine& line : lines_of(file))
      if (const std::string name = include_of(line.text).name;
          name == "sim/laws/files.h" || name == "sim/laws/table.h") {
        ++readers;
        EXPECT_TRUE(file.starts_with("sim/laws/") ||
                    file.starts_with("sim/kernels/instruction_sets/laws_"))
            << file << " includes " << name;
      }
  EXPECT_EQ(readers, 5) << "law.cpp, table.h, and a file for each of three instruction sets";
}

}  // namespace
}  // namespace neve::test

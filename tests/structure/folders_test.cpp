/// The folders are the architecture: what they include, how many files they hold and what their
/// namespaces are called, read from the sources and compared with the floor plan.

#include "tests/structure/folders.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "tests/structure/sources.h"

namespace neve::test {
namespace {

namespace fs = std::filesystem;

/// Every line of the sources that starts with some word.
std::vector<SourceLine> lines_starting_with(const std::string& word) {
  std::vector<SourceLine> found;
  for (const std::string& file : sources_below({"app", "render", "sim"}))
    for (SourceLine& line : lines_of(file))
      if (line.text.starts_with(word)) found.push_back(std::move(line));
  return found;
}

std::string folder_of(const std::string& file) {
  return fs::path(file).parent_path().generic_string();
}

std::map<std::string, std::set<std::string>> allowed_includes() {
  std::map<std::string, std::set<std::string>> allowed;
  for (const Folder& folder : folders) {
    std::istringstream words{std::string(folder.may_include)};
    std::set<std::string>& list = allowed[std::string(folder.path)];
    for (std::string word; words >> word;) list.insert(word);
  }
  return allowed;
}

TEST(Structure, FoldersIncludeOnlyWhatTheFloorPlanAllows) {
  const auto allowed = allowed_includes();
  const std::vector<SourceLine> includes = lines_starting_with("#include");
  ASSERT_GT(includes.size(), 1000u) << "the sources are not read as they are written";
  for (const SourceLine& line : includes) {
    const std::string from = folder_of(line.file);
    const Include include = include_of(line.text);
    const auto plan = allowed.find(from);
    ASSERT_TRUE(plan != allowed.end())
        << line.file << ": the folder " << from << " is missing in tests/structure/folders.h";
    if (!include.is_ours || include.name.starts_with("shaders/")) continue;
    const std::string to = folder_of(include.name);
    EXPECT_TRUE(to == from || plan->second.contains(to))
        << line.file << ":" << line.number << ": " << line.text << "\n  " << from
        << " may not include " << to
        << ". Move what is needed down, or change the table in tests/structure/folders.h.";
  }
}

/// The table names folders before those that include them: so there is no circle.
TEST(Structure, TheFloorPlanHasNoCircles) {
  const auto allowed = allowed_includes();
  std::set<std::string> below;
  for (const Folder& folder : folders) {
    for (const std::string& name : allowed.at(std::string(folder.path)))
      EXPECT_TRUE(below.contains(name))
          << folder.path << " may include " << name << ", which comes later or does not exist";
    EXPECT_TRUE(below.insert(std::string(folder.path)).second) << folder.path << " is listed twice";
  }
}

TEST(Structure, EveryFolderOfTheFloorPlanExists) {
  for (const Folder& folder : folders)
    EXPECT_TRUE(fs::is_directory(source_root() / folder.path)) << folder.path;
}

TEST(Structure, NoFolderHoldsTooManyUnits) {
  for (const Folder& folder : folders) {
    std::set<std::string> units;
    for (const auto& entry : fs::directory_iterator(source_root() / folder.path))
      if (entry.path().extension() == ".h" || entry.path().extension() == ".cpp")
        units.insert(entry.path().stem().string());
    EXPECT_LE(static_cast<int>(units.size()), max_units) << folder.path;
  }
}

TEST(Structure, NamespacesAreCalledLikeTheirFolders) {
  std::map<std::string, std::string> wanted;
  for (const Folder& folder : folders) {
    std::string name = "neve::" + std::string(folder.path);
    for (std::size_t slash; (slash = name.find('/')) != std::string::npos;)
      name.replace(slash, 1, "::");
    wanted[std::string(folder.path)] =
        folder.name_space.empty() ? name : std::string(folder.name_space);
  }
  const std::vector<SourceLine> opened = lines_starting_with("namespace neve");
  ASSERT_GT(opened.size(), 400u) << "the sources are not read as they are written";
  for (const SourceLine& line : opened) {
    const std::string name = line.text.substr(10, line.text.find(' ', 10) - 10);
    const std::string& folder = wanted.at(folder_of(line.file));
    // A part of a folder may have a name inside; forward declarations name other folders.
    const bool is_inside = name == folder || name.starts_with(folder + "::");
    const std::vector<SourceLine> lines = lines_of(line.file);
    const auto next_but_one = static_cast<std::size_t>(line.number) + 1;
    const bool is_forward = next_but_one < lines.size() && lines[next_but_one].text == "}";
    EXPECT_TRUE(is_inside || is_forward)
        << line.file << ":" << line.number << " opens " << name << " instead of " << folder;
  }
}

TEST(Structure, SimulationIncludesNoGraphicsLibrary) {
  for (const SourceLine& line : lines_starting_with("#include"))
    if (line.file.starts_with("sim/")) {
      for (const char* forbidden : {"GL/", "EGL/", "GLFW/", "imgui", "stb"})
        EXPECT_FALSE(include_of(line.text).name.starts_with(forbidden))
            << line.file << ":" << line.number << ": " << line.text;
    }
}

TEST(Structure, ApplicationDrawsThroughTheRendererOnly) {
  for (const SourceLine& line : lines_starting_with("#include"))
    if (line.file.starts_with("app/")) {
      for (const char* forbidden : {"GL/", "EGL/", "GLFW/", "render/gl/gl"})
        EXPECT_FALSE(include_of(line.text).name.starts_with(forbidden))
            << line.file << ":" << line.number << ": " << line.text;
    }
}

}  // namespace
}  // namespace neve::test

#pragma once
/// The files that a command left in a folder, as far as they are the same each time.

#include <filesystem>
#include <map>
#include <set>
#include <string>

#include "app/support/json.h"
#include "tests/support/temporary_folder.h"

namespace neve::test {

/// Pictures and exports byte by byte, the state hashes of runs; nothing where times are told.
inline std::string lasting_contents(const std::filesystem::path& file) {
  const std::set<std::string> same{".png", ".vtp", ".vti", ".csv", ".toml"};
  const std::string name = file.filename().string();
  if (name == "data.csv" || name.starts_with("sheet")) return {};
  if (same.contains(file.extension().string())) return read_text(file);
  if (name != "run.json") return {};
  std::string hashes;
  const app::Json run = app::parse_json(std::string_view(read_text(file)));
  for (const app::Json& frame : run.value("frames", app::Json::array()))
    hashes += frame.value("state_hash", "") + "\n";
  return hashes;
}

/// Returns contents by the names of all files, without checkpoints, whose number depends on the
/// moments of a run, and without states, which a run continues without where there is no room.
inline std::map<std::string, std::string> folder_contents(const std::filesystem::path& folder) {
  std::map<std::string, std::string> found;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    const std::string name = entry.path().lexically_relative(folder).string();
    if (entry.is_regular_file() && name.find("checkpoint/") == std::string::npos &&
        name.find("states/") == std::string::npos)
      found[name] = lasting_contents(entry.path());
  }
  return found;
}

}  // namespace neve::test

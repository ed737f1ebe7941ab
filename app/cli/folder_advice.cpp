#include "app/cli/command_line.h"

#include <algorithm>
#include <system_error>
#include <vector>

#include "app/output/sequence.h"
#include "app/record/picture_record.h"
#include "app/support/errors.h"
#include "app/support/out_folder.h"
#include "app/support/text.h"

namespace neve::app::cli {

namespace {

namespace fs = std::filesystem;

bool has_file(const fs::path& folder, const char* name) {
  std::error_code error;
  return fs::exists(folder / name, error);
}

/// The first folders of runs or sweeps in a folder.
std::vector<std::string> runs_below(const fs::path& folder) {
  constexpr std::size_t max_named = 3, max_read = 10'000;
  std::vector<std::string> found;
  std::error_code error;
  std::size_t read = 0;
  for (fs::directory_iterator at(folder, error), end; !error && at != end && read < max_read;
       at.increment(error), ++read)
    if (has_file(at->path(), "run.json") || is_sweep_folder(at->path()))
      found.push_back(at->path().lexically_normal().string());
  std::sort(found.begin(), found.end());
  if (found.size() > max_named) found.resize(max_named);
  return found;
}

std::string advice_on_file(const fs::path& file, const std::string& command) {
  const std::string suffix = file.extension().string();
  const std::string takes = command + " takes pictures (PNG) and folders of runs";
  if (suffix == ".toml")
    return "a scene has no pictures yet: neve render makes them, neve check forecasts it";
  if (suffix == ".mp4" || suffix == ".webm" || suffix == ".gif" || suffix == ".mov")
    return takes + "; those of a movie are in the folder of its run";
  if (suffix == ".npz" || suffix == ".vtp" || suffix == ".vdb" || suffix == ".ply" ||
      suffix == ".csv" || suffix == ".bgeo" || suffix == ".usda" || suffix == ".vti" ||
      suffix == ".obj")
    return takes + "; an exported file has neither, name the run that it was made from";
  return takes;
}

}  // namespace

FolderAdvice advice_on_folder(const fs::path& typed) {
  const fs::path folder = without_slash(typed);
  const fs::path around = folder.has_parent_path() ? folder.parent_path() : fs::path(".");
  if (is_sweep_folder(folder))
    return {"is the folder of a sweep, not of a run",
            "name one of its runs, as in " + (folder / "runs" / "0000").string()};
  std::error_code error;
  const bool is_in_run = fs::exists(output::run_json_path(around), error);
  if (fs::exists(output::export_list_path(folder), error))
    return {"is the folder of an export, not of a run: export.json lists its files",
            is_in_run ? around.string() + " is the run" : "neve verify compares them with it"};
  const std::string what = "is not the folder of a run: it has no run.json";
  if (is_in_run) return {what, around.string() + " is one"};
  const std::vector<std::string> below = runs_below(folder);
  if (below.empty()) return {what, "name the output folder of a run, as in out/snowball_drop"};
  return {what, (below.size() == 1 ? "one is " : "these are: ") + joined(below, ", ")};
}

void require_picture(const fs::path& file, const std::string& command) {
  std::error_code error;
  if (!fs::is_regular_file(file, error) || record::is_picture(file)) return;
  const std::string hint = advice_on_file(file, command);
  throw Error(exit_invalid_scene, file.string() + ": error: is not a PNG picture; " + hint,
              file.string(), hint);
}

}  // namespace neve::app::cli

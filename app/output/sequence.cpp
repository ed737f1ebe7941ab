#include "app/output/sequence.h"

#include <algorithm>
#include <cstdio>
#include <set>
#include <system_error>
#include <vector>

#include "app/output/atomic_file.h"
#include "app/output/descriptor.h"
#include "app/support/errors.h"
#include "app/support/json.h"

namespace neve::app::output {

namespace fs = std::filesystem;

namespace {

/// Files that an earlier run.json claims to have written.
struct EarlierRun {
  std::set<std::string> views, views_of_passes;
  std::set<int> frames;
};

EarlierRun read_earlier_run(const fs::path& file) {
  EarlierRun run;
  std::error_code error;
  if (!fs::is_regular_file(fs::symlink_status(file, error))) return run;
  Json json;
  try {
    json = parse_json(read_file(file));
  } catch (const UnreadableError&) {
    throw;
  } catch (const std::exception& error) {
    rethrow_no_memory(error);
    return run;
  }
  if (!json.is_object()) return run;
  const auto add_names = [&](const char* key, std::set<std::string>& names) {
    for (const Json& view : json.value(key, Json::array()))
      if (view.is_string() && is_plain_name(view.get<std::string>()))
        names.insert(view.get<std::string>());
  };
  add_names("views", run.views);
  add_names("views_of_passes", run.views_of_passes);
  for (const Json& entry : json.value("frames", Json::array())) {
    if (!entry.is_object() || !entry.contains("frame")) continue;
    const Json& frame = entry["frame"];
    if (frame.is_number_unsigned() && frame.get<std::uint64_t>() <= max_frame)
      run.frames.insert(whole_number<int>(frame));
  }
  return run;
}

/// Links are left alone: their targets are not ours.
std::size_t remove_regular(const fs::path& file) {
  std::error_code error;
  if (!fs::is_regular_file(fs::symlink_status(file, error))) return 0;
  if (!fs::remove(file, error) && error)
    fail_writing(file, "cannot remove what an earlier run made", error.value());
  return 1;
}

}  // namespace

bool is_plain_name(const std::string& name) {
  const auto is_plain = [](char c) {
    return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_' ||
           c == '-';
  };
  return !name.empty() && name.size() <= 200 && std::all_of(name.begin(), name.end(), is_plain);
}

fs::path frame_path(const fs::path& folder, const std::string& view, int frame) {
  char name[32];
  std::snprintf(name, sizeof name, "%04d.png", frame);
  return folder / view / name;
}

fs::path channels_path(const fs::path& folder, const std::string& view, int frame) {
  return frame_path(folder, view, frame).replace_extension(".exr");
}

fs::path movie_path(const fs::path& folder, const std::string& view, MovieFormat format) {
  return folder / (view + movie_suffix(format));
}

fs::path diverged_path(const fs::path& folder, const std::string& view) {
  return folder / ("diverged_" + view + ".png");
}

fs::path incident_path(const fs::path& folder) {
  return folder / "incident.json";
}

fs::path run_json_path(const fs::path& folder) {
  return folder / "run.json";
}

fs::path export_list_path(const fs::path& folder) {
  return folder / "export.json";
}

std::size_t remove_earlier_run(const fs::path& folder) {
  const EarlierRun run = read_earlier_run(run_json_path(folder));
  std::size_t removed = 0;
  std::error_code error;
  for (const std::string& view : run.views) {
    for (const MovieFormat format : all_movie_formats())
      removed += remove_regular(movie_path(folder, view, format));
    removed += remove_regular(diverged_path(folder, view));
    const fs::path view_folder = folder / view;
    if (!fs::is_directory(fs::symlink_status(view_folder, error))) continue;
    for (const int frame : run.frames) {
      removed += remove_regular(frame_path(folder, view, frame));
      if (run.views_of_passes.contains(view))
        removed += remove_regular(channels_path(folder, view, frame));
    }
    // Succeeds only when nothing else is left in it.
    fs::remove(view_folder, error);
  }
  if (!run.views.empty()) {
    removed += remove_regular(incident_path(folder));
    removed += remove_regular(diverged_path(folder, culprit_view));
  }
  return removed;
}

}  // namespace neve::app::output

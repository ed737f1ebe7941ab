#include "app/output/sequence.h"

#include <fmt/core.h>

#include <algorithm>
#include <system_error>

namespace neve::app::output {

namespace fs = std::filesystem;

bool is_plain_name(const std::string& name) {
  const auto is_plain = [](char c) {
    return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_' ||
           c == '-';
  };
  return !name.empty() && name.size() <= 200 && std::all_of(name.begin(), name.end(), is_plain);
}

fs::path frame_path(const fs::path& folder, const std::string& view, int number) {
  return folder / view / fmt::format("{:04}.png", number);
}

fs::path channels_path(const fs::path& folder, const std::string& view, int number) {
  return frame_path(folder, view, number).replace_extension(".exr");
}

fs::path movie_path(const fs::path& folder, const std::string& view, MovieFormat format) {
  return folder / (view + info_of(format).suffix);
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

fs::path free_path(const fs::path& folder, const std::string& name, const std::string& suffix) {
  std::error_code error;
  fs::path path = folder / (name + suffix);
  for (int k = 2; fs::exists(fs::symlink_status(path, error)); ++k)
    path = folder / fmt::format("{}_{}{}", name, k, suffix);
  return path;
}

fs::path export_list_path(const fs::path& folder) {
  return folder / "export.json";
}

fs::path comparison_list_path(const fs::path& folder) {
  return folder / "compare.json";
}

}  // namespace neve::app::output

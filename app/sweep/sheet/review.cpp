#include "app/sweep/sheet/review.h"

#include <fmt/core.h>

#include <algorithm>
#include <optional>
#include <string>
#include <system_error>
#include <vector>

#include "app/output/atomic_file.h"
#include "app/output/sequence.h"
#include "app/support/errors.h"
#include "app/support/json.h"
#include "app/support/text.h"

namespace neve::app::sweep::sheet {

namespace {

namespace fs = std::filesystem;

Json schema(const char* name) {
  return {{"OTIO_SCHEMA", name}};
}

Json time_json(double frames, double fps) {
  Json json = schema("RationalTime.1");
  json["rate"] = fps;
  json["value"] = frames;
  return json;
}

Json range_json(double first, double count, double fps) {
  Json json = schema("TimeRange.1");
  json["start_time"] = time_json(first, fps);
  json["duration"] = time_json(count, fps);
  return json;
}

/// A number where the text is one.
Json value_json(const std::string& text) {
  const std::optional<double> number = finite_number(text);
  return number ? Json(*number) : Json(text);
}

Json marker_json(const Parameter& parameter, const std::string& value, double first, double fps) {
  Json json = schema("Marker.2");
  json["name"] = parameter.address + " = " + value;
  json["color"] = "GREEN";
  json["marked_range"] = range_json(first, 1, fps);
  json["metadata"]["neve"] = {
      {"address", parameter.address}, {"value", value_json(value)}, {"unit", parameter.unit}};
  return json;
}

/// Returns the first frame of a clip. Below zero, only links have the names that OTIO makes of
/// numbers.
int first_of_clip(const store::RunResult& result, bool has_links) {
  const int first = result.frames.front();
  return has_links || result.frames.back() < 0 ? first : std::max(0, first);
}

Json media_json(const store::Manifest& manifest, const Run& run, const store::RunResult& result,
                bool has_links) {
  const int first = first_of_clip(result, has_links);
  const double count = result.frames.back() - first + 1, fps = manifest.fps_of(run);
  Json json = schema("ImageSequenceReference.1");
  json["available_range"] = range_json(first, count, fps);
  json["target_url_base"] =
      has_links ? std::string("review/") : "runs/" + run.folder + "/" + manifest.view + "/";
  json["name_prefix"] = has_links ? review_prefix(run) : "";
  json["name_suffix"] = ".png";
  json["start_frame"] = first;
  json["frame_step"] = 1;
  json["rate"] = fps;
  json["frame_zero_padding"] = 4;
  json["missing_frame_policy"] = "hold";
  json["metadata"] = Json::object();
  return json;
}

Json metrics_json(const Run& run, const store::RunResult& result) {
  Json json = Json::object();
  const std::vector<store::MetricInfo>& infos = store::metric_infos();
  for (std::size_t k = 0; k < std::min(infos.size(), result.metrics.size()); ++k) {
    const std::optional<double> value = store::told_metric(run, result, k);
    if (!infos[k].is_of_bodies || value)
      json[infos[k].name] = value ? number_or_null(*value) : Json();
  }
  return json;
}

Json clip_json(const store::Manifest& manifest, const Run& run, const store::RunResult& result,
               bool has_links) {
  const int first = first_of_clip(result, has_links);
  const double fps = manifest.fps_of(run);
  Json json = schema("Clip.1");
  json["name"] = run.label.empty() ? store::run_text(run) : run.label;
  json["source_range"] = range_json(first, result.frames.back() - first + 1, fps);
  json["media_reference"] = media_json(manifest, run, result, has_links);
  json["effects"] = Json::array();
  json["markers"] = Json::array();
  for (const Parameter& parameter : manifest.parameters)
    if (const std::string value = run.value(parameter.address); !value.empty())
      json["markers"].push_back(marker_json(parameter, value, first, fps));
  json["metadata"]["neve"] = {{"run", run.index},
                              {"state", store::name(result.status.state)},
                              {"metrics", metrics_json(run, result)}};
  return json;
}

/// Lists the links of runs, which may be removed: what a person has put there stays.
std::vector<fs::path> links_in(const fs::path& review) {
  std::error_code error;
  std::vector<fs::path> links;
  if (fs::is_symlink(review, error)) return links;
  for (const fs::directory_entry& entry : fs::directory_iterator(review, error))
    if (entry.is_symlink(error) && entry.path().filename().string().starts_with("run_"))
      links.push_back(entry.path());
  return links;
}

}  // namespace

std::string review_prefix(const Run& run) {
  return "run_" + store::run_folder_name(run.index) + ".";
}

std::string otio_timeline(const store::Manifest& manifest,
                          const std::vector<store::RunResult>& results, bool has_links) {
  Json track = schema("Track.1");
  track["name"] = "runs";
  track["kind"] = "Video";
  track["children"] = Json::array();
  for (std::size_t k = 0; k < results.size(); ++k)
    if (!results[k].frames.empty())
      track["children"].push_back(clip_json(manifest, manifest.runs[k], results[k], has_links));
  Json stack = schema("Stack.1");
  stack["name"] = "tracks";
  stack["children"] = Json::array({track});
  Json timeline = schema("Timeline.1");
  timeline["name"] = manifest.title;
  timeline["tracks"] = stack;
  timeline["metadata"]["neve"] = {{"version", manifest.version}, {"scene", manifest.scene_file}};
  return to_text(timeline) + "\n";
}

bool has_links(const fs::path& folder) {
  return !links_in(folder / "review").empty();
}

void link_pictures(const fs::path& folder, const store::Manifest& manifest,
                   const std::vector<store::RunResult>& results) {
  const fs::path review = folder / "review";
  output::make_own_folder(review);
  std::error_code error;
  for (const fs::path& link : links_in(review)) fs::remove(link, error);
  for (std::size_t k = 0; k < results.size(); ++k) {
    const Run& run = manifest.runs[k];
    for (const int frame : results[k].frames) {
      const fs::path picture =
          output::frame_path(fs::path("..") / "runs" / run.folder, manifest.view, frame);
      // OTIO pads behind the sign.
      const fs::path link = review / fmt::format("{}{}{:04}.png", review_prefix(run),
                                                 frame < 0 ? "-" : "", std::abs(frame));
      fs::create_symlink(picture, link, error);
      if (error)
        throw IoError(link.string() + ": cannot be linked: " + error.message(), link.string(),
                      "remove --review where the disk has no links");
    }
  }
}

}  // namespace neve::app::sweep::sheet

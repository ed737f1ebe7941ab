#include "app/sweep/store/results.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>
#include <map>
#include <set>
#include <system_error>
#include <unordered_map>

#include "app/output/sequence.h"
#include "app/record/run_json.h"
#include "app/record/verify.h"
#include "app/scene/flat.h"
#include "app/support/errors.h"
#include "app/support/text.h"
#include "sim/base/hash.h"

namespace neve::app::sweep::store {

namespace {

std::optional<double> finite(double x) {
  return std::isfinite(x) ? std::optional(x) : std::nullopt;
}

/// Returns the metrics in the order of metric_infos().
/// @param start  of the run, not of its frames @param whole  from there to the last frame
std::vector<std::optional<double>> metrics_of(const std::vector<record::FrameRecord>& frames,
                                              const record::RunStart& start,
                                              const std::optional<record::Extremes>& whole,
                                              const RunStatus& status,
                                              std::optional<double> diverged_at) {
  if (frames.empty()) return std::vector<std::optional<double>>(metric_infos().size());
  const record::FrameRecord& last = frames.back();
  // Values are nothing if the frames before the first one are not known.
  std::optional<double> steps, max_speed, max_force, max_pressure, max_body_speed;
  if (whole) {
    steps = whole->steps;
    max_speed = finite(whole->max_speed);
    max_force = finite(whole->max_force);
    max_pressure = finite(whole->max_pressure);
    max_body_speed = whole->max_body_speed;
  }
  // Steps after the last frame count too.
  if (diverged_at) steps = std::max(steps.value_or(0), *diverged_at);
  // If a sink has taken all snow, it has no shape and no density.
  const auto of_snow = [&](double x) { return record::has_snow(last) ? finite(x) : std::nullopt; };
  return {of_snow(last.metrics.spread),
          of_snow(last.metrics.height),
          static_cast<double>(last.metrics.fragments),
          of_snow(last.metrics.largest_fragment),
          of_snow(last.metrics.powder),
          of_snow(last.metrics.crumbs),
          finite(last.summary.kinetic_energy),
          finite(last.summary.elastic_energy),
          of_snow(last.metrics.mean_J_P),
          of_snow(last.summary.min_J_P),
          of_snow(last.summary.max_J_P),
          max_speed,
          max_force,
          max_pressure,
          record::largest_fall(start.bodies, last.bodies),
          record::largest_way(start.bodies, last.bodies),
          max_body_speed,
          steps,
          finite(status.seconds)};
}

/// Contents of DIR/run.json besides its frames; missing values are omitted.
struct RunNotes {
  std::vector<std::string> warnings;
  std::optional<double> diverged_at;  ///< step, counted from the start that `whole` knows
  std::optional<record::RunStart> start;
  std::optional<record::Extremes> whole;
  std::string simd, sources;
};

RunNotes notes_of(const Json& run, const std::vector<record::FrameRecord>& frames) {
  RunNotes notes;
  try {
    notes.start = record::start_of(run);
    notes.whole = record::extremes_of_run(run, frames, notes.start);
    if (run.contains("divergence")) notes.diverged_at = run["divergence"].at("step").get<double>();
    notes.warnings = run.value("warnings", notes.warnings);
    notes.simd = run.value("simd", "");
    if (run.contains("build")) notes.sources = run["build"].value("sources", "");
  } catch (const std::exception& error) {
    rethrow_no_memory(error);
    return notes;
  }
  return notes;
}

}  // namespace

const std::vector<MetricInfo>& metric_infos() {
  static const std::vector<MetricInfo> infos{
      {"spread", "m", "spread", false, false},
      {"height", "m", "height", false, false},
      {"fragments", "", "fragments", true, false},
      {"largest_fragment", "", "largest fragment", false, false},
      {"powder", "", "share of powder", false, false},
      {"crumbs", "", "share of crumbs", false, false},
      {"kinetic_energy", "J", "kinetic energy", false, false},
      {"elastic_energy", "J", "elastic energy", false, false},
      {"mean_J_P", "", "mean J_P", false, false},
      {"min_J_P", "", "least J_P", false, false},
      {"max_J_P", "", "greatest J_P", false, false},
      {"max_speed", "m/s", "top speed", false, false},
      {"max_force", "N", "top force", false, false},
      {"max_pressure", "Pa", "top pressure", false, false},
      {"body_fall", "m", "fall of a body", false, false, false, true},
      {"body_way", "m", "way of a body", false, false, false, true},
      {"max_body_speed", "m/s", "top speed of a body", false, false, false, true},
      {"steps", "", "steps", true, false, true},
      {"seconds", "s", "time", false, true, true}};
  return infos;
}

std::vector<std::size_t> listed_metrics(const std::vector<RunResult>& results) {
  std::vector<std::size_t> listed;
  for (std::size_t k = 0; k < metric_infos().size(); ++k)
    if (!metric_infos()[k].is_of_bodies ||
        std::any_of(results.begin(), results.end(),
                    [&](const RunResult& r) { return k < r.metrics.size() && r.metrics[k]; }))
      listed.push_back(k);
  return listed;
}

bool is_whole(const Run& run, const RunResult& result) {
  return result.status.state == RunState::ok ||
         (!result.frames.empty() && result.frames.back() >= run.frames.last);
}

std::optional<double> told_metric(const Run& run, const RunResult& result, std::size_t metric) {
  const bool is_told = metric_infos()[metric].is_cost || is_whole(run, result);
  return is_told && metric < result.metrics.size() ? result.metrics[metric] : std::nullopt;
}

namespace {

/// @param run_json  of the run
std::string flaws_of(const std::filesystem::path& run_folder, const Run& run,
                     const RunStatus& status, const Json& run_json) {
  if (!has_record(status)) return {};
  const record::Verification found = record::verify_run(run_folder);
  if (!found.flaws.empty()) return record::flaw_text(found.flaws);
  if (status.state == RunState::ok && found.last_frame < run.frames.last)
    return "run.json does not reach frame " + std::to_string(run.frames.last);
  const std::string other = difference_of_record(status, run_json);
  return other.empty() ? "" : "run.json " + other;
}

}  // namespace

std::string flaws_of_run(const std::filesystem::path& folder, const Run& run,
                         const RunStatus& status) {
  const std::filesystem::path run_folder = runs_folder(folder) / run.folder;
  return flaws_of(run_folder, run, status, record::read_run_json(run_folder));
}

std::optional<std::string> why_to_make(const std::filesystem::path& folder, const Run& run,
                                       const RunStatus& status, const Retry& retry) {
  if (!is_finished(status.state) || retry.contains(status.state)) return "";
  std::string flaws = flaws_of_run(folder, run, status);
  return flaws.empty() ? std::nullopt : std::optional(std::move(flaws));
}

RunResult read_result(const std::filesystem::path& folder, const Run& run,
                      const std::string& view) {
  RunResult result;
  const std::filesystem::path run_folder = runs_folder(folder) / run.folder;
  result.status = read_status(run_folder);
  const bool is_damaged = result.status.is_damaged;
  // A folder that was given to another run in the meantime tells nothing about this one.
  if (result.status.key != run.key) result.status = RunStatus{};
  std::vector<record::FrameRecord> frames;
  RunNotes notes;
  // Files in the folder of a run that has not begun are of its simulation, drawn otherwise.
  const bool has_begun = result.status.key == run.key && result.status.state != RunState::pending;
  const Json record = has_begun ? record::read_run_json(run_folder) : Json();
  // Numbers of another simulation are none of this run.
  if (record.is_object() && !is_of_other_simulation(result.status, record)) {
    frames = record::frame_records(record);
    // Other commands may have made the run longer: it is compared at the end of the sweep.
    std::erase_if(frames, [&](const record::FrameRecord& f) { return f.frame > run.frames.last; });
    notes = notes_of(record, frames);
    result.warnings = notes.warnings;
    result.simd = notes.simd;
    result.sources = notes.sources;
  }
  std::error_code error;
  // run.json lists a frame before its pictures are written: a run that was killed lacks the last.
  for (const record::FrameRecord& frame : frames)
    if (frame.frame >= run.frames.first &&
        std::filesystem::is_regular_file(output::frame_path(run_folder, view, frame.frame),
                                         error)) {
      result.frames.push_back(frame.frame);
      result.places.push_back({frame.frame, frame.time, frame.metrics.particles,
                               frame.summary.centre_of_mass, frame.metrics.spread,
                               frame.metrics.height});
    }
  if (is_damaged)
    result.flaws = "status.json is damaged";
  else if (result.status.key == run.key)
    result.flaws = flaws_of(run_folder, run, result.status, record);
  if (!notes.start && !frames.empty())
    notes.start = {frames.front().metrics, frames.front().bodies};
  result.metrics = metrics_of(frames, notes.start.value_or(record::RunStart{}), notes.whole,
                              result.status, notes.diverged_at);
  if (!frames.empty() && is_whole(run, result)) {
    const record::Metrics &first = notes.start->metrics, &last = frames.back().metrics;
    result.has_broken = record::has_broken(first, last);
    result.whole = record::held_whole(first, last);
    if (result.status.state == RunState::ok && frames.back().advance.steps > 0)
      result.end_hash = frames.back().state_hash;
  }
  return result;
}

std::vector<RunResult> read_results(const std::filesystem::path& folder, const Manifest& manifest) {
  std::vector<RunResult> results;
  for (const Run& run : manifest.runs) results.push_back(read_result(folder, run, manifest.view));
  return results;
}

std::vector<std::string> variant_flaws(const std::filesystem::path& folder,
                                       const Manifest& manifest) {
  std::set<std::string> told;  // one that is a run of the sweep as well is read with those
  for (const Run& run : manifest.runs) told.insert(run.folder);
  std::vector<std::string> lines;
  for (const Variant& variant : manifest.variants) {
    if (!variant.failure.empty() || !told.insert(variant.run.folder).second) continue;
    if (const RunResult result = read_result(folder, variant.run, manifest.view);
        !result.flaws.empty())
      lines.push_back(run_text(variant.run) + ": " + result.flaws);
  }
  return lines;
}

namespace {

/// States are of the snow alone: they say nothing of dust and of pictures.
bool concerns_snow(const std::string& address) {
  return scene::concerns_simulation(address) && address != "dust" &&
         !address.starts_with("dust.") && !address.ends_with(".dust");
}

std::uint64_t hash_of(const scene::Override& setting) {
  const std::string text = setting.address + "=" + setting.value;
  return hash_bytes(text.data(), text.size());
}

/// True if runs that differ in one parameter alone were compared, and end with the same bits.
bool is_idle(const std::string& address, const Manifest& manifest,
             const std::vector<RunResult>& results) {
  struct First {
    std::string value;
    std::uint64_t end_hash;
  };
  std::unordered_map<std::uint64_t, First> firsts;  // by the values of all other parameters
  bool is_compared = false;
  for (std::size_t k = 0; k < std::min(results.size(), manifest.runs.size()); ++k) {
    const Run& run = manifest.runs[k];
    const std::string value = run.setting(address);
    if (results[k].end_hash == 0 || value.empty()) continue;
    auto others = static_cast<std::uint64_t>(run.frames.last);
    for (const scene::Override& other : run.settings)
      if (other.address != address) others += hash_of(other);
    const auto [first, is_new] = firsts.try_emplace(others, First{value, results[k].end_hash});
    if (first->second.end_hash != results[k].end_hash) return false;
    is_compared = is_compared || first->second.value != value;
  }
  return is_compared;
}

}  // namespace

std::string other_ends(const std::vector<RunResult>& results, int& ok) {
  int failed = 0;
  ok = 0;
  for (const RunResult& result : results) {
    failed += has_failed(result.status.state);
    ok += result.status.state == RunState::ok;
  }
  const int open = static_cast<int>(results.size()) - ok - failed;
  return (failed > 0 ? fmt::format(", {} failed", failed) : "") +
         (open > 0 ? fmt::format(", {} not finished", open) : "");
}

std::vector<std::string> idle_lines(const Manifest& manifest,
                                    const std::vector<RunResult>& results) {
  std::set<std::string> addresses;
  for (const Run& run : manifest.runs)
    for (const scene::Override& setting : run.settings) addresses.insert(setting.address);
  std::vector<std::string> lines;
  for (const std::string& address : addresses)
    if (concerns_snow(address) && is_idle(address, manifest, results))
      lines.push_back(address +
                      " changes no bit of the snow: runs that differ in it alone end in one state");
  return lines;
}

std::vector<std::string> mixture_lines(const std::vector<RunResult>& results) {
  std::map<std::string, int> by_simd, by_sources;
  for (const RunResult& result : results) {
    if (result.frames.empty()) continue;
    if (!result.simd.empty()) ++by_simd[result.simd];
    if (!result.sources.empty()) ++by_sources[result.sources];
  }
  std::vector<std::string> lines;
  if (by_simd.size() > 1) {
    std::vector<std::string> counts;
    for (const auto& [simd, count] : by_simd) counts.push_back(fmt::format("{} {}", count, simd));
    lines.push_back(fmt::format(
        "runs of this table were made with different instructions ({}): they differ in their last "
        "digits for no other reason; NEVE_SIMD=baseline on all machines, with another --out, gives "
        "all the same",
        joined(counts, ", ")));
  }
  if (by_sources.size() > 1)
    lines.push_back(fmt::format(
        "runs of this table were made by {} programs whose sources differ: they may "
        "differ for no other reason; the command of the sweep makes outdated runs again",
        by_sources.size()));
  return lines;
}

std::string warning_count_text(std::size_t count) {
  return fmt::format("{} {}", count, count == 1 ? "warning" : "warnings");
}

std::vector<std::string> warning_lines(const Manifest& manifest,
                                       const std::vector<RunResult>& results) {
  constexpr std::size_t max_lines = 5;
  std::vector<std::string> lines;
  std::size_t further = 0;
  for (std::size_t k = 0; k < results.size(); ++k) {
    if (results[k].warnings.empty()) continue;
    if (lines.size() >= max_lines) {
      ++further;
      continue;
    }
    std::string line = run_text(manifest.runs[k]) + ": ";
    for (const std::string& warning : results[k].warnings)
      line += (&warning == &results[k].warnings.front() ? "" : "; ") + warning;
    lines.push_back(line);
  }
  if (further > 0)
    lines.push_back(fmt::format("and {} more runs with warnings, see report.html", further));
  return lines;
}

}  // namespace neve::app::sweep::store

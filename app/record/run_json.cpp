#include "app/record/run_json.h"

#include <fmt/core.h>

#include <algorithm>
#include <new>

#include "app/output/atomic_file.h"
#include "app/output/json_file.h"
#include "app/output/sequence.h"
#include "app/support/version.h"
#include "sim/base/hash.h"

namespace neve::app::record {

namespace {

sim::DtLimit limit_named(const std::string& text) {
  for (int k = 0; k < sim::dt_limit_count; ++k)
    if (const auto limit = static_cast<sim::DtLimit>(k); text == sim::name(limit)) return limit;
  return sim::DtLimit::max_dt;
}

}  // namespace

const char* name(RunStatus status) {
  switch (status) {
    case RunStatus::running:
      return "running";
    case RunStatus::ok:
      return "ok";
    case RunStatus::diverged:
      return "diverged";
    case RunStatus::interrupted:
      return "interrupted";
    case RunStatus::failed:
      return "failed";
  }
  return "failed";
}

std::string hash_text(std::uint64_t hash) {
  return fmt::format("{:016x}", hash);
}

std::string hash_of(const std::string& text) {
  return hash_text(hash_bytes(text.data(), text.size()));
}

namespace {

/// Adds metrics. Without snow all but the number of fragments are null.
void add_metrics(const Metrics& metrics, Json& json) {
  const auto number = [&](double value) {
    return metrics.particles > 0 ? number_or_null(value) : Json();
  };
  json["spread"] = number(metrics.spread);
  json["height"] = number(metrics.height);
  json["mean_J_P"] = number(metrics.mean_J_P);
  json["fragments"] = metrics.fragments;
  json["largest_fragment"] = number(metrics.largest_fragment);
  json["powder"] = number(metrics.powder);
  json["crumbs"] = number(metrics.crumbs);
}

Metrics metrics_of(const Json& json) {
  Metrics metrics{
      output::number_or_nan(json.at("spread")), output::number_or_nan(json.at("height")),
      output::number_or_nan(json.at("mean_J_P")), whole_number<std::size_t>(json.at("fragments")),
      output::number_or_nan(json.at("largest_fragment"))};
  for (const auto& [name, value] :
       {std::pair{"powder", &metrics.powder}, std::pair{"crumbs", &metrics.crumbs}})
    *value = json.contains(name) ? output::number_or_nan(json.at(name)) : std::nan("");
  metrics.particles =
      whole_number_or(json, "measured", whole_number_or(json, "particles", std::size_t{0}));
  return metrics;
}

Json bodies_json(const std::vector<BodyRecord>& bodies) {
  Json json = Json::array();
  for (const BodyRecord& body : bodies) json.push_back(to_json(body));
  return json;
}

Json start_json(const RunStart& start) {
  Json json;
  add_metrics(start.metrics, json);
  json["particles"] = start.metrics.particles;
  json["bodies"] = bodies_json(start.bodies);
  if (start.before) json["before"] = to_json(*start.before);
  return json;
}

}  // namespace

Json to_json(const FrameRecord& frame) {
  const bool has_steps = frame.advance.steps > 0;
  const sim::Summary& s = frame.summary;
  Json json;
  json["frame"] = frame.frame;
  json["time"] = number_or_null(frame.time);
  json["steps"] = frame.advance.steps;
  json["dt_min"] = has_steps ? number_or_null(frame.advance.dt_min) : Json();
  json["dt_max"] = has_steps ? number_or_null(frame.advance.dt_max) : Json();
  json["dt_limit"] = has_steps ? Json(sim::name(frame.advance.limit())) : Json();
  const std::optional<sim::SolveReport>& solve = frame.advance.solve;
  json["solve_iterations"] = solve ? Json(solve->iterations) : Json();
  json["solve_residual"] = solve ? number_or_null(solve->residual) : Json();
  json["solves_cut_short"] = solve ? Json(solve->cut_short) : Json();
  json["solves_given_up"] = solve ? Json(solve->given_up) : Json();
  json["seconds_sim"] = number_or_null(frame.seconds_sim);
  json["seconds_render"] = number_or_null(frame.seconds_render);
  json["particles"] = s.particles;
  json["emitted"] = s.emitted;
  json["removed"] = s.removed;
  json["withheld"] = s.withheld;
  json["grid_blocks"] = s.grid_blocks;
  json["mass"] = number_or_null(s.mass);
  json["kinetic_energy"] = number_or_null(s.kinetic_energy);
  json["elastic_energy"] = number_or_null(s.elastic_energy);
  json["momentum"] = output::vector_json(s.momentum);
  json["centre_of_mass"] = s.particles > 0 ? output::vector_json(s.centre_of_mass)
                                           : Json::array({Json(), Json(), Json()});
  json["max_speed"] = number_or_null(s.max_speed);
  json["min_J_P"] = s.particles > 0 ? number_or_null(s.min_J_P) : Json();
  json["max_J_P"] = s.particles > 0 ? number_or_null(s.max_J_P) : Json();
  json["denser_than_ice"] = number_or_null(s.denser_than_ice);
  json["max_depth"] = number_or_null(s.max_depth);
  json["max_depth_cells"] = number_or_null(frame.metrics.max_depth_cells);
  if (frame.metrics.particles != s.particles) json["measured"] = frame.metrics.particles;
  add_metrics(frame.metrics, json);
  if (s.dust.born > 0) json["dust"] = to_json(s.dust);
  json["forces"] = Json::array();
  for (const ColliderForce& force : frame.forces) json["forces"].push_back(to_json(force));
  json["bodies"] = bodies_json(frame.bodies);
  json["state_hash"] = hash_text(frame.state_hash);
  return json;
}

Json to_json(const sim::DustTotals& dust) {
  return {{"mass_is", "decoration: taken from no snow"},
          {"particles", dust.airborne()},
          {"mass", number_or_null(dust.airborne_mass())},
          {"born", dust.born},
          {"settled", dust.settled},
          {"faded", dust.faded},
          {"born_mass", number_or_null(dust.born_mass)},
          {"settled_mass", number_or_null(dust.settled_mass)},
          {"faded_mass", number_or_null(dust.faded_mass)}};
}

double particle_steps(const FrameRecord& frame) {
  return static_cast<double>(frame.advance.steps) * static_cast<double>(frame.summary.particles);
}

Json to_json(const ColliderForce& force) {
  return {{"collider", force.collider},
          {"force", output::vector_json(force.force)},
          {"torque", output::vector_json(force.torque)},
          {"max_pressure", number_or_null(force.max_pressure)}};
}

std::vector<ColliderForce> forces_of(const sim::AdvanceReport& advance, const sim::Summary& summary,
                                     const std::vector<scene::Collider>& colliders) {
  std::vector<ColliderForce> forces;
  if (!(advance.seconds > 0)) return forces;
  // Steps without snow have no loads: nothing pushes.
  if (advance.loads.empty())
    for (const scene::Collider& collider : colliders)
      forces.push_back({collider.name, sim::Vec3d::Zero(), sim::Vec3d::Zero(), 0});
  for (std::size_t k = 0; k < std::min(colliders.size(), advance.loads.size()); ++k)
    forces.push_back({colliders[k].name, advance.loads[k].impulse / advance.seconds,
                      advance.loads[k].angular_impulse / advance.seconds, summary.max_pressure[k]});
  return forces;
}

void add_frame(std::vector<FrameRecord>& frames, const FrameRecord& frame) {
  const auto place = std::ranges::lower_bound(frames, frame.frame, {}, &FrameRecord::frame);
  if (place != frames.end() && place->frame == frame.frame)
    *place = frame;
  else
    frames.insert(place, frame);
}

std::string picture_name(const std::string& view, int frame) {
  return output::frame_path({}, view, frame).generic_string();
}

namespace {

sim::DustTotals dust_totals(const Json& json) {
  return {whole_number<std::uint64_t>(json.at("born")),
          whole_number<std::uint64_t>(json.at("settled")),
          whole_number<std::uint64_t>(json.at("faded")),
          output::number_or_nan(json.at("born_mass")),
          output::number_or_nan(json.at("settled_mass")),
          output::number_or_nan(json.at("faded_mass"))};
}

}  // namespace

FrameRecord frame_record(const Json& json) {
  FrameRecord frame;
  frame.frame = whole_number<int>(json.at("frame"));
  frame.time = output::number_or_nan(json.at("time"));
  frame.advance.steps = whole_number<std::size_t>(json.at("steps"));
  if (frame.advance.steps > 0) {
    frame.advance.dt_min = output::number_or_nan(json.at("dt_min"));
    frame.advance.dt_max = output::number_or_nan(json.at("dt_max"));
    const sim::DtLimit limit = limit_named(json.at("dt_limit").get<std::string>());
    frame.advance.ruled[static_cast<std::size_t>(limit)] = frame.advance.steps;
  }
  // Runs of earlier versions have none, explicit steps neither.
  if (json.contains("solve_iterations") && !json.at("solve_iterations").is_null())
    frame.advance.solve = {whole_number<int>(json.at("solve_iterations")),
                           output::number_or_nan(json.at("solve_residual")), 1,
                           whole_number_or(json, "solves_cut_short", std::size_t(0)),
                           whole_number_or(json, "solves_given_up", std::size_t(0))};
  frame.seconds_sim = output::number_or_nan(json.at("seconds_sim"));
  frame.seconds_render = output::number_or_nan(json.at("seconds_render"));
  sim::Summary& s = frame.summary;
  s.time = frame.time;
  s.particles = whole_number<std::size_t>(json.at("particles"));
  // Runs of earlier versions knew no emitters.
  s.emitted = whole_number_or(json, "emitted", std::uint64_t(0));
  s.removed = whole_number_or(json, "removed", std::uint64_t(0));
  s.withheld = whole_number_or(json, "withheld", std::uint64_t(0));
  s.grid_blocks = whole_number_or(json, "grid_blocks", std::size_t(0));
  s.mass = json.contains("mass") ? output::number_or_nan(json.at("mass")) : std::nan("");
  s.kinetic_energy = output::number_or_nan(json.at("kinetic_energy"));
  s.elastic_energy = output::number_or_nan(json.at("elastic_energy"));
  s.momentum = output::vector_of(json.at("momentum"));
  s.centre_of_mass = output::vector_of(json.at("centre_of_mass"));
  s.max_speed = output::number_or_nan(json.at("max_speed"));
  s.min_J_P = output::number_or_nan(json.at("min_J_P"));
  s.max_J_P = output::number_or_nan(json.at("max_J_P"));
  if (json.contains("denser_than_ice"))
    s.denser_than_ice = output::number_or_nan(json.at("denser_than_ice"));
  if (json.contains("dust")) s.dust = dust_totals(json.at("dust"));
  frame.state_hash = std::stoull(json.at("state_hash").get<std::string>(), nullptr, 16);
  // Runs of earlier versions have none.
  if (!json.contains("spread")) return frame;
  frame.metrics = metrics_of(json);
  if (!json.contains("max_depth")) return frame;
  s.max_depth = output::number_or_nan(json.at("max_depth"));
  frame.metrics.max_depth_cells = output::number_or_nan(json.at("max_depth_cells"));
  if (!json.contains("forces")) return frame;
  for (const Json& f : json.at("forces"))
    frame.forces.push_back(
        {f.at("collider").get<std::string>(), output::vector_of(f.at("force")),
         output::vector_of(f.at("torque")),
         f.contains("max_pressure") ? output::number_or_nan(f.at("max_pressure")) : std::nan("")});
  if (!json.contains("bodies")) return frame;
  for (const Json& body : json.at("bodies")) frame.bodies.push_back(body_record(body));
  return frame;
}

std::string channels_name(const std::string& view, int frame) {
  return output::channels_path({}, view, frame).generic_string();
}

Json read_json(const std::filesystem::path& file) {
  try {
    return output::read_json(file);
  } catch (const UnreadableError&) {
    throw;
  } catch (const std::exception& error) {
    rethrow_no_memory(error);
    return {};
  }
}

Json read_run_json(const std::filesystem::path& folder) {
  return read_json(output::run_json_path(folder));
}

std::vector<FrameRecord> frame_records(const Json& run) {
  std::vector<FrameRecord> frames;
  try {
    for (const Json& frame : run.at("frames")) frames.push_back(frame_record(frame));
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception&) {
    frames.clear();
  }
  return frames;
}

std::optional<RunStart> start_of(const Json& run) {
  RunStart start;
  try {
    if (run.contains("start")) {
      const Json& json = run.at("start");
      start.metrics = metrics_of(json);
      for (const Json& body : json.at("bodies")) start.bodies.push_back(body_record(body));
      if (json.contains("before")) start.before = extremes_of(json.at("before"));
      return start;
    }
    const FrameRecord first = frame_record(run.at("frames").at(0));
    if (first.frame != run.at("first_number")) return std::nullopt;
    return RunStart{first.metrics, first.bodies};
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception&) {
    return std::nullopt;
  }
}

std::optional<ViewFrames> frames_asked(const Json& run) {
  try {
    const ViewFrames asked{whole_number<int>(run.at("frames_asked").at(0)),
                           whole_number<int>(run.at("frames_asked").at(1))};
    const bool is_right = -output::max_frame <= asked.first && asked.first <= asked.last &&
                          asked.last <= output::max_frame;
    return is_right ? std::optional(asked) : std::nullopt;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception&) {
    return std::nullopt;
  }
}

FileHashes file_hashes(const Json& run) {
  FileHashes files;
  if (!run.is_object() || !run.contains("files") || !run["files"].is_object()) return files;
  for (const auto& [file, hash] : run["files"].items())
    if (hash.is_string()) files[file] = hash.get<std::string>();
  return files;
}

bool is_untouched(Json run) {
  if (!run.is_object()) return false;
  // Files of this version have a hash.
  if (!run.contains("hash")) return run.value("version", Json()) != version;
  const Json hash = run["hash"];
  run.erase("hash");
  return hash == hash_of(to_text(run));
}

std::vector<FrameRecord> read_frame_records(const std::filesystem::path& folder) {
  return frame_records(read_run_json(folder));
}

namespace {

/// Lists views, earlier ones first, each once.
std::vector<std::string> all_views(const RunRecord& run) {
  std::vector<std::string> names = run.earlier_views;
  for (const std::string& view : run.views)
    if (std::find(names.begin(), names.end(), view) == names.end()) names.push_back(view);
  return names;
}

bool has_all(const ViewFrames& frames, const std::vector<FrameRecord>& list) {
  return !list.empty() && frames.first == list.front().frame && frames.last == list.back().frame;
}

void add_views(const RunRecord& run, Json& json) {
  const std::vector<std::string> names = all_views(run);
  json["views"] = names;
  Json drawings = Json::object(), frames = Json::object();
  std::vector<std::string> with_passes;
  for (const std::string& name : names) {
    const auto found = run.view_records.find(name);
    const ViewRecord view = found == run.view_records.end() ? ViewRecord{} : found->second;
    if (!view.drawing.empty()) drawings[name] = view.drawing;
    if (view.frames && !has_all(*view.frames, run.frames))
      frames[name] =
          view.frames->count() > 0 ? Json{view.frames->first, view.frames->last} : Json::array();
    const auto& ours = run.views_of_passes;
    if (view.has_passes || std::find(ours.begin(), ours.end(), name) != ours.end())
      with_passes.push_back(name);
  }
  if (!drawings.empty()) json["drawings"] = drawings;
  if (!frames.empty()) json["view_frames"] = frames;
  if (with_passes.empty()) return;
  if (!run.passes.empty()) json["passes"] = run.passes;
  json["views_of_passes"] = with_passes;
}

}  // namespace

Json to_json(const RunRecord& run) {
  Json json;
  json["version"] = version;
  json["build"] = build_json();
  json["scene"] = run.scene;
  if (!run.undrawn.empty()) json["undrawn"] = run.undrawn;
  json["scene_file"] = run.scene_file;
  json["overrides"] = run.overrides;
  json["changes"] = scene::to_json(run.changes);
  json["coarsen"] = run.coarsening;
  if (!run.prediction.is_null()) json["prediction"] = run.prediction;
  if (!run.forked.is_null()) json["forked"] = run.forked;
  if (!run.simulation.empty()) json["simulation"] = run.simulation;
  if (!run.scene_files.empty()) json["scene_files"] = run.scene_files;
  add_views(run, json);
  if (!run.exports.is_null()) json["exports"] = run.exports;
  json["backend"] = run.backend;
  json["gl_renderer"] = run.gl_renderer;
  json["threads"] = run.threads;
  json["simd"] = run.simd;
  json["status"] = run.carried_status.empty() ? name(run.status) : run.carried_status;
  if (!run.error.empty()) json["error"] = run.error;
  json["frames"] = Json::array();
  for (const FrameRecord& frame : run.frames) json["frames"].push_back(to_json(frame));
  json["first_number"] = run.first_number;
  if (run.asked) json["frames_asked"] = {run.asked->first, run.asked->last};
  if (run.start) json["start"] = start_json(*run.start);
  json["world_offset"] = run.world_offset ? output::vector_json(*run.world_offset) : Json();
  json["slate"] = run.slate ? Json(*run.slate) : Json();
  if (run.frames_from_states > 0) json["frames_from_states"] = run.frames_from_states;
  json["files"] = run.files;
  if (!run.movies.empty()) json["movies"] = run.movies;
  for (const auto& [movie, shown] : short_movies(run))
    json["movie_frames"][movie] = {shown.first, shown.last};
  json["warnings"] = run.warnings;
  if (!run.step_warnings.empty()) json["step_warnings"] = run.step_warnings;
  json["slowdown"] = run.slowdown ? Json(*run.slowdown) : Json();
  if (!run.validation.empty()) json["validation"] = output::to_json(run.validation);
  if (!run.retries.empty()) json["retries"] = Json::array();
  for (const sim::Retry& retry : run.retries) json["retries"].push_back(output::to_json(retry));
  if (run.divergence) {
    json["divergence"] = output::to_json(*run.divergence);
    json["divergence"]["cause"] = run.cause;
  }
  if (!run.states.is_null()) json["states"] = run.states;
  for (const auto& [key, value] : run.carried.items())
    if (!json.contains(key) || json[key].is_null()) json[key] = value;
  return json;
}

std::string with_own_hash(const Json& json) {
  std::string text = to_text(json);
  // Becomes the last entry: the text is long, and made once.
  text.replace(text.size() - 2, 2, ",\n  \"hash\": \"" + hash_of(text) + "\"\n}\n");
  return text;
}

ViewFrames frames_of(const RunRecord& run, const std::string& view) {
  if (run.frames.empty()) return {};
  return run.view_records.at(view).frames.value_or(
      ViewFrames{run.frames.front().frame, run.frames.back().frame});
}

std::map<std::string, ViewFrames> short_movies(const RunRecord& run) {
  std::map<std::string, ViewFrames> movies = run.movie_frames;
  std::erase_if(movies, [&](const auto& movie) {
    const std::string view = std::filesystem::path(movie.first).stem().string();
    if (!run.files.contains(movie.first) || !run.view_records.contains(view)) return true;
    const ViewFrames frames = frames_of(run, view);
    return movie.second.first <= frames.first && movie.second.last >= frames.last;
  });
  return movies;
}

std::map<std::string, ViewFrames> short_movies(const Json& run) {
  std::map<std::string, ViewFrames> movies;
  try {
    const Json listed = run.value("movie_frames", Json::object());
    for (const auto& [movie, shown] : listed.items())
      movies[movie] = {whole_number<int>(shown.at(0)), whole_number<int>(shown.at(1))};
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception&) {
    return {};
  }
  return movies;
}

std::string short_movie_text(const ViewFrames& shown) {
  return fmt::format(
      " shows frames {} to {}, and its view has others; a command that draws the view, without "
      "--no-movie, makes it whole",
      shown.first, shown.last);
}

void write_run_json(const std::filesystem::path& folder, const RunRecord& run) {
  output::write_file(output::run_json_path(folder), with_own_hash(to_json(run)));
}

}  // namespace neve::app::record

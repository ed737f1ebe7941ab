#include <unistd.h>

#include <fmt/core.h>

#include <filesystem>
#include <iostream>

#include "app/cli/command_line.h"
#include "app/cli/commands.h"
#include "app/dump/histogram.h"
#include "app/dump/quantities.h"
#include "app/health/expected.h"
#include "app/output/atomic_file.h"
#include "app/record/run_json.h"
#include "app/run/render_job.h"
#include "app/scene/names.h"
#include "app/support/errors.h"
#include "app/support/interrupt.h"
#include "app/support/text.h"
#include "app/timeline/origin.h"
#include "app/timeline/times.h"
#include "sim/shapes/held_files.h"

namespace neve::app::cli {

namespace {

std::string force_line(const record::ColliderForce& force) {
  const auto vector = [](const sim::Vec3d& v) {
    return rough_text(v.x()) + " " + rough_text(v.y()) + " " + rough_text(v.z());
  };
  return "snow on " + force.collider + " in the next step: force " + vector(force.force) +
         " N, torque " + vector(force.torque) + " N m, pressure up to " +
         rough_text(force.max_pressure) + " Pa";
}

std::vector<std::string> heading(const run::RenderJob& job, const dump::DumpOptions& options,
                                 const dump::StepInspection& inside, const dump::Listing& listing,
                                 std::uint64_t state_hash) {
  const char* const given_up = inside.step.is_given_up
                                   ? "; its solve is given up: a run takes shorter ones in its "
                                     "place, and after no stage is as it is here"
                                   : "";
  std::vector<std::string> lines{
      job.scene_file + (job.scene.title.empty() ? "" : ": " + job.scene.title),
      "t = " + rough_text(inside.simulation.time()) + " s after " +
          std::to_string(inside.simulation.steps()) + " steps; the next has dt = " +
          rough_text(inside.dt) + " s, set by " + sim::name(inside.limit) + given_up,
      (options.stage ? std::string("after the stage ") + sim::name(*options.stage)
                     : std::string("before the step")) +
          ": " + std::to_string(listing.place.size()) +
          (listing.is_of_nodes
               ? " nodes with mass, of which " + std::to_string(listing.negligible_count()) +
                     " are left out of the summary, lighter than " +
                     rough_text(health::Expected::negligible_share()) + " rho h^3"
               : std::string(" particles")),
      "state " + record::hash_text(state_hash)};
  for (const record::ColliderForce& force : dump::forces_in_step(inside))
    if (force.force != sim::Vec3d::Zero() || force.max_pressure > 0)
      lines.push_back(force_line(force));
  return lines;
}

std::size_t nearest_row(const dump::Listing& listing, const sim::Vec3d& place) {
  std::size_t nearest = 0;
  for (std::size_t row = 1; row < listing.place.size(); ++row)
    if ((listing.place[row] - place).squaredNorm() < (listing.place[nearest] - place).squaredNorm())
      nearest = row;
  return nearest;
}

/// @throws UsageError when no such particle or node exists
std::size_t probed_row(const dump::StepInspection& inside, const dump::Listing& listing,
                       const dump::Probe& probe) {
  if (const auto* place = std::get_if<sim::Vec3d>(&probe)) {
    if (listing.place.empty())
      throw UsageError("--probe", "no particle or node exists", "there is no snow at this time");
    return nearest_row(listing, *place);
  }
  const std::size_t id = std::get<std::size_t>(probe);
  if (listing.is_of_nodes)
    throw UsageError("--probe", "nodes have no id " + std::to_string(id),
                     "expected a place, as in --probe 0,0.5,0");
  const std::optional<std::size_t> row = inside.step.after.index_of(id);
  if (row) return *row;
  const std::string particle = "particle " + std::to_string(id);
  const std::size_t ids = inside.before.x.size() + inside.simulation.flow_totals().removed;
  if (id < ids)
    throw UsageError("--probe", particle + " was removed", "a sink removed it before this time");
  throw UsageError(
      "--probe",
      inside.scene.emitters.empty() ? "there is no " + particle : particle + " is not emitted yet",
      ids == 0 ? "no particle has existed so far" : "expected 0 to " + std::to_string(ids - 1));
}

/// A place in empty space is answered by what is nearest, however far.
void warn_of_far_probes(const dump::DumpOptions& options, const dump::StepInspection& inside,
                        const dump::Listing& listing, Progress& progress) {
  for (const dump::Probe& probe : options.probes) {
    const auto* place = std::get_if<sim::Vec3d>(&probe);
    if (!place || listing.place.empty()) continue;
    const double away = (listing.place[nearest_row(listing, *place)] - *place).norm();
    if (away > 2 * inside.scene.solver.cell_size)
      progress.warning("--probe " + rough_text(place->x()) + "," + rough_text(place->y()) + "," +
                       rough_text(place->z()) + ": no " +
                       (listing.is_of_nodes ? "node" : "particle") +
                       " is at this place; the nearest is " + rough_text(away) + " m away");
  }
}

Json dump_json(const run::RenderJob& job, const dump::DumpOptions& options,
               const dump::StepInspection& inside, const dump::Listing& listing,
               std::uint64_t state_hash, const std::vector<std::size_t>& probed) {
  Json json;
  json["scene"] = job.scene_file;
  json["time"] = inside.simulation.time();
  json["steps"] = inside.simulation.steps();
  json["dt"] = inside.dt;
  json["dt_limit"] = sim::name(inside.limit);
  json["stage"] = options.stage ? Json(sim::name(*options.stage)) : Json();
  json["state_hash"] = record::hash_text(state_hash);
  json[listing.is_of_nodes ? "nodes" : "particles"] = listing.place.size();
  json["forces"] = Json::array();
  for (const record::ColliderForce& force : dump::forces_in_step(inside))
    json["forces"].push_back(record::to_json(force));
  json["quantities"] = dump::summary_json(listing);
  if (options.is_histogram) json["histograms"] = dump::histograms_json(listing);
  json["probes"] = Json::array();
  for (const std::size_t row : probed) json["probes"].push_back(dump::probe_json(listing, row));
  return json;
}

/// The text of one moment that is no JSON.
std::string dump_text(const run::RenderJob& job, const dump::DumpOptions& options,
                      const dump::StepInspection& inside, const dump::Listing& listing,
                      std::uint64_t state_hash, const std::vector<std::size_t>& probed) {
  const std::vector<std::string> head = heading(job, options, inside, listing, state_hash);
  std::string text;
  for (const std::string& line : head) text += line + "\n";
  if (options.is_histogram) {
    for (const dump::Histogram& histogram : dump::histograms_of(listing)) {
      text += "\n";
      for (const std::string& line : dump::histogram_lines(histogram)) text += line + "\n";
    }
    return text;
  }
  if (!probed.empty()) {
    for (const std::size_t row : probed) {
      text += "\n";
      for (const std::string& line : dump::probe_lines(listing, row)) text += line + "\n";
    }
    return text;
  }
  return options.format == dump::DumpFormat::vtk ? dump::to_vtk(listing)
                                                 : dump::to_table(listing, head);
}

/// "fields_0002.vtp" for "fields.vtp".
std::filesystem::path numbered(const std::filesystem::path& file, std::size_t number) {
  return file.parent_path() /
         fmt::format("{}_{:04}{}", file.stem().string(), number, file.extension().string());
}

/// Collects the moments that are asked for, and puts them where they are wanted.
class DumpOutput {
 public:
  DumpOutput(const run::RenderJob& job, const dump::DumpOptions& options)
      : job_(job), options_(options) {}

  /// @param state_hash  before the step
  void add(const dump::StepInspection& inside, const dump::Listing& listing,
           std::uint64_t state_hash) {
    std::vector<std::size_t> probed;
    for (const dump::Probe& probe : options_.probes)
      probed.push_back(probed_row(inside, listing, probe));
    if (options_.run.is_json) {
      list_.push_back(dump_json(job_, options_, inside, listing, state_hash, probed));
      return;
    }
    put(dump_text(job_, options_, inside, listing, state_hash, probed));
  }

  void finish() {
    if (options_.run.is_json) {
      const std::string text = to_text(options_.at.size() == 1 ? list_.at(0) : list_) + "\n";
      if (options_.file.empty())
        std::cout << text;
      else
        output::write_named_file(options_.file, text);
    }
    finish_output();
  }

 private:
  void put(const std::string& text) {
    if (options_.file.empty() && options_.format != dump::DumpFormat::vtk)
      std::cout << (count_ > 0 ? "\n" : "") << text;
    else if (options_.file.empty())
      output::write_named_file("/dev/stdout", text);  // bytes, not text
    else
      output::write_named_file(
          options_.at.size() == 1 ? options_.file : numbered(options_.file, count_).string(), text);
    ++count_;
  }

  const run::RenderJob& job_;
  const dump::DumpOptions& options_;
  Json list_ = Json::array();
  std::size_t count_ = 0;
};

void check_dump_output(const dump::DumpOptions& options) {
  if (options.is_histogram && !options.probes.empty())
    throw UsageError("--histogram", "is of all nodes or particles, --probe of one",
                     "give one of the two");
  if (options.is_histogram && options.format == dump::DumpFormat::vtk)
    throw UsageError("--histogram", "is text, --format vtk is points",
                     "remove --format, or add --json for numbers");
  if (options.format != dump::DumpFormat::vtk || !options.file.empty()) return;
  if (options.at.size() > 1)
    throw UsageError("--format", "vtk has one time in a file",
                     "give a file with --out, as in --out fields.vtp");
  if (::isatty(STDOUT_FILENO))
    throw UsageError("--format", "vtk is binary and standard output is a terminal",
                     "give a file with --out, as in --out fields.vtp");
}

dump::Listing listing_of(const dump::DumpOptions& options, const dump::StepInspection& inside) {
  dump::Listing listing =
      options.stage ? dump::list_stage(inside, *options.stage) : dump::list_state(inside);
  dump::keep_only(listing, options.fields);
  return listing;
}

}  // namespace

int run_dump(const dump::DumpOptions& given) {
  const sim::shapes::HeldFiles files;
  dump::DumpOptions options = given;
  options.run.is_start_only = true;  // the times are those of who asks
  const run::RenderJob job = run::make_job(options.run);
  timeline::require_before_end("--at", options.at.back(), job);
  const setup::Plan plan =
      setup::make_plan(job.scene, job.frames, job.quality, options.run.threads);
  setup::check_limits(job.scene, plan, job.coarsening);
  check_dump_output(options);
  catch_interrupts();
  Progress progress(options.run.verbosity, options.run.progress);
  timeline::Timeline timeline = timeline::open(job, options.run.threads, progress);
  const sim::Simulation& simulation = timeline.simulation();
  progress.start(timeline::frame_at(options.at.back(), job.scene.fps),
                 scene::number_of(job.scene, 0));
  DumpOutput out(job, options);
  for (const double at : options.at) {
    timeline.go_to(at);
    progress.clear();
    if (is_interrupted()) throw Error(exit_interrupted, "interrupted before the requested time");
    if (simulation.divergence())
      progress.warning(simulation.divergence()->sentence + "; this is its last state");
    const auto inspect = [&] {
      const double left = timeline.frame_end() - simulation.time();
      return dump::inspect_step(*timeline.here().scene, simulation,
                                left > 0 ? left : 1 / job.scene.fps);
    };
    // The state is as the last step has left it; all else is of the next step, for which curves may
    // have other values.
    const std::uint64_t state_hash = simulation.state_hash();
    std::optional<dump::StepInspection> before;
    std::optional<dump::Listing> state;
    if (!options.stage) {
      before.emplace(inspect());
      state = listing_of(options, *before);
    }
    timeline.look_at_next([&](bool has_other_values) {
      std::optional<dump::StepInspection> other;
      if (has_other_values || !before) other.emplace(inspect());
      const dump::StepInspection& inside = other ? *other : *before;
      const dump::Listing listing = state ? *std::move(state) : listing_of(options, inside);
      warn_of_far_probes(options, inside, listing, progress);
      out.add(inside, listing, state_hash);
    });
    if (simulation.divergence()) break;
  }
  out.finish();
  return simulation.divergence() ? exit_diverged : exit_ok;
}

}  // namespace neve::app::cli

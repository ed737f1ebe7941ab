#include "app/run/fork.h"

#include <fmt/core.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "app/scene/flat.h"
#include "app/scene/presets.h"
#include "app/scene/read.h"
#include "app/scene/scene_file.h"
#include "app/scene/toml/value.h"
#include "app/setup/curves.h"
#include "app/setup/resolve.h"
#include "app/support/errors.h"
#include "app/support/out_folder.h"
#include "app/support/text.h"
#include "app/timeline/changes.h"
#include "app/timeline/times.h"

namespace neve::app::run {

namespace {

namespace fs = std::filesystem;

scene::Scene with_all_changes(const RenderJob& job) {
  return timeline::with_changes(job.scene, timeline::changes_of(job.scene, job.changes));
}

/// Returns the folder of relative paths in changes: that of a scene file; "" for runs and pictures.
std::string folder_of_changes(const RenderJob& job) {
  return job.run.empty() && !job.picture ? scene::base_dir_of(job.scene_file) : std::string();
}

/// The numbers that presets set and that can change while a run runs; others stay, with a note.
/// They come first, as where a scene is read: wherever a single number is set beside a preset, the
/// number counts, and a curve has the word over both.
void take_live_numbers(const scene::Scene& before, Fork& fork) {
  const auto beside = std::stable_partition(
      fork.changes.begin(), fork.changes.end(),
      [](const scene::Override& o) { return scene::is_preset_address(o.address); });
  const std::vector<scene::Override> presets(fork.changes.begin(), beside);
  std::vector<scene::Override> changes;
  for (const scene::Difference& number :
       scene::differences(before, scene::apply(before, presets, "the scene"))) {
    if (const scene::Curve* curve = setup::curve_of(before, number.address))
      fork.notes.push_back(fmt::format("{} is not of the preset: it follows its curve {}",
                                       number.address, curve->name));
    else if (number.is_live)
      changes.push_back({number.address, scene::toml::toml_literal(*number.after)});
    else
      fork.notes.push_back(fmt::format("{} stays {}: it cannot change while a simulation runs",
                                       number.address, scene::toml::toml_literal(*number.before)));
  }
  changes.insert(changes.end(), beside, fork.changes.end());
  fork.changes = std::move(changes);
}

/// Goes to a frame, and says what was greatest on the way from the start.
record::Extremes pass_frames(int last, timeline::Timeline& timeline) {
  record::Extremes extremes{scene::number_of(timeline.start(), 0) - 1};
  for (int frame = 0; frame <= last && timeline.go_to(frame / timeline.fps()); ++frame)
    add_passed(timeline, extremes);
  return extremes;
}

}  // namespace

void require_whole_frame(const scene::Scene& scene, double time, const char* flag) {
  const double frame_end = timeline::frame_at(time, scene.fps) / scene.fps;
  if (scene.solver.on_divergence != sim::OnDivergence::retry ||
      timeline::is_not_after(time, frame_end))
    return;
  throw UsageError(flag,
                   fmt::format("{} s is between two frames; with solver.on_divergence = \"retry\" "
                               "a fork must be at a frame",
                               rough_text(time)),
                   fmt::format("expected the time of a frame, as in {} {}", flag, frame_end));
}

void set_fork(const RenderOptions& options, RenderJob& job) {
  job.fork = Fork{*options.from, scene::parse_overrides(options.overrides)};
  const scene::Scene before = with_all_changes(job);
  take_live_numbers(before, *job.fork);
  setup::refuse_followers(before, job.fork->changes);
  const scene::Scene forked =
      scene::apply(before, job.fork->changes, job.scene_file, folder_of_changes(job));
  timeline::require_live(before, forked, "--from");
  job.scene.limits = forked.limits;  // of the command, which is checked before it simulates
  const int first = timeline::frame_at(job.fork->time, job.scene.fps) + 1;
  const std::optional<setup::FrameRange> frames =
      options.frames ? std::optional(setup::frames_of(job.scene, *options.frames)) : std::nullopt;
  const bool is_length_set = scene::sets(job.fork->changes, "frames");
  const int last = frames          ? frames->last
                   : is_length_set ? scene::last_frame(forked)
                                   : job.last_frame();
  if (last < first)
    throw UsageError("--from",
                     fmt::format("{} s is at or after frame {}, the last one", job.fork->time,
                                 scene::number_of(job.scene, last)),
                     "expected an earlier time, or a later frame with --frames" +
                         timeline::advice_on_frame(job.fork->time, last, job.scene));
  job.frames = {frames ? std::max(frames->first, first) : first, last};
  if (options.out.empty())
    job.folder = out_folder() / fmt::format("{}-from-{}s", job.name(), rough_text(job.fork->time));
  std::error_code error;
  if (!job.run.empty() && fs::equivalent(job.folder, job.run, error))
    throw UsageError("--out", job.folder.string() + " is the run that is forked",
                     "name another folder");
}

scene::Scene scene_before_fork(const RenderJob& job) {
  const int last = timeline::frame_at(job.fork->time, job.scene.fps);
  std::size_t steps = 0;
  int known = 0;  // frames, from the first: those that were not drawn are not listed
  for (const record::FrameRecord& record : job.run_frames) {
    if (record.frame > last || record.frame != known) break;
    ++known;
    steps += record.advance.steps;
  }
  if (known <= last) return with_all_changes(job);
  return timeline::with_changes(job.scene, timeline::changes_of(job.scene, job.changes), steps);
}

void walk_to_fork(RenderJob& job, timeline::Timeline& timeline, Progress& progress) {
  const double time = job.fork->time;
  require_whole_frame(scene_before_fork(job), time, "--from");
  const int first = scene::number_of(job.scene, 0), last = timeline::frame_at(time, timeline.fps());
  progress.start(last, first);
  record::RunStart start = start_beside(timeline, job, first + last);
  if (job.run.empty()) start.before = pass_frames(last, timeline);
  const bool is_reached = timeline.go_to(time);
  progress.clear();
  if (const std::optional<sim::Divergence>& divergence = timeline.simulation().divergence())
    throw Error(exit_diverged,
                fmt::format("{} diverges before {} s: {}", job.scene_file, rough_text(time),
                            divergence->sentence),
                job.scene_file, "fork it at an earlier time");
  if (!is_reached) throw Error(exit_interrupted, "interrupted before the first frame");
  timeline.fork();
  job.fork->start = std::move(start);
}

void go_to_fork(RenderJob& job, timeline::Timeline& timeline, Progress& progress) {
  for (const std::string& note : job.fork->notes) progress.note(note);
  walk_to_fork(job, timeline, progress);
  const sim::Simulation& simulation = timeline.simulation();
  job.forked = {{"from", job.scene_file},
                {"time", simulation.time()},
                {"frame", scene::number_of(job.scene, timeline.here().frame)},
                {"step", simulation.steps()},
                {"state_hash", record::hash_text(simulation.state_hash())}};
  const scene::Scene& before = *timeline.here().scene;
  scene::Scene next =
      scene::apply(before, job.fork->changes, job.scene_file, folder_of_changes(job));
  setup::reopen(next, job.fork->changes);
  setup::resolve(next, simulation.particle_count());
  timeline::require_live(before, next, "--from");
  timeline.change(next);
  job.changes = timeline.changes();
  job.scene = timeline.start();
}

}  // namespace neve::app::run

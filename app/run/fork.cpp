#include "app/run/fork.h"

#include <fmt/core.h>

#include <cmath>
#include <stdexcept>

#include "app/output/sequence.h"
#include "app/run/run_json.h"
#include "app/scene/flat.h"
#include "app/scene/params.h"
#include "app/scene/read.h"
#include "app/setup/resolve.h"
#include "app/support/errors.h"
#include "app/support/interrupt.h"
#include "app/support/out_folder.h"
#include "app/support/text.h"

namespace neve::app::run {

namespace {

namespace fs = std::filesystem;

/// Times are typed in decimals.
constexpr double typed_rounding = 1 + 1e-12;

/// Addresses that may change while a simulation runs and concern it; of shapes and keyframes, which
/// have many, the part that they share.
std::string live_addresses() {
  std::vector<std::string> addresses;
  for (const scene::ParamInfo& param : scene::params()) {
    if (!param.is_live || !scene::concerns_simulation(param.address)) continue;
    std::string address = param.address;
    for (const char* part : {".shape.", ".keyframes"})
      if (const std::size_t at = address.find(part); at != std::string::npos)
        address = address.substr(0, at + std::string(part).size()) + "...";
    if (addresses.empty() || addresses.back() != address) addresses.push_back(address);
  }
  return joined(addresses, ", ");
}

/// The scene with the changes of the run so far and those of the fork.
scene::Scene forked_scene(const RenderJob& job, std::size_t steps) {
  const SceneSource source{scene::write_scene(job.scene), job.scene_file, {}, {}};
  const scene::Scene before = with_changes(source, changes_of(job.scene, job.changes), steps);
  return scene::read_scene_text(scene::write_scene(before), job.scene_file, {}, job.fork->changes);
}

/// Takes the frames and steps of a run up to a fork, as the run itself takes them.
class ForkWalk {
 public:
  ForkWalk(const RenderJob& job, ChangePlayer& player, sim::Simulation& simulation,
           Progress& progress)
      : job_(job), player_(player), simulation_(simulation), progress_(progress) {}

  ResumedRun go() {
    begin();
    const int last = frame_before(job_.fork->time, fps());
    while (run_.frame < last) take_frame();
    take_steps();
    run_.steps = simulation_.steps();
    return std::move(run_);
  }

 private:
  double fps() const { return job_.scene.fps; }

  void begin() {
    player_.begin();
    const auto found = checkpoint_before(job_.fork->past, job_.fork->time, fps(), simulation_);
    if (found) {
      go_to_checkpoint(*found, fps(), player_, simulation_);
      run_ = *found;
      run_.state.clear();
      run_.frames.clear();
      run_.files.clear();
      progress_.note(fmt::format("continues from the checkpoint of frame {}", run_.frame));
    } else {
      run_.history.push_back(
          picture::plot_sample(0, 1 / fps(), simulation_.summary(), sim::AdvanceReport{}));
    }
    run_.exports = Json::array();
  }

  void take_frame() {
    run_.advance.append(player_.advance_to((run_.frame + 1) / fps(),
                                           [this] { return after_step(); }, run_.retries));
    check();
    ++run_.frame;
    run_.history.push_back(
        picture::plot_sample(run_.frame / fps(), 1 / fps(), simulation_.summary(), run_.advance));
    run_.advance = {};
    progress_.frame(run_.frame, run_.frame / fps());
  }

  /// As far as whole steps lead inside of the frame.
  void take_steps() {
    const double time = job_.fork->time, end = (run_.frame + 1) / fps();
    if (!(time > simulation_.time() * typed_rounding)) return;
    require_whole_frame(player_.scene(), time, "--from");
    const auto end_of_next_step = [&] {
      return simulation_.time() + simulation_.choose_dt(end - simulation_.time()).dt;
    };
    while (end_of_next_step() <= time * typed_rounding) {
      run_.advance.append(player_.step_towards(end, [this] { return after_step(); }));
      check();
    }
  }

  bool after_step() {
    progress_.step();
    return is_interrupted();
  }

  void check() const {
    if (simulation_.divergence())
      throw Error(exit_diverged,
                  fmt::format("{} diverges before {} s: {}", job_.scene_file,
                              rough_text(job_.fork->time), simulation_.divergence()->sentence),
                  job_.scene_file, "fork it at an earlier time");
    if (is_interrupted()) throw Error(exit_interrupted, "interrupted before the first frame");
  }

  const RenderJob& job_;
  ChangePlayer& player_;
  sim::Simulation& simulation_;
  Progress& progress_;
  ResumedRun run_;
};

std::string default_folder(const RenderJob& job, const std::string& source) {
  fs::path path = source.empty() ? fs::path(job.scene_file) : fs::path(source);
  if (!path.has_filename()) path = path.parent_path();
  return path.stem().string() + fmt::format("-from-{}s", rough_text(job.fork->time));
}

}  // namespace

void require_live(const scene::Scene& before, const scene::Scene& after, const char* flag) {
  const std::vector<scene::Difference> restart = scene::split_live(before, after).restart;
  if (restart.empty()) return;
  std::vector<std::string> names;
  for (const scene::Difference& d : restart) names.push_back(d.address);
  throw UsageError(flag, joined(names, ", ") + " cannot change while a simulation runs",
                   "parameters that can: " + live_addresses());
}

void require_whole_frame(const scene::Scene& scene, double time, const char* flag) {
  const double frame_end = frame_before(time, scene.fps) / scene.fps;
  if (scene.solver.on_divergence != sim::OnDivergence::retry ||
      !(time > frame_end * typed_rounding))
    return;
  throw UsageError(
      flag,
      fmt::format("{} s is between two frames, where a run with solver.on_divergence = "
                  "\"retry\" does not take another way",
                  rough_text(time)),
      fmt::format("expected the time of a frame, as {} {}", flag, frame_end));
}

int frame_before(double time, double fps) {
  return static_cast<int>(std::floor(time * fps * typed_rounding));
}

void set_fork(const RenderOptions& options, RenderJob& job) {
  Fork fork;
  fork.time = *options.from;
  fork.changes = scene::parse_overrides(options.overrides);
  const bool is_run = is_folder(options.scene);
  if (is_run) fork.past = {options.scene, read_frame_records(options.scene)};
  job.fork = std::move(fork);
  const scene::Scene forked = forked_scene(job, static_cast<std::size_t>(-1));
  require_live(with_changes({scene::write_scene(job.scene), job.scene_file, {}, {}},
                            changes_of(job.scene, job.changes)),
               forked, "--from");
  const int first = frame_before(job.fork->time, job.scene.fps) + 1;
  const int last = options.frames ? options.frames->last : forked.frames;
  if (last < first)
    throw UsageError(
        "--from",
        fmt::format("{} s is at or after frame {}, the last one", rough_text(job.fork->time), last),
        "expected an earlier time, or a later frame with --frames");
  job.frames = {options.frames ? std::max(options.frames->first, first) : first, last};
  if (options.out.empty()) job.folder = out_folder() / default_folder(job, options.scene);
  std::error_code error;
  if (is_run && fs::equivalent(job.folder, options.scene, error))
    throw UsageError("--out", job.folder.string() + " is the run that is forked",
                     "name another folder");
}

scene::Scene scene_before_fork(const RenderJob& job) {
  const int last = frame_before(job.fork->time, job.scene.fps);
  std::size_t steps = 0;
  int known = 0;  // frames, from the first: those that were not drawn are not listed
  for (const FrameRecord& record : job.fork->past.frames) {
    if (record.frame > last || record.frame != known) break;
    ++known;
    steps += record.advance.steps;
  }
  return with_changes({scene::write_scene(job.scene), job.scene_file, {}, {}},
                      changes_of(job.scene, job.changes),
                      known > last ? steps : static_cast<std::size_t>(-1));
}

ResumedRun walk_to_fork(const RenderJob& job, ChangePlayer& player, sim::Simulation& simulation,
                        Progress& progress) {
  progress.start(frame_before(job.fork->time, job.scene.fps));
  ResumedRun run = ForkWalk(job, player, simulation, progress).go();
  progress.clear();
  player.forget_later();
  return run;
}

ForkPoint go_to_fork(RenderJob& job, sim::Simulation& simulation, Progress& progress) {
  ForkPoint point;
  ChangePlayer player(job.scene, job.changes, simulation);
  point.run = walk_to_fork(job, player, simulation, progress);
  point.record = {{"from", job.scene_file},
                  {"time", simulation.time()},
                  {"frame", point.run.frame},
                  {"step", simulation.steps()},
                  {"state_hash", hash_text(simulation.state_hash())}};
  scene::Scene next = forked_scene(job, simulation.steps());
  setup::resolve_ranges(next, simulation.particle_count());
  require_live(player.scene(), next, "--from");
  player.make_now(std::make_shared<scene::Scene>(next));
  follow_colliders(simulation, next);
  point.scene = std::make_shared<scene::Scene>(next);
  job.changes = player.changes();
  job.scene = recorded_scene(job.scene, next);
  return point;
}

}  // namespace neve::app::run

#include "app/timeline/timeline.h"

#include <algorithm>
#include <limits>
#include <new>
#include <set>
#include <stdexcept>
#include <utility>

#include "app/scene/flat.h"
#include "app/scene/toml/value.h"
#include "app/setup/curves.h"
#include "app/setup/resolve.h"
#include "app/support/clock.h"
#include "app/support/errors.h"
#include "app/support/interrupt.h"
#include "app/timeline/changes.h"
#include "app/timeline/times.h"

namespace neve::app::timeline {

namespace {

constexpr std::size_t no_step = std::numeric_limits<std::size_t>::max();

/// The loads of a frame go with their colliders: those of one that is gone are gone.
std::vector<sim::ColliderLoad> with_colliders(const std::vector<sim::ColliderLoad>& loads,
                                              const std::vector<scene::Collider>& before,
                                              const std::vector<scene::Collider>& after) {
  if (loads.empty()) return {};
  std::vector<sim::ColliderLoad> list(after.size());
  for (std::size_t k = 0; k < after.size(); ++k)
    for (std::size_t b = 0; b < std::min(before.size(), loads.size()); ++b)
      if (before[b].name == after[k].name) list[k] = loads[b];
  return list;
}

/// Returns a scene with other frames: the length of a run concerns no moment of it.
std::shared_ptr<const scene::Scene> with_frames(const std::shared_ptr<const scene::Scene>& scene,
                                                int frames) {
  if (scene->frames == frames) return scene;
  auto other = std::make_shared<scene::Scene>(*scene);
  other->frames = frames;
  return other;
}

}  // namespace

Watch watched_by(Progress& progress, const scene::Scene& scene) {
  const double fps = scene.fps;
  const int first = scene::number_of(scene, 0);
  Watch watch;
  watch.after_step = [&progress](double time) {
    progress.step(time);
    return is_interrupted();
  };
  watch.after_frame = [&progress, fps](int frame) { progress.frame(frame, frame / fps); };
  watch.after_jump = [&progress, first, is_told = false](int frame) mutable {
    if (!is_told)
      progress.note("continues from the checkpoint of frame " + std::to_string(first + frame));
    is_told = true;
  };
  return watch;
}

Timeline::Timeline(const scene::Scene& start, std::vector<scene::LiveChange> changes,
                   std::shared_ptr<const setup::SeededScene> seeded, int threads, Moments moments,
                   Watch watch)
    : start_(start),
      changes_(changes_of(start, std::move(changes))),
      seeded_(std::move(seeded)),
      threads_(threads),
      moments_(std::move(moments)),
      watch_(std::move(watch)),
      simulation_(
          setup::make_simulation(setup::with_curves(start_, 0), seeded_->particles, threads_)) {
  begin();
}

/// The simulation is a new one.
void Timeline::begin() {
  here_ = {};
  rehearsed_.reset();
  frame_start_.reset();
  here_.scene = std::make_shared<const scene::Scene>(setup::with_curves(start_, 0));
  made_ = 0;
  curves_at_ = 0;
  summary_.reset();
  make_due();
  here_.history.push_back(picture::plot_sample(0, 1 / fps(), summary(), {},
                                               picture::body_samples(simulation_.colliders(), 0)));
}

Moment Timeline::moment() const {
  Moment moment = here_;
  moment.state = simulation_.save();
  return moment;
}

scene::Scene Timeline::scene() const {
  scene::Scene now = *here_.scene;
  follow_colliders(simulation_, now);
  return now;
}

const sim::Summary& Timeline::summary() const {
  if (!summary_) summary_ = simulation_.summary();
  return *summary_;
}

/// Parameters of a scene; a simulation that broke a rule takes none, and is made again.
void Timeline::use(const std::shared_ptr<const scene::Scene>& scene) {
  if (scene == here_.scene) return;
  if (simulation_.divergence())
    simulation_ = setup::make_simulation(*scene, seeded_->particles, threads_);
  else
    simulation_.apply(scene->solver, scene->materials, scene::sim_colliders(*scene));
  if (here_.scene)
    here_.advance.loads =
        with_colliders(here_.advance.loads, here_.scene->colliders, scene->colliders);
  here_.scene = scene;
  summary_.reset();
  if (watch_.after_change) watch_.after_change(*scene);
}

void Timeline::make(std::size_t end) {
  scene::Scene scene = setup::with_curves(with_first_changes(start_, changes_, end), curves_at_);
  setup::resolve_ranges(scene, simulation_.particle_count());
  use(std::make_shared<const scene::Scene>(std::move(scene)));
  made_ = end;
}

bool Timeline::has_other_curves(int frame) const {
  const auto same = [](const scene::Override& a, const scene::Override& b) {
    return a.value == b.value;
  };
  return !std::ranges::equal(setup::curve_values(*here_.scene, curves_at_),
                             setup::curve_values(*here_.scene, frame), same);
}

void Timeline::follow_curves(int frame) {
  const bool is_other = has_other_curves(frame);
  curves_at_ = frame;
  if (is_other) make(made_);
}

/// Changes of one step at once, but a second one to an address after the first: both leave a trace.
void Timeline::make_due() {
  const auto is_due = [&](std::size_t k) {
    return k < changes_.size() && changes_[k].step <= simulation_.steps();
  };
  const Clock::time_point begin = Clock::now();
  while (is_due(made_)) {
    // Few changes are made before anyone waits for them.
    if (is_interrupted() && seconds_since(begin) > 0.5)
      throw Error(exit_interrupted, "interrupted while the changes of the run were made again");
    std::size_t end = made_;
    std::set<std::string> addresses;
    while (is_due(end) && changes_[end].step == changes_[made_].step &&
           addresses.insert(changes_[end].address).second)
      ++end;
    make(end);
  }
}

void Timeline::change(const scene::Scene& changed) {
  // A frame that may go back is one piece: a run that is made again makes changes at its end.
  if (may_go_back() && !here_.is_frame_end() && !advance_frame())
    throw std::runtime_error("the frame does not get to its end, where the change would be made");
  const std::shared_ptr<const scene::Scene> before = here_.scene;
  auto scene = std::make_shared<const scene::Scene>(in_order_of(*before, changed));
  // A curve continues whatever else gives a value to its parameter.
  if (!scene->curves.empty())
    scene = std::make_shared<const scene::Scene>(setup::with_curves(*scene, curves_at_));
  use(scene);
  fork();
  bool is_other = false;
  // Compares the values of the simulation, not the typed ones: they differ in a coarsened scene.
  for (const scene::Difference& change : scene::differences(*before, *scene))
    if (change.is_live && scene::concerns_simulation(change.address)) {
      is_other = true;
      scene::note_change(changes_,
                         {simulation_.steps(), change.address,
                          change.after ? scene::toml::toml_literal(*change.after) : "none"});
    }
  // A moment that was kept here is from before the change.
  if (is_other) moments_.forget(here_);
  made_ = changes_.size();
  start_ = recorded_scene(start_, *scene);
}

void Timeline::fork() {
  rehearsed_.reset();
  scene::forget_changes_after(changes_, simulation_.steps());
  made_ = std::min(made_, changes_.size());
  moments_.forget_after(here_.frame, simulation_.steps());
}

void Timeline::restore_state(const Moment& moment) {
  if (moment.file.empty()) return simulation_.restore(moment.state);
  simulation_.restore_healthy(moment.state);
  const double time = simulation_.time(), start = moment.frame / fps(),
               end = (moment.frame + 1) / fps(), rounding = 1e-9 * (1 + end);
  if (simulation_.steps() != moment.steps || !(time >= start - rounding && time <= end + rounding))
    throw std::runtime_error("the checkpoint of frame " +
                             std::to_string(scene::number_of(start_, moment.frame)) +
                             " holds another moment");
}

void Timeline::restore(const Moment& moment) {
  const std::size_t made = count_until(changes_, moment.steps);
  try {
    const int curves = frame_of_curves(moment);
    if (moment.scene) {
      curves_at_ = curves;
      use(with_frames(moment.scene, start_.frames));
    } else if (made != made_) {
      curves_at_ = curves;
      make(made);
    } else {
      follow_curves(curves);
    }
    restore_state(moment);
    rehearsed_.reset();
    frame_start_.reset();
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    if (moment.file.empty()) throw;
    refuse_moment(moment.file, error);
  }
  made_ = made;
  summary_.reset();
  here_.frame = moment.frame;
  here_.steps = moment.steps;
  here_.steps_of_frame = moment.steps_of_frame;
  here_.advance = moment.advance;
  here_.history = moment.history;
  here_.retries = moment.retries;
}

bool Timeline::go_to(double time) {
  if (!is_not_after(simulation_.time(), time)) {
    if (const auto kept = moments_.find(time, fps())) {
      restore(*kept);
    } else {
      simulation_ =
          setup::make_simulation(setup::with_curves(start_, 0), seeded_->particles, threads_);
      begin();
    }
  } else if (const auto kept = moments_.find(time, fps(), here_.frame, here_.steps)) {
    restore(*kept);
    if (watch_.after_jump) watch_.after_jump(here_.frame);
  }
  is_stopped_ = is_interrupted();  // moments that are kept take no step that could be stopped
  const int last = frame_at(time, fps());
  while (here_.frame < last && !must_stop()) advance_frame();
  if (is_not_after(time, simulation_.time())) return !must_stop();
  if (!must_stop()) rehearse();
  const auto end_of_next_step = [&] {
    return simulation_.time() + simulation_.choose_dt(frame_end() - simulation_.time()).dt;
  };
  while (!must_stop() && is_not_after(end_of_next_step(), time)) advance_step();
  leave_frame_start();
  return !must_stop();
}

/// @return whether to stop
bool Timeline::look_after_step() {
  return is_stopped_ = watch_.after_step && watch_.after_step(simulation_.time());
}

/// Advances to the last step or to the time, whichever comes first.
sim::AdvanceReport Timeline::advance(double time, std::size_t last_step) {
  const auto after_step = [this] { return look_after_step(); };
  if (rehearsed_ || !may_go_back()) return simulation_.advance_to(time, after_step, last_step);
  if (last_step == no_step || simulation_.dt_scale() < 1)
    return sim::advance_retrying(simulation_, time, after_step, here_.retries);
  // While nothing breaks, steps with and without retrying are the same.
  const std::vector<std::uint8_t> good = simulation_.save();
  const sim::AdvanceReport report = simulation_.advance_to(time, after_step, last_step);
  const bool has_broken = simulation_.divergence().has_value();
  if (!has_broken && (simulation_.time() >= time || simulation_.steps() >= last_step))
    return report;
  simulation_.restore(good);
  return has_broken ? sim::advance_retrying(simulation_, time, after_step, here_.retries)
                    : sim::AdvanceReport{};  // interrupted: the frame is simulated as a whole
}

/// Finds the dt that the run has on its way to the next change or the end of the frame, which is
/// known there only, and comes back: steps inside the frame are then those of the run.
void Timeline::rehearse() {
  begin_frame(true);
  if (rehearsed_ || !may_go_back() || simulation_.divergence()) return;
  const std::vector<std::uint8_t> start = simulation_.save();
  const double scale = simulation_.dt_scale();
  const std::size_t retries = here_.retries.size(), steps = simulation_.steps();
  advance(frame_end(), next_stop());
  if (is_stopped_ && simulation_.steps() == steps) return;
  rehearsed_ = {simulation_.steps(), simulation_.dt_scale()};
  simulation_.restore(start);
  simulation_.set_dt_scale(here_.retries.size() > retries ? here_.retries.back().dt_scale : scale);
}

void Timeline::end_rehearsed() {
  if (!rehearsed_ || simulation_.steps() < rehearsed_->end) return;
  simulation_.set_dt_scale(rehearsed_->scale_after);
  rehearsed_.reset();
}

/// The step before which something is to be done inside the frame.
std::size_t Timeline::next_stop() const {
  if (rehearsed_) return rehearsed_->end;
  return made_ < changes_.size() ? changes_[made_].step : no_step;
}

/// @param is_left  perhaps, before its first step
void Timeline::begin_frame(bool is_left) {
  is_stopped_ = false;
  if (!here_.is_frame_end() || frame_start_) return;
  if (is_left) {
    frame_start_ = {curves_at_, here_.scene, here_.advance, {}};
    if (has_other_curves(here_.frame + 1)) frame_start_->state = simulation_.save();
  }
  here_.advance = {};
  follow_curves(here_.frame + 1);
}

void Timeline::look_at_next(const std::function<void(bool)>& look) {
  if (simulation_.divergence()) return look(false);
  const std::shared_ptr<const scene::Scene> before = here_.scene;
  begin_frame(true);
  try {
    look(here_.scene != before);
  } catch (...) {
    leave_frame_start();
    throw;
  }
  leave_frame_start();
}

/// A frame that was begun and has no step is none: this is the end of the frame before again.
/// Curves that gave their parameters the values of the next frame do so once more when it begins;
/// the pressure of a shock would be taken off stress twice.
void Timeline::leave_frame_start() {
  std::optional<FrameStart> start = std::exchange(frame_start_, std::nullopt);
  if (!start || simulation_.steps() != here_.steps_of_frame || simulation_.divergence()) return;
  use(start->scene);
  curves_at_ = start->curves_at;
  here_.advance = std::move(start->advance);
  if (start->state.empty()) return;
  const double scale = simulation_.dt_scale();  // that a rehearsal has found
  simulation_.restore(start->state);
  simulation_.set_dt_scale(scale);
}

bool Timeline::advance_frame() {
  begin_frame(may_go_back());
  const double end = frame_end();
  for (;;) {
    const std::size_t next = next_stop();
    here_.advance.append(advance(end, next));
    if (simulation_.divergence()) break;
    end_rehearsed();
    if (!rehearsed_) make_due();
    if (simulation_.time() >= end || simulation_.steps() != next) break;
  }
  return end_frame();
}

void Timeline::advance_step() {
  rehearse();
  if (is_stopped_) return leave_frame_start();
  here_.advance.append(simulation_.advance_to(
      frame_end(), [this] { return look_after_step(); }, simulation_.steps() + 1));
  if (!simulation_.divergence()) {
    end_rehearsed();
    if (!rehearsed_) make_due();
  }
  end_frame();
}

/// Notes where the simulation is now. @return whether the frame has ended
bool Timeline::end_frame() {
  leave_frame_start();
  here_.steps = simulation_.steps();
  summary_.reset();
  if (simulation_.divergence() || !is_not_after(frame_end(), simulation_.time())) return false;
  // A sum of its steps would depend on how often the frame was interrupted.
  here_.advance.seconds = frame_end() - here_.frame / fps();
  ++here_.frame;
  here_.steps_of_frame = here_.steps;
  here_.history.push_back(
      picture::plot_sample(here_.frame / fps(), 1 / fps(), summary(), here_.advance,
                           picture::body_samples(simulation_.colliders(), simulation_.time(),
                                                 here_.history.back().bodies)));
  if (watch_.after_frame) watch_.after_frame(here_.frame);
  return true;
}

picture::Snapshot take_snapshot(const Timeline& timeline, const scene::Scene& scene,
                                std::span<const scene::View> views, int frame) {
  const sim::Simulation& simulation = timeline.simulation();
  picture::Snapshot snapshot = picture::take_snapshot(scene, views, simulation, frame);
  snapshot.history = timeline.here().history;
  snapshot.advance = timeline.here().advance;
  snapshot.changes = timeline.changes();
  scene::forget_changes_after(snapshot.changes, simulation.steps());
  return snapshot;
}

}  // namespace neve::app::timeline

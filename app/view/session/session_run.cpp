/// The part of a session that simulates: frame by frame, and on from kept states.

#include <stdexcept>

#include "app/setup/plan.h"
#include "app/support/clock.h"
#include "app/support/machine.h"
#include "app/support/text.h"
#include "app/view/session/session.h"

namespace neve::app::view::session {

namespace {

/// Sampling takes at most one part in so many of the time.
constexpr int sampling_share = 20;

}  // namespace

void Session::start(const std::shared_ptr<const scene::Scene>& scene) {
  const setup::Plan plan =
      setup::make_plan(*scene, {0, scene->frames}, setup::Quality::preview, options_.threads);
  setup::check_limits(*scene, plan, options_.coarsening);
  auto seeded = std::make_shared<setup::SeededScene>(setup::seed_scene(*scene));
  auto simulation = std::make_unique<sim::Simulation>(
      setup::make_simulation(*scene, seeded->particles, options_.threads));
  // From here on nothing fails: the old run may go.
  memory_at_most_ = plan.memory_limit;
  simulation_ = std::move(simulation);
  seeded_ = std::move(seeded);
  player_.emplace(*scene, std::vector<scene::LiveChange>{}, *simulation_);
  colliders_ = simulation_->colliders();
  frame_ = 0;
  advance_ = {};
  advance_is_new_ = true;
  steps_of_frame_ = 0;
  history_.clear();
  samples_ = std::make_shared<std::vector<RunSample>>();
  kept_.clear();
  head_.reset();
  stage_.reset();
  diagnosis_.reset();
  error_.clear();
  speed_ = 0;
  history_.push_back(picture::plot_sample(0, 1 / scene->fps, note_sample(), {}));
  keep();
}

void Session::set_goal(Goal goal) {
  if (goal != Goal::none) {
    leave_older();
    stop_looking_inside();
    if (simulation_->divergence()) return;
    if (goal == Goal::end && frame_ >= scene().frames) return;
    measured_at_ = Clock::now();
    measured_time_ = simulation_->time();
  }
  goal_ = goal;
}

void Session::stop_looking_inside() {
  stage_.reset();
}

void Session::leave_older() {
  if (!head_) return;
  const KeptFrame head = std::move(*head_);
  head_.reset();
  load(head);
}

/// The simulation as it was then. With other parameters since, it is made again: a state continues
/// only with those that it had.
void Session::load(const KeptFrame& kept) {
  if (kept.scene != player_->shared_scene()) {
    sim::Simulation simulation =
        setup::make_simulation(*kept.scene, seeded_->particles, options_.threads, kept.colliders);
    simulation.restore(kept.state);
    *simulation_ = std::move(simulation);
  } else {
    simulation_->restore(kept.state);
  }
  player_->go_to(kept.steps, kept.scene);
  colliders_ = kept.colliders;
  frame_ = kept.frame;
  advance_ = kept.advance;
  steps_of_frame_ = kept.steps_of_frame;
  advance_is_new_ = kept.steps == kept.steps_of_frame;
  diagnosis_.reset();
}

void Session::keep() {
  kept_.add(state_now());
}

KeptFrame Session::state_now() const {
  return {frame_,
          simulation_->steps(),
          steps_of_frame_,
          simulation_->save(),
          player_->shared_scene(),
          colliders_,
          advance_};
}

run::Moment Session::moment_now() const {
  run::Moment moment;
  moment.frame = frame_;
  moment.steps = simulation_->steps();
  if (moment.steps != steps_of_frame_) moment.advance = advance_;
  moment.history = history_;
  moment.history.resize(static_cast<std::size_t>(frame_) + 1);
  moment.state = simulation_->save();
  moment.record.changes = player_->changes();
  scene::forget_changes_after(moment.record.changes, moment.steps);
  moment.record.threads = simulation_->threads();
  moment.record.simd = simulation_->simd();
  return moment;
}

/// Snow that bursts spreads over ever more of the grid.
void Session::require_room() const {
  if (simulation_->warnings().rules_ignored == 0) return;
  if (simulation_->memory_bytes() <= memory_at_most_) return;
  throw std::runtime_error("stopped: the snow that bursts takes " +
                           bytes_text(simulation_->memory_bytes()) + " of memory, more than the " +
                           bytes_text(memory_at_most_) + " allowed");
}

void Session::after_step() {
  if (is_publication_due()) {
    const Clock::time_point now = Clock::now();
    if (const double wall = seconds_since(measured_at_); wall > 0.25) {
      speed_ = (simulation_->time() - measured_time_) / wall;
      measured_at_ = now;
      measured_time_ = simulation_->time();
    }
    if (now - sampled_at_ > sampling_share * sampling_took_) note_sample();
    publish();
  }
}

void Session::advance() {
  const double time = (frame_ + 1) / scene().fps;
  if (advance_is_new_) advance_ = {};
  advance_is_new_ = false;
  // A run that may return to the beginning of its frame is not stopped inside the frame.
  const bool may_go_back = scene().solver.on_divergence == sim::OnDivergence::retry;
  const auto observe = [&] {
    after_step();
    return is_ending_ || (has_commands_ && !may_go_back);
  };
  std::vector<sim::Retry> retries;
  const sim::AdvanceReport report = goal_ == Goal::step
                                        ? player_->step_towards(time, observe)
                                        : player_->advance_to(time, observe, retries);
  advance_.append(report);
  if (simulation_->divergence()) {
    note_sample();
    diagnosis_ = health::diagnose(scene(), *simulation_->divergence(), options_.coarsening);
    goal_ = Goal::none;
    return;
  }
  if (simulation_->time() >= time * (1 - 1e-12)) reach_frame();
  if (goal_ == Goal::step) {
    note_sample();
    goal_ = Goal::none;
  }
}

void Session::reach_frame() {
  ++frame_;
  history_.resize(static_cast<std::size_t>(frame_));
  const sim::Summary summary = note_sample();
  history_.push_back(
      picture::plot_sample(frame_ / scene().fps, 1 / scene().fps, summary, advance_));
  advance_is_new_ = true;
  steps_of_frame_ = simulation_->steps();
  keep();
  require_room();
  if (goal_ == Goal::frame || frame_ == scene().frames) goal_ = Goal::none;
  if (is_recording_) publish();
}

/// Until the end of the frame.
double Session::seconds_left() const {
  const double left = (frame_ + 1) / scene().fps - simulation_->time();
  return left > 0 ? left : 1 / scene().fps;
}

}  // namespace neve::app::view::session

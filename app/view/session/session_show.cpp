/// The part of a session that publishes the state of the simulation.

#include <algorithm>

#include "app/run/changes.h"
#include "app/view/session/session.h"
#include "app/view/session/stage_summary.h"

namespace neve::app::view::session {

namespace {

/// Between two moments of a run that are shown; turning the view draws pictures in between.
constexpr auto publish_interval = std::chrono::milliseconds(30);
constexpr std::size_t max_samples = 4000;

double largest(const std::vector<double>& pressures) {
  return pressures.empty() ? 0 : *std::max_element(pressures.begin(), pressures.end());
}

/// N, on the collider that snow presses most.
double largest_force(const sim::AdvanceReport& advance) {
  double most = 0;
  if (advance.seconds > 0)
    for (const sim::ColliderLoad& load : advance.loads)
      most = std::max(most, load.impulse.norm() / advance.seconds);
  return most;
}

/// The step that is looked at alone, for the caption: not those that led to the frame.
sim::AdvanceReport report_of(const dump::StepInspection& inside) {
  sim::AdvanceReport report;
  report.steps = 1;
  report.dt_min = report.dt_max = report.seconds = inside.dt;
  report.ruled[static_cast<std::size_t>(inside.limit)] = 1;
  return report;
}

}  // namespace

/// Needs a decomposition per particle, for the elastic energy.
sim::Summary Session::note_sample() {
  const Clock::time_point start = Clock::now();
  const sim::Summary summary = simulation_->summary();
  sampled_at_ = Clock::now();
  sampling_took_ = sampled_at_ - start;
  const sim::DtChoice choice = simulation_->choose_dt(seconds_left());
  // Readers hold the list they were given; a new one is made only when it is shared.
  if (samples_.use_count() > 1) samples_ = std::make_shared<std::vector<RunSample>>(*samples_);
  std::vector<RunSample>& list = *samples_;
  while (!list.empty() && list.back().time >= summary.time) list.pop_back();
  list.push_back({summary.time, summary.kinetic_energy, summary.elastic_energy, summary.momentum,
                  summary.max_speed, summary.min_J_P, summary.max_J_P, choice.dt, choice.limit,
                  summary.max_depth, largest(summary.max_pressure), largest_force(advance_)});
  if (list.size() <= max_samples) return summary;
  std::size_t kept = 0;  // every other one: the plot covers the whole run with half the detail
  for (std::size_t k = 0; k < list.size(); k += 2) list[kept++] = list[k];
  list.resize(kept);
  return summary;
}

bool Session::is_publication_due() const {
  return is_wanted_ && !is_recording_ && Clock::now() - published_at_ > publish_interval;
}

/// With colliders where they are, and the views that are looked at.
std::shared_ptr<const scene::Scene> Session::shown_scene() const {
  auto scene = std::make_shared<scene::Scene>(player_->scene());
  scene->views = views_;
  if (stage_)
    for (scene::View& view : scene->views)
      view = view_of_stage(*scene, view, static_cast<sim::Stage>(*stage_));
  for (std::size_t k = 0; k < std::min(colliders_.size(), scene->colliders.size()); ++k)
    static_cast<sim::shapes::Collider&>(scene->colliders[k]) = colliders_[k];
  return scene;
}

void Session::publish() {
  auto live = std::make_shared<LiveFrame>();
  live->number = ++number_;
  live->scene = shown_scene();
  live->snapshot = picture::take_snapshot(*live->scene, live->scene->views, *simulation_, frame_);
  live->snapshot.advance = advance_;
  live->snapshot.changes = player_->changes();
  scene::forget_changes_after(live->snapshot.changes, simulation_->steps());
  live->probed = probe_;
  live->history = history_;
  live->snapshot.history = live->history;
  live->samples = samples_;
  live->seeded = seeded_;
  live->frame = frame_;
  live->is_frame_end = simulation_->steps() == steps_of_frame_;
  live->steps = simulation_->steps();
  live->is_running = goal_ != Goal::none;
  live->is_older = head_.has_value();
  live->head = head_ ? head_->frame : frame_;
  live->is_head_broken = head_ ? head_is_broken_ : simulation_->divergence().has_value();
  live->kept = kept_.numbers();
  live->kept_bytes = kept_.bytes();
  live->kept_budget = kept_.budget();
  // Only pictures of frames are kept.
  if (live->is_frame_end) live->state_hash = simulation_->state_hash();
  live->phases = simulation_->phase_seconds();
  live->speed = speed_;
  live->memory = simulation_->memory_bytes();
  live->threads = simulation_->threads();
  live->simd = simulation_->simd();
  live->divergence = simulation_->divergence();
  live->diagnosis = diagnosis_;
  inspect_next_step(*live);
  live->error = error_;
  live->errors = errors_;
  published_at_ = Clock::now();
  {
    const std::lock_guard lock(mutex_);
    latest_ = live;
    is_wanted_ = false;
  }
  if (wake_) wake_();
}

/// Stage and probe need a step on a copy. While it runs, four times a second are enough to read.
void Session::inspect_next_step(LiveFrame& live) {
  const bool is_stage = stage_.has_value();
  const auto now = Clock::now();
  const bool is_probe =
      probe_ && (goal_ == Goal::none || now - probed_at_ > std::chrono::milliseconds(250));
  if (live.divergence || (!is_stage && !is_probe)) {
    live.probe = probe_ ? last_reading_ : std::nullopt;
    return;
  }
  const dump::StepInspection inside = dump::inspect_step(*live.scene, *simulation_, seconds_left());
  std::optional<sim::Stage> stage;
  if (is_stage) {
    stage = static_cast<sim::Stage>(*stage_);
    live.stage = summarize_stage(inside, *stage);
    live.snapshot.advance = report_of(inside);
    live.snapshot.stage_change = change_of_stage(inside, *stage);
    show_after_stage(inside, *stage, live.snapshot);
  }
  if (is_probe) {
    last_reading_ = read_probe(inside, *probe_, stage);
    probed_at_ = Clock::now();
  }
  live.probe = probe_ ? last_reading_ : std::nullopt;
}

}  // namespace neve::app::view::session

/// The part of a session that moves its run and publishes it.

#include <optional>
#include <stdexcept>

#include "app/health/diagnosis.h"
#include "app/setup/plan.h"
#include "app/support/interrupt.h"
#include "app/support/machine.h"
#include "app/support/text.h"
#include "app/timeline/timeline.h"
#include "app/timeline/times.h"
#include "app/view/session/session.h"
#include "app/view/session/stage_summary.h"

namespace neve::app::view::session {

namespace {

/// Between two moments of a run that are shown; turning the view draws pictures in between.
constexpr auto publish_interval = std::chrono::milliseconds(30);
constexpr double speed_interval = 0.25;  ///< s

}  // namespace

void Session::start(const std::shared_ptr<const scene::Scene>& scene,
                    const std::optional<Past>& past) {
  const setup::Plan plan =
      setup::make_plan(*scene, {0, scene->frames}, setup::Quality::preview, options_.threads);
  setup::check_limits(*scene, plan, options_.coarsening);
  timeline::Moments moments(options_.kept_budget > 0 ? options_.kept_budget
                                                     : available_memory() / 4);
  if (past) moments.add_run(past->run);
  // A later start has a run before it, and perhaps pictures of that which are being written.
  std::optional<NothingToKeep> reading;
  if (!timeline_) reading.emplace();
  auto seeded = std::make_shared<const setup::SeededScene>(setup::seed_scene(*scene));
  auto next = std::make_unique<timeline::Timeline>(
      *scene, past ? past->changes : std::vector<scene::LiveChange>{}, std::move(seeded),
      options_.threads, std::move(moments),
      timeline::Watch{[this](double) { return after_step(); }});
  reading.reset();
  next->keep();
  if (past && past->newest) next->restore(*past->newest);
  // From here on nothing fails: the old run may go.
  timeline_ = std::move(next);
  memory_limit_ = plan.memory_limit;
  head_.reset();
  broken_.reset();
  inspector_.stage.reset();
  samples_.begin(past ? past->frames : std::vector<record::FrameRecord>{});
  samples_.note(*timeline_);
  told_.diagnosis.reset();
  told_.error.clear();
  told_.speed = 0;
}

void Session::set_goal(Goal goal) {
  if (goal != Goal::none) {
    leave_older();
    inspector_.stage.reset();
    if (divergence()) return;
    if (goal == Goal::end && timeline_->here().frame >= scene::last_frame(*timeline_->here().scene))
      return;
    measured_at_ = Clock::now();
    measured_time_ = simulation().time();
  }
  goal_ = goal;
}

void Session::load(const timeline::Moment& moment) {
  try {
    timeline_->restore(moment);
  } catch (const std::exception&) {
    if (head_ && &moment != &*head_) leave_older();
    throw;
  }
}

/// The rule that the shown state breaks: a run that broke one goes no further before it is forked
/// or begins again.
std::optional<sim::Divergence> Session::divergence() const {
  if (head_) return std::nullopt;
  return simulation().divergence() ? simulation().divergence() : broken_;
}

void Session::leave_older() {
  if (!head_) return;
  load(*head_);
  head_.reset();
}

/// Snow that bursts spreads over ever more of the grid.
void Session::require_room() const {
  if (simulation().warnings().rules_ignored == 0) return;
  if (simulation().memory_bytes() <= memory_limit_) return;
  throw std::runtime_error("stopped: the snow that bursts takes " +
                           bytes_text(simulation().memory_bytes()) + " of memory, more than the " +
                           bytes_text(memory_limit_) + " allowed");
}

/// @return whether to stop. A run that may return to the beginning of its frame is not stopped
/// inside the frame.
bool Session::after_step() {
  if (mailbox_.is_wanted() && !is_recording_ && Clock::now() - published_at_ > publish_interval) {
    if (const double wall = seconds_since(measured_at_); wall > speed_interval) {
      told_.speed = (simulation().time() - measured_time_) / wall;
      measured_at_ = Clock::now();
      measured_time_ = simulation().time();
    }
    samples_.note_if_cheap(*timeline_);
    publish();
  }
  const bool may_go_back =
      timeline_->here().scene->solver.on_divergence == sim::OnDivergence::retry;
  return mailbox_.is_ending() || (mailbox_.has_requests() && !may_go_back);
}

void Session::advance() {
  const int before = timeline_->here().frame;
  if (goal_ == Goal::step)
    timeline_->advance_step();
  else
    timeline_->advance_frame();
  const bool is_at_end = timeline_->here().frame > before;
  const std::optional<sim::Divergence>& divergence = simulation().divergence();
  if (divergence || goal_ == Goal::step || is_at_end) samples_.note(*timeline_);
  if (divergence)
    told_.diagnosis = health::diagnose(*timeline_->here().scene, *divergence, options_.coarsening);
  if (divergence || goal_ == Goal::step) goal_ = Goal::none;
  if (is_at_end) reach_frame();
}

void Session::reach_frame() {
  timeline_->keep();
  require_room();
  const timeline::Moment& here = timeline_->here();
  // Beyond the last one too: `frames` may be lowered while the run goes.
  if (goal_ == Goal::frame || here.frame >= scene::last_frame(*here.scene)) goal_ = Goal::none;
  if (is_recording_) publish();
}

/// With colliders where they are, and the views that are looked at.
std::shared_ptr<const scene::Scene> Session::shown_scene() const {
  auto scene = std::make_shared<scene::Scene>(timeline_->scene());
  scene->views = views_;
  if (inspector_.stage)
    for (scene::View& view : scene->views) view = view_of_stage(*scene, view, *inspector_.stage);
  return scene;
}

void Session::publish() {
  ++told_.number;
  auto live = std::make_shared<LiveFrame>(told_);
  const timeline::Moment& here = timeline_->here();
  live->scene = shown_scene();
  live->snapshot =
      timeline::take_snapshot(*timeline_, *live->scene, live->scene->views, here.frame);
  live->history = head_ ? head_->history : here.history;
  live->snapshot.history = live->history;
  live->samples = samples_.list();
  live->seeded = timeline_->shared_seeded();
  live->frame = here.frame;
  live->is_frame_end = simulation().steps() == here.steps_of_frame;
  live->steps = simulation().steps();
  live->is_running = goal_ != Goal::none;
  live->is_older = head_.has_value();
  live->head = head_ ? head_->frame : here.frame;
  live->is_head_frame_end = head_ ? head_->is_frame_end() : live->is_frame_end;
  live->divergence = divergence();
  live->is_head_broken = (head_ ? broken_ : live->divergence).has_value();
  if (!live->divergence) live->diagnosis.reset();
  live->kept = timeline_->moments().frames();
  live->kept_bytes = timeline_->moments().bytes();
  live->kept_budget = timeline_->moments().budget();
  // Only pictures of frames are kept.
  if (live->is_frame_end) live->state_hash = simulation().state_hash();
  live->phases = simulation().phase_seconds();
  live->memory = simulation().memory_bytes();
  live->threads = simulation().threads();
  live->simd = simulation().simd();
  inspector_.inspect(*timeline_, live->is_running, *live);
  published_at_ = Clock::now();
  mailbox_.publish(live);
  if (wake_) wake_();
}

}  // namespace neve::app::view::session

/// The part of a session that moves its run and publishes it.

#include <algorithm>
#include <optional>
#include <stdexcept>

#include "app/health/diagnosis.h"
#include "app/support/interrupt.h"
#include "app/support/machine.h"
#include "app/support/text.h"
#include "app/timeline/timeline.h"
#include "app/timeline/times.h"
#include "app/view/session/session.h"
#include "app/view/session/stage_summary.h"

namespace neve::app::view::session {

namespace {

/// The time between two shown moments of a run; turning the view draws pictures in between.
constexpr auto publish_interval = std::chrono::milliseconds(30);
constexpr double speed_interval = 0.25;  ///< s

}  // namespace

void Pace::measure(double time, double& pace) {
  const double wall = seconds_since(at_);
  if (wall <= speed_interval) return;
  pace = (time - time_) / wall;
  begin(time);
}

std::unique_ptr<timeline::Timeline> Session::make_timeline(
    const scene::Scene& scene, std::vector<scene::LiveChange> changes,
    std::shared_ptr<const setup::SeededScene> seeded, timeline::Moments moments) {
  return std::make_unique<timeline::Timeline>(
      scene, std::move(changes), std::move(seeded), options_.threads, std::move(moments),
      timeline::Watch{[this](double) { return after_step(); }});
}

void Session::start(const std::shared_ptr<const scene::Scene>& scene,
                    const std::optional<Past>& past) {
  const std::uint64_t held =
      timeline_ ? simulation().memory_bytes() + timeline_->moments().bytes() : 0;
  setup::Plan plan =
      setup::make_plan(*scene, {0, scene->frames}, setup::Quality::preview, options_.threads);
  const bool is_bounded = scene->limits.memory > 0 || plan.is_memory_capped;
  const bool fits_beside =
      plan.memory <= usable_memory() && (!is_bounded || plan.memory + held <= plan.memory_limit);
  setup::count_on(std::max(held, plan_.memory), *scene, plan);
  setup::check_limits(*scene, plan, options_.coarsening);
  // A cap is for the run and the frames that are kept of it together.
  std::uint64_t budget = (available_memory() + held) / 4;
  if (plan.is_memory_capped) budget = std::min(budget, plan.memory_limit - plan.memory);
  timeline::Moments moments(std::max<std::uint64_t>(1, budget));
  if (past) moments.add_run(past->run);
  // A later start has a run before it, and perhaps pictures of that which are being written.
  std::optional<NothingToKeep> reading;
  if (!timeline_) reading.emplace();
  auto seeded = std::make_shared<const setup::SeededScene>(setup::seed_scene(*scene));
  const std::function<void()> bring_back = fits_beside ? nullptr : give_up_run();
  try {
    auto next = make_timeline(*scene, past ? past->changes : std::vector<scene::LiveChange>{},
                              std::move(seeded), std::move(moments));
    next->keep();
    if (past && past->newest) next->restore(*past->newest);
    reading.reset();
    // From here on nothing fails: the old run may go.
    timeline_ = std::move(next);
  } catch (const std::exception&) {
    if (bring_back) bring_back();
    throw;
  }
  plan_ = plan;
  head_.reset();
  broken_.reset();
  inspector_.stage.reset();
  samples_.begin(past ? past->frames : std::vector<record::FrameRecord>{});
  samples_.note(*timeline_);
  told_.diagnosis.reset();
  told_.speed = 0;
  steps_seen_ = 0;
}

/// Gives back the memory of the run, where another has no room beside it. @return makes it again
/// where it was; of its kept frames the one that it is at
std::function<void()> Session::give_up_run() {
  if (!timeline_) return nullptr;
  broken_ = divergence();
  auto last = std::make_shared<const timeline::Moment>(head_ ? *std::exchange(head_, std::nullopt)
                                                             : timeline_->moment());
  const std::uint64_t budget = timeline_->moments().budget();
  auto make = [this, budget, last, start = timeline_->start(), changes = timeline_->changes(),
               seeded = timeline_->shared_seeded()] {
    timeline_ = make_timeline(start, changes, seeded, timeline::Moments(budget));
    timeline_->keep();
    timeline_->restore(*last);
    if (last->is_frame_end()) timeline_->keep();
  };
  timeline_.reset();
  return make;
}

void Session::set_goal(Goal goal) {
  if (goal != Goal::none) {
    leave_older();
    inspector_.stage.reset();
    if (divergence()) return;
    if (goal == Goal::end && timeline_->here().frame >= scene::last_frame(*timeline_->here().scene))
      return;
    pace_.begin(simulation().time());
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
  if (simulation().memory_bytes() <= plan_.memory_limit) return;
  throw std::runtime_error("stopped: the snow that bursts takes " +
                           bytes_text(simulation().memory_bytes()) + " of memory, more than the " +
                           bytes_text(plan_.memory_limit) + " allowed");
}

/// @return whether to stop. A run that may return to the beginning of its frame is not stopped
/// inside the frame.
bool Session::after_step() {
  bool is_told = true;
  note_return(simulation().steps() - 1);
  if (mailbox_.is_wanted() && !is_recording_ && Clock::now() - published_at_ > publish_interval) {
    pace_.measure(simulation().time(), told_.speed);
    samples_.note_if_cheap(*timeline_);
    is_told = tell();  // an error here would lose the steps of the frame so far
    published_at_ = Clock::now();
  }
  const bool may_go_back =
      timeline_->here().scene->solver.on_divergence == sim::OnDivergence::retry;
  return mailbox_.is_ending() || ((mailbox_.has_requests() || !is_told) && !may_go_back);
}

/// Steps of an attempt that broke a rule, and of the rehearsal of a single step, are none of the
/// run. @param steps  that the run has before what follows
void Session::note_return(std::size_t steps) {
  if (steps < steps_seen_) return_to(begun_at_);
  steps_seen_ = simulation().steps();
}

/// Forgets what was told of moments after this one: they are of a run that was left.
void Session::return_to(double time) {
  samples_.forget_after(time);
  inspector_.look_again();
  // Nobody may have seen the frame that was to tell of the last one.
  const bool is_told = mailbox_.taken() >= returned_in_;
  told_.returned_to = is_told ? time : std::min(time, told_.returned_to);
  returned_in_ = told_.number + 1;
  ++told_.returns;
}

void Session::advance() {
  const int before = timeline_->here().frame;
  begun_at_ = simulation().time();
  steps_seen_ = simulation().steps();
  if (goal_ == Goal::step)
    timeline_->advance_step();
  else
    timeline_->advance_frame();
  note_return(simulation().steps());
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
  // A run stops beyond the last frame too: `frames` may be lowered while it runs.
  if (goal_ == Goal::frame || here.frame >= scene::last_frame(*here.scene)) goal_ = Goal::none;
  if (is_recording_) publish();
}

/// Returns the scene with colliders where they are, and the views that are looked at.
std::shared_ptr<const scene::Scene> Session::shown_scene() const {
  auto scene = std::make_shared<scene::Scene>(timeline_->scene());
  scene->views = views_;
  if (inspector_.stage)
    for (scene::View& view : scene->views) view = view_of_stage(*scene, view, *inspector_.stage);
  return scene;
}

void Session::publish() {
  auto live = std::make_shared<LiveFrame>(told_);
  ++live->number;
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
  told_.number = live->number;
  mailbox_.publish(live);
  if (wake_) wake_();
}

}  // namespace neve::app::view::session

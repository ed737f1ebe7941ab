#include "app/view/session/session.h"

#ifdef __linux__
#include <sys/resource.h>
#include <unistd.h>
#endif

#include <algorithm>
#include <cerrno>
#include <exception>
#include <future>
#include <stdexcept>
#include <utility>

#include "app/support/machine.h"

namespace neve::app::view::session {

namespace {

/// By how much a simulation that is watched steps back behind the pictures of it: where both want
/// the same cores, these get about three times as much.
constexpr int niceness = 5;
constexpr int last_stage = static_cast<int>(sim::Stage::colliders);

/// Lowers the priority of the calling thread and of the threads that it starts from now on.
void step_back() {
#ifdef __linux__
  const auto thread = static_cast<id_t>(gettid());
  errno = 0;
  const int now = getpriority(PRIO_PROCESS, thread);
  if (errno == 0) setpriority(PRIO_PROCESS, thread, now + niceness);  // only a matter of speed
#endif
}

std::uint64_t default_budget() {
  return available_memory() / 4;
}

}  // namespace

Session::Session(std::shared_ptr<const scene::Scene> scene, const SessionOptions& options,
                 std::function<void()> wake)
    : wake_(std::move(wake)),
      options_(options),
      kept_(options.kept_budget > 0 ? options.kept_budget : default_budget()) {
  views_ = scene->views;
  std::promise<void> promise;
  std::future<void> start_of_run = promise.get_future();
  thread_ = std::thread([this, &scene, started = std::move(promise)]() mutable {
    step_back();
    try {
      start(scene);
      publish();
    } catch (...) {
      started.set_exception(std::current_exception());
      return;
    }
    started.set_value();
    work();
  });
  try {
    start_of_run.get();
  } catch (...) {
    thread_.join();
    throw;
  }
}

Session::~Session() {
  {
    const std::lock_guard lock(mutex_);
    is_ending_ = true;
    has_commands_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void Session::ask(std::function<void()> command) {
  {
    const std::lock_guard lock(mutex_);
    commands_.push_back(std::move(command));
    has_commands_ = true;
  }
  changed_.notify_all();
}

void Session::run() {
  ask([this] { set_goal(Goal::end); });
}

void Session::pause() {
  ask([this] { set_goal(Goal::none); });
}

void Session::next_step() {
  ask([this] { set_goal(Goal::step); });
}

void Session::next_frame() {
  ask([this] { set_goal(Goal::frame); });
}

void Session::next_stage() {
  ask([this] {
    set_goal(Goal::none);
    if (simulation_->divergence()) return;
    if (stage_ && *stage_ == last_stage) {
      stage_.reset();
      if (!head_) set_goal(Goal::step);
      return;
    }
    stage_ = stage_ ? *stage_ + 1 : 0;
  });
}

void Session::show_stage(sim::Stage stage) {
  ask([this, stage] {
    set_goal(Goal::none);
    if (!simulation_->divergence()) stage_ = static_cast<int>(stage);
  });
}

void Session::leave_stage() {
  ask([this] { stage_.reset(); });
}

void Session::reset(std::shared_ptr<const scene::Scene> scene) {
  ask([this, scene = std::move(scene)] {
    start(scene);
    goal_ = Goal::none;
  });
}

void Session::apply(std::shared_ptr<const scene::Scene> scene) {
  ask([this, scene = std::move(scene)] {
    leave_older();
    // A race: the run broke a rule after the change was asked for.
    if (simulation_->divergence())
      throw std::runtime_error(
          "this run has diverged: the change takes effect at Reset, or after going back to an "
          "earlier frame");
    player_->make_now(scene);
    colliders_ = simulation_->colliders();
    // The kept copy of this moment must include the change.
    if (simulation_->steps() == steps_of_frame_) keep();
  });
}

void Session::show_frame(int frame) {
  ask([this, frame] {
    goal_ = Goal::none;
    stop_looking_inside();
    const KeptFrame* kept = kept_.at_or_before(frame);
    if (!kept) return;
    if (!head_ && kept->frame == frame_ && simulation_->steps() == steps_of_frame_) return;
    if (!head_) {
      head_is_broken_ = simulation_->divergence().has_value();
      head_ = state_now();
    }
    load(*kept);
  });
}

void Session::show_head() {
  ask([this] {
    if (head_) stop_looking_inside();
    leave_older();
  });
}

void Session::continue_from_here() {
  ask([this] {
    if (!head_) return;
    head_.reset();
    forget_later();
  });
}

void Session::forget_later() {
  kept_.forget_after(frame_);
  history_.resize(std::min(history_.size(), static_cast<std::size_t>(frame_) + 1));
  const double now = simulation_->time();
  auto kept = std::make_shared<std::vector<RunSample>>(*samples_);
  std::erase_if(*kept, [&](const RunSample& sample) { return sample.time > now; });
  samples_ = kept;
  player_->forget_later();
}

/// The change belongs to a step before the broken one: made again, the run passes it too.
void Session::go_on_anyway(std::shared_ptr<const scene::Scene> scene) {
  ask([this, scene = std::move(scene)] {
    leave_older();
    const KeptFrame* kept = simulation_->divergence() ? kept_.at_or_before(frame_) : nullptr;
    if (!kept) return;
    stop_looking_inside();
    load(*kept);
    forget_later();
    player_->make_now(scene);
    colliders_ = simulation_->colliders();
    keep();
    set_goal(Goal::end);
  });
}

void Session::set_views(std::vector<scene::View> views) {
  ask([this, views = std::move(views)] { views_ = views; });
}

void Session::set_probe(std::optional<dump::Probe> probe) {
  ask([this, probe = std::move(probe)] {
    probe_ = probe;
    probed_at_ = {};
  });
}

void Session::set_recording(bool is_on) {
  ask([this, is_on] { is_recording_ = is_on; });
}

run::Moment Session::moment() {
  std::promise<run::Moment> promise;
  std::future<run::Moment> moment = promise.get_future();
  ask([this, &promise] {
    try {
      promise.set_value(moment_now());
    } catch (...) {
      promise.set_exception(std::current_exception());
    }
  });
  return moment.get();
}

std::shared_ptr<const LiveFrame> Session::latest() const {
  const std::lock_guard lock(mutex_);
  return latest_;
}

void Session::taken(std::uint64_t number) {
  {
    const std::lock_guard lock(mutex_);
    taken_ = std::max<std::uint64_t>(taken_, number);
    is_wanted_ = true;
  }
  changed_.notify_all();
}

void Session::work() {
  while (!is_ending_) {
    std::deque<std::function<void()>> commands;
    {
      std::unique_lock lock(mutex_);
      // A picture of every frame is waited for while they are recorded.
      const auto may_run = [&] {
        return goal_ != Goal::none && !(is_recording_ && taken_ < number_);
      };
      changed_.wait(lock, [&] {
        return is_ending_ || !commands_.empty() || may_run() || (has_news_ && is_wanted_);
      });
      commands.swap(commands_);
      has_commands_ = false;
    }
    if (is_ending_) return;
    for (const auto& command : commands) obey(command);
    if (goal_ != Goal::none && !(is_recording_ && taken_ < number_)) obey([this] { advance(); });
    if (has_news_ && is_wanted_) {
      obey([this] { publish(); });
      has_news_ = false;
    }
  }
}

/// Reports any error to the caller; the thread continues.
void Session::obey(const std::function<void()>& command) {
  try {
    command();
  } catch (const std::exception& error) {
    error_ = error.what();
    ++errors_;
    goal_ = Goal::none;
  }
  has_news_ = true;
}

}  // namespace neve::app::view::session

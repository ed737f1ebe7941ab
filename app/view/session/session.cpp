#include "app/view/session/session.h"

#ifdef __linux__
#include <sys/resource.h>
#include <unistd.h>
#endif

#include <cerrno>
#include <exception>
#include <future>
#include <stdexcept>
#include <utility>

namespace neve::app::view::session {

namespace {

/// The niceness of a simulation that is watched, behind the pictures of it: where both want the
/// same cores, these get about three times as much.
constexpr int niceness = 5;

/// Lowers the priority of the calling thread and of the threads that it starts from now on.
void step_back() {
#ifdef __linux__
  const auto thread = static_cast<id_t>(gettid());
  errno = 0;
  const int now = getpriority(PRIO_PROCESS, thread);
  if (errno == 0) setpriority(PRIO_PROCESS, thread, now + niceness);  // only a matter of speed
#endif
}

}  // namespace

Session::Session(std::shared_ptr<const scene::Scene> scene, const SessionOptions& options,
                 std::function<void()> wake)
    : wake_(std::move(wake)), options_(options), views_(scene->views) {
  std::promise<void> promise;
  std::future<void> start_of_run = promise.get_future();
  thread_ = std::thread([this, &scene, started = std::move(promise)]() mutable {
    step_back();
    try {
      start(scene, options_.past);
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
  mailbox_.end();
  thread_.join();
}

void Session::run() {
  mailbox_.ask([this] { set_goal(Goal::end); });
}

void Session::pause() {
  mailbox_.ask([this] { set_goal(Goal::none); });
}

void Session::next_step() {
  mailbox_.ask([this] { set_goal(Goal::step); });
}

void Session::next_frame() {
  mailbox_.ask([this] { set_goal(Goal::frame); });
}

void Session::next_stage() {
  mailbox_.ask([this] {
    set_goal(Goal::none);
    if (divergence()) return;
    if (!inspector_.next_stage() && !head_) set_goal(Goal::step);
  });
}

void Session::show_stage(sim::Stage stage) {
  mailbox_.ask([this, stage] {
    set_goal(Goal::none);
    if (!divergence()) inspector_.stage = stage;
  });
}

void Session::leave_stage() {
  mailbox_.ask([this] { inspector_.stage.reset(); });
}

void Session::reset(std::shared_ptr<const scene::Scene> scene, std::uint64_t start_number) {
  auto request = [this, start_number, scene = std::move(scene)] {
    told_.newest_start = start_number;
    start(scene, {});
    told_.start = start_number;
    goal_ = Goal::none;
  };
  mailbox_.ask(std::move(request), Mailbox::Kind::start);
}

void Session::apply(std::shared_ptr<const scene::Scene> scene) {
  mailbox_.ask([this, scene = std::move(scene)] {
    leave_older();
    // A race: the run broke a rule after the change was asked for.
    if (divergence())
      throw std::runtime_error(
          "this run has diverged: the change takes effect at Reset, or after going back to an "
          "earlier frame");
    timeline_->change(*scene);
    // The kept copy of this moment must include the change.
    if (timeline_->here().is_frame_end()) timeline_->keep();
  });
}

void Session::show_frame(int frame) {
  const auto request = [this, frame] {
    goal_ = Goal::none;
    inspector_.stage.reset();
    const auto kept = timeline_->moments().find(frame / timeline_->fps(), timeline_->fps());
    if (!kept) return;
    if (kept->steps == timeline_->here().steps) return;  // it is shown
    if (!head_) {
      broken_ = divergence();
      head_ = timeline_->moment();
    }
    load(*kept);
  };
  mailbox_.ask(request, Mailbox::Kind::frame);
}

void Session::show_head() {
  mailbox_.ask([this] {
    if (head_) inspector_.stage.reset();
    leave_older();
  });
}

void Session::continue_from_here() {
  mailbox_.ask([this] {
    if (!head_) return;
    head_.reset();
    fork_here();
  });
}

void Session::fork_here() {
  timeline_->fork();
  broken_.reset();
  told_.diagnosis.reset();
  return_to(simulation().time());
  steps_seen_ = 0;
}

/// The change belongs to a step before the broken one: made again, the run passes it too.
void Session::continue_anyway(std::shared_ptr<const scene::Scene> scene) {
  mailbox_.ask([this, scene = std::move(scene)] {
    leave_older();
    if (!divergence()) return;
    const double frame = timeline_->here().frame / timeline_->fps();
    const auto kept = timeline_->moments().find(frame, timeline_->fps());
    if (!kept) return;
    inspector_.stage.reset();
    load(*kept);
    fork_here();
    timeline_->change(*scene);
    timeline_->keep();
    set_goal(Goal::end);
  });
}

void Session::set_views(std::vector<scene::View> views) {
  // The frame that waits for its picture may lack their fields, and then it would never be drawn.
  auto request = [this, views = std::move(views)] {
    views_ = views;
    mailbox_.want();
  };
  mailbox_.ask(std::move(request), Mailbox::Kind::views);
}

void Session::set_probe(std::optional<dump::Probe> probe) {
  mailbox_.ask([this, probe = std::move(probe)] { inspector_.set_probe(probe); });
}

void Session::set_histogram(std::optional<FieldName> field) {
  mailbox_.ask([this, field = std::move(field)] { inspector_.set_histogram(field); });
}

void Session::set_recording(bool is_on) {
  mailbox_.ask([this, is_on] { is_recording_ = is_on; });
}

timeline::Moment Session::moment() {
  std::promise<timeline::Moment> promise;
  std::future<timeline::Moment> moment = promise.get_future();
  mailbox_.ask([this, &promise] {
    try {
      promise.set_value(timeline_->moment());
    } catch (...) {
      promise.set_exception(std::current_exception());
    }
  });
  return moment.get();
}

/// A picture of every frame is waited for while they are recorded.
bool Session::waits_for_picture() const {
  return is_recording_ && mailbox_.taken() < told_.number;
}

void Session::work() {
  const auto may_run = [&] { return goal_ != Goal::none && !waits_for_picture(); };
  for (;;) {
    const auto requests =
        mailbox_.wait([&] { return may_run() || (has_news_ && mailbox_.is_wanted()); });
    for (const auto& waiting : requests) {
      if (mailbox_.is_ending()) return;
      obey(waiting.request);
    }
    if (mailbox_.is_ending()) return;
    if (may_run()) obey([this] { advance(); });
    if (has_news_ && mailbox_.is_wanted()) {
      tell();
      has_news_ = false;
    }
  }
}

/// Reports any error to the caller; the thread continues. @return false after one
bool Session::obey(const std::function<void()>& request) {
  const std::uint64_t errors = told_.errors;
  try {
    request();
  } catch (const std::exception& error) {
    told_.error = error.what();
    ++told_.errors;
    goal_ = Goal::none;
  }
  has_news_ = true;
  return told_.errors == errors;
}

/// A moment for which memory is short is told without what was to be looked at inside it.
bool Session::tell() {
  if (obey([this] { publish(); })) return true;
  inspector_ = {};
  obey([this] { publish(); });
  return false;
}

}  // namespace neve::app::view::session

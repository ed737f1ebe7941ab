#pragma once
/// Mail between a session's thread and all others: requests one way, the newest frame the other.

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <utility>

#include "app/view/session/live_frame.h"

namespace neve::app::view::session {

class Mailbox {
 public:
  using Request = std::function<void()>;
  /// The effect of a request, of which nothing is left once the next one of its kind is done.
  /// Requests of a hand that drags come many times faster than they are done.
  enum class Kind { once, start, frame, views };

  // These members are for any thread.
  /// One of a kind takes the place of the one that waits, unless others have been asked for since.
  void ask(Request request, Kind kind = Kind::once) {
    change([&] {
      for (auto place = waiting_.end(); place != waiting_.begin() && kind != Kind::once;) {
        --place;
        if (place->kind == Kind::once) break;
        if (place->kind != kind) continue;
        waiting_.erase(place);
        break;
      }
      waiting_.push_back({std::move(request), kind});
      has_requests_ = true;
    });
  }
  void end() {
    change([&] { is_ending_ = has_requests_ = true; });
  }
  /// The newest frame cannot be drawn, as it lacks what is wanted now: the next is welcome.
  void want() {
    change([&] { is_wanted_ = true; });
  }
  /// The picture of this frame is done: the next is welcome.
  void take(std::uint64_t number) {
    change([&] {
      taken_ = std::max<std::uint64_t>(taken_, number);
      is_wanted_ = true;
    });
  }
  std::shared_ptr<const LiveFrame> latest() const {
    const std::lock_guard lock(mutex_);
    return latest_;
  }

  // These members are for the session's thread.
  struct Waiting {
    Request request;
    Kind kind = Kind::once;
  };
  bool is_ending() const { return is_ending_; }
  bool has_requests() const { return has_requests_; }
  bool is_wanted() const { return is_wanted_; }
  std::uint64_t taken() const { return taken_; }
  void publish(std::shared_ptr<const LiveFrame> live) {
    const std::lock_guard lock(mutex_);
    latest_ = std::move(live);
    is_wanted_ = false;
  }
  /// Waits for requests, for the end, or until there is something else to do.
  template <class Ready>
  std::deque<Waiting> wait(const Ready& is_ready) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return is_ending_ || !waiting_.empty() || is_ready(); });
    has_requests_ = is_ending_.load();
    return std::exchange(waiting_, {});
  }

 private:
  template <class Act>
  void change(const Act& act) {
    {
      const std::lock_guard lock(mutex_);
      act();
    }
    changed_.notify_all();
  }

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Waiting> waiting_;
  std::shared_ptr<const LiveFrame> latest_;
  std::atomic<bool> has_requests_ = false, is_wanted_ = true, is_ending_ = false;
  std::atomic<std::uint64_t> taken_ = 0;
};

}  // namespace neve::app::view::session

#pragma once
/// Between a session's thread and all others: requests one way, the newest frame the other way.

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

  // For any thread.
  void ask(Request request) {
    change([&] {
      requests_.push_back(std::move(request));
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

  // For the session's thread.
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
  std::deque<Request> wait(const Ready& is_ready) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return is_ending_ || !requests_.empty() || is_ready(); });
    has_requests_ = is_ending_.load();
    return std::exchange(requests_, {});
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
  std::deque<Request> requests_;
  std::shared_ptr<const LiveFrame> latest_;
  std::atomic<bool> has_requests_ = false, is_wanted_ = true, is_ending_ = false;
  std::atomic<std::uint64_t> taken_ = 0;
};

}  // namespace neve::app::view::session

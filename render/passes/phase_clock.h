#pragma once
/// Times of the phases of a picture.

#include <chrono>
#include <vector>

#include "render/frame/phase_time.h"
#include "render/gl/gl.h"

namespace neve::render::passes {

/// Waits for the driver before it reads the clock, but only if times are requested: otherwise it
/// does nothing.
class PhaseClock {
 public:
  /// @param times may be null
  PhaseClock(const gl::Gl& gl, std::vector<PhaseTime>* times) : gl_(gl), times_(times) {
    if (times_) times_->clear();
  }
  bool is_wanted() const { return times_ != nullptr; }
  /// Books the time since the end of the last phase under this one.
  void end(const char* phase) {
    if (!times_) return;
    gl_.Finish();
    const auto now = Clock::now();
    times_->push_back({phase, std::chrono::duration<double>(now - last_).count()});
    last_ = now;
  }

 private:
  using Clock = std::chrono::steady_clock;
  const gl::Gl& gl_;
  std::vector<PhaseTime>* times_;
  Clock::time_point last_ = Clock::now();
};

}  // namespace neve::render::passes

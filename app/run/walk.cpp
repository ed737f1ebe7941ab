#include "app/run/walk.h"

#include <cmath>

#include "app/support/interrupt.h"

namespace neve::app::run {

namespace {

/// Times are typed in decimals.
constexpr double rounding = 1 + 1e-12;

}  // namespace

Walk::Walk(double fps, sim::Simulation& simulation, ChangePlayer& player, Progress& progress,
           int frame)
    : fps_(fps), simulation_(simulation), player_(player), progress_(progress), frame_(frame) {}

bool Walk::is_broken() const {
  return simulation_.divergence() || is_interrupted();
}

bool Walk::go_to(double time) {
  const auto after_step = [this] {
    progress_.step();
    return is_interrupted();
  };
  const int last = static_cast<int>(std::floor(time * fps_ * rounding));
  std::vector<sim::Retry> retries;
  while (frame_ < last && !is_broken()) {
    player_.advance_to((frame_ + 1) / fps_, after_step, retries);
    if (is_broken()) return false;
    ++frame_;
    progress_.frame(frame_, frame_ / fps_);
  }
  const auto end_of_next_step = [&] {
    return simulation_.time() + simulation_.choose_dt(frame_end() - simulation_.time()).dt;
  };
  const bool is_between = time > simulation_.time() * rounding;
  while (is_between && !is_broken() && end_of_next_step() <= time * rounding)
    player_.step_towards(frame_end(), after_step);
  return !is_broken();
}

}  // namespace neve::app::run

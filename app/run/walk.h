#pragma once
/// A run taken to one time after another, by its own steps.

#include "app/run/changes.h"
#include "app/support/progress.h"
#include "sim/simulation.h"

namespace neve::app::run {

class Walk {
 public:
  /// @param frame  the last frame that the simulation has reached
  Walk(double fps, sim::Simulation& simulation, ChangePlayer& player, Progress& progress,
       int frame = 0);

  /// Takes the run's own steps: the state is one that the run passes through, before the step that
  /// contains the time. Times must not decrease.
  /// @return whether it got there; not after a divergence or an interruption
  bool go_to(double time);

  /// End of the frame that the time of the state is in, s.
  double frame_end() const { return (frame_ + 1) / fps_; }

 private:
  bool is_broken() const;

  double fps_;
  sim::Simulation& simulation_;
  ChangePlayer& player_;
  Progress& progress_;
  int frame_;
};

}  // namespace neve::app::run

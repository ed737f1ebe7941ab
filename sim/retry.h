#pragma once
/// Going back: a frame that broke a rule is simulated again from its beginning with half the dt.

#include <string>
#include <vector>

#include "sim/simulation.h"

namespace neve::sim {

/// One time that a run went back.
struct Retry {
  std::size_t step = 0;  ///< that broke the rule
  double time = 0;       ///< s, of that step
  double back_to = 0;    ///< s, the run continued from there
  double dt_scale = 1;   ///< factor of every dt from there on
  std::string rule, sentence;
};

/// Number of retries of one frame at most: down to a sixteenth of the dt.
inline constexpr int max_retries = 4;

/// advance_to, and where it breaks a rule back to the state it started from with half the dt; after
/// a frame that held, dt doubles again up to the dt of the settings. After max_retries the
/// divergence stays. Interrupted, it is back at its start, so that what is saved then knows where
/// to go back to.
/// @param retries  are appended
/// @return steps of the attempt that the state comes from
AdvanceReport advance_retrying(Simulation& simulation, double time, const StepObserver& after_step,
                               std::vector<Retry>& retries);

}  // namespace neve::sim

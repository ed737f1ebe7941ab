#pragma once
/// The progress of a run: the numbers that later steps depend on.

#include <array>
#include <cstdint>
#include <type_traits>

#include "sim/seeding/flow.h"
#include "sim/types/reports.h"
#include "sim/types/time_step.h"

namespace neve::sim::engine {

/// The energy that the run may have: at its start, and from gravity and colliders. Friction and
/// plastic flow only lower it.
struct EnergyBudget {
  double start = 0;         ///< J, kinetic and elastic; emitted snow added, removed snow subtracted
  double contact_work = 0;  ///< J, of the colliders on the snow; negative where they take energy
  double largest = 0;       ///< J, the largest budget so far: the scale of the rule
  std::array<double, 3> moment{};  ///< kg m, sum m x at the start, and of snow that came and went
};

/// The frame that advance_to is in: an interrupted one continues as if nothing had happened.
struct FrameProgress {
  double start = 0, done = 0, end = 0;  ///< s
};

/// Saved and restored whole, as its bytes.
struct Progress {
  double time = 0;            ///< s
  double colliders_time = 0;  ///< s, of the colliders' poses: steps that skip them leave it behind
  std::uint64_t steps = 0;
  std::uint64_t next_id = 0;  ///< of the next particle that is born
  StateLimits limits;
  double rest_dt = 0;  ///< s, the longest stable step at the start
  double last_dt = 0;  ///< s
  double dt_scale = 1;
  FrameProgress frame;
  EnergyBudget energy;
  Warnings warnings;
  seeding::FlowTotals flow;
  std::uint64_t steps_since_sink_check = 0;
  double distance_since_sink_check = 0;  ///< m, of the fastest particle of each step
};
static_assert(std::is_trivially_copyable_v<Progress>);
// Numbers have 8 bytes each: padding would put stray bytes into files.
static_assert(sizeof(std::size_t) == 8 && sizeof(Progress) == 8 * 39);

}  // namespace neve::sim::engine

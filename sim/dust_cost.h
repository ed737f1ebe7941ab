#pragma once
/// Memory and steps that the dust of a run may need, for plans.

#include "sim/types/dust.h"

namespace neve::sim {

/// Bytes of all the dust that there may be, and of its air.
double max_dust_memory(const DustSettings& settings);

/// Steps of the dust in a frame of so many seconds, where snow is no faster than a speed, m/s.
double dust_steps_of_frame(const DustSettings& settings, double cell_size, double speed,
                           double frame);

}  // namespace neve::sim

#pragma once
/// The volume that F believes in beside the one that snow takes.

#include <cstdint>
#include <vector>

#include "sim/types/particle_arrays.h"

namespace neve::sim::checks {

/// det F of snow times its density among its neighbours over that at rest: 1 where particles are
/// where F says. F is strained by the grid; particles that move by another velocity leave it.
/// The median of packed particles that have neighbours all around; at most a few thousand of them
/// are looked at. It is within 1.1 of 1 in snow that moves by what strains it.
/// @param first_born  id from which on particles come from emitters. They are born where there is
///   room, as chance has it and denser than F says, so they only count as neighbours.
/// @return 1 if there are too few of them to tell
double believed_volume(const ParticleArrays& particles, const std::vector<Material>& materials,
                       std::uint64_t first_born);

}  // namespace neve::sim::checks

#include "sim/dust_cost.h"

#include <cmath>

#include "sim/dust/dust.h"

namespace neve::sim {

double max_dust_memory(const DustSettings& settings) {
  // Each mote is in the cloud, in its arrays and in their copy for a picture.
  constexpr double mote = sizeof(dust::Mote) + 2 * (2 * sizeof(Vec3d) + 3 * sizeof(double));
  return settings.particles * mote + dust::max_air_cells * dust::bytes_of_air_cell;
}

double dust_steps_of_frame(const DustSettings& settings, double cell_size, double speed,
                           double frame) {
  return std::ceil(frame / dust::longest_step(settings, cell_size, speed));
}

}  // namespace neve::sim

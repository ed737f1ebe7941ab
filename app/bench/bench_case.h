#pragma once
/// The snow that `neve bench sim` pushes around.

#include "sim/simulation.h"
#include "sim/types/material.h"
#include "sim/types/settings.h"

namespace neve::app::bench {

/// Ingredients of a simulation.
struct BenchCase {
  sim::SolverSettings settings;
  sim::Material material;
  sim::ParticleArrays particles;  ///< with volumes
  sim::seeding::Flow flow{};
  std::vector<sim::shapes::Collider> colliders{};
};

enum class BenchMethod { mls_quadratic, flip_cubic, apic_cubic, asflip_cubic };

/// "mls_quadratic"
const char* name(BenchMethod method);

/// h = 1 cm, fixed steps of 1e-4 s, defaults otherwise.
sim::SolverSettings bench_settings(BenchMethod method, sim::Precision precision);

/// Steps of one measurement: snow that is squeezed at 24 per second yields from step 31 on.
inline constexpr int bench_steps = 60;

/// The common case: a cube of n^3 cells of the paper's snow, 8 particles in each on a lattice,
/// squeezed towards its middle c by v = -8 (x - c). About half of the particle steps yield.
BenchCase packed_case(int cells_a_side, BenchMethod method, sim::Precision precision);

/// Arrangement of the particles of spray.
enum class SprayPlaces { at_random, on_a_lattice };

/// n^3 particles of the same size in a cube, moving alike.
/// @param cells_apart  side of the cube over n, cells
BenchCase spray_case(int particles_a_side, double cells_apart, SprayPlaces places,
                     BenchMethod method, sim::Precision precision);

/// The packed cube falling through a place of its size at a tenth of a cell per step.
/// @param flows  it is emitted above and removed below, as much as passes; false: it only falls
BenchCase stream_case(int cells_a_side, BenchMethod method, bool flows);

/// The packed cube lies on a plate of its size.
/// @param moves  the plate is a body that snow moves, as heavy as the snow
BenchCase plate_case(int cells_a_side, BenchMethod method, bool moves);

/// Cells on a side of the packed cube whose particle count is nearest.
int packed_cells_a_side(double particles);

}  // namespace neve::app::bench

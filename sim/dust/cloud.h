#pragma once
/// The particles of dust: born from snow, carried by the air, and gone when they have settled or
/// faded. Each is on its own: its path follows from its key, the air and the solids.

#include <cstdint>
#include <span>
#include <vector>

#include "sim/base/thread_pool.h"
#include "sim/dust/air.h"
#include "sim/dust/gusts.h"
#include "sim/dust/snow_grain.h"
#include "sim/dust/solids.h"
#include "sim/types/dust.h"

namespace neve::sim::dust {

/// A particle of dust. Only numbers of 8 bytes: saved as its bytes.
struct Mote {
  double x[3], v[3];  ///< m, from the lattice origin; m/s
  double m;           ///< kg
  double age, life;   ///< s; life 0: it does not fade
  std::uint64_t key;  ///< its number, from 1
};

/// Surroundings that a step of the cloud depends on besides the air.
struct Surroundings {
  const DustSettings& settings;
  const Solids& solids;
  Vec3d gravity;           ///< m/s2
  double time = 0;         ///< s, at the end of the step
  double dt = 0;           ///< s
  std::uint64_t step = 0;  ///< its number: random numbers follow from it
};

class Cloud {
 public:
  /// Dust leaves the snow.
  void shed(std::span<const SnowGrain> snow, const Air& air, const Surroundings& around,
            double snow_spacing);
  /// One step of all of it, for those that were there before.
  void move(const Air& air, const Gusts& gusts, const Surroundings& around, ThreadPool& pool);

  std::vector<Mote> motes;  ///< in the order of birth
  DustTotals totals;
};

/// Share of the dust that snow sheds, of all that it may shed, in [0, 1].
/// @param speed        m/s, relative to the wind
/// @param strain_rate  1/s
/// @param fill         see Air::fill: what lies deep in packed snow cannot leave it
double shedding(const DustSettings& settings, double speed, double strain_rate, double J_P,
                double fill);

}  // namespace neve::sim::dust

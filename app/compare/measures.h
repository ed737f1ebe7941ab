#pragma once
/// Differences between two states, in numbers.

#include <vector>

#include "app/picture/snapshot.h"
#include "sim/simulation.h"

namespace neve::app::compare {

/// Distances between the particles of one id in two runs.
struct Displacement {
  std::size_t in_both = 0, only_a = 0, only_b = 0;  ///< particles
  double mean = 0, largest = 0;                     ///< m, of those in both; 0 without any
};
Displacement displacement(const sim::ParticleArrays& a, const sim::ParticleArrays& b);

/// For each point of one run the distance to the particle of its id in the other, m; points that
/// the other run does not have are taken away.
void color_by_displacement(const sim::ParticleArrays& other, double range, render::Points& points);

/// The mass of the snow on the nodes where one run has more than the other.
struct MassDifference {
  render::Smoke smoke;                  ///< value: kg/m3 that B has more
  double more_in_a = 0, more_in_b = 0;  ///< kg
};
/// @param a, b  of simulations with one cell size; their lattices begin at one origin
MassDifference mass_difference(const picture::FieldSamples& a, const picture::FieldSamples& b);

}  // namespace neve::app::compare

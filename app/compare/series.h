#pragma once
/// Numbers of two runs over time: as a table, as JSON and as curves.

#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "app/picture/snapshot.h"
#include "app/record/run_json.h"
#include "app/support/json.h"
#include "render/renderer.h"
#include "sim/simulation.h"

namespace neve::app::compare {

/// Distances between the particles of one id in two runs.
struct Displacement {
  std::size_t in_both = 0, only_a = 0, only_b = 0;  ///< particles
  double mean = NAN, largest = NAN;                 ///< m, of those in both, if there are any
};
Displacement displacement(const sim::ParticleArrays& a, const sim::ParticleArrays& b);

/// Gives each point of one run its distance to the particle of its id in the other, m. Points that
/// the other run does not have are taken away.
void color_by_displacement(const sim::ParticleArrays& other, double range, render::Points& points);

/// The mass of the snow on the nodes where one run has more than the other.
struct MassDifference {
  render::Smoke smoke;                  ///< value: kg/m3 that B has more
  double more_in_a = 0, more_in_b = 0;  ///< kg
};
/// @param a, b  of simulations with one cell size; their lattices begin at one origin
MassDifference mass_difference(const picture::FieldSamples& a, const picture::FieldSamples& b);

/// The numbers of both runs at one frame.
struct PairMoment {
  int frame = 0;                               ///< its number in A
  double time = 0;                             ///< s
  std::array<std::vector<double>, 2> metrics;  ///< of A and B, in the order of metric names; empty
                                               ///< where run.json does not list the frame
  std::optional<Displacement> displacement;    ///< absent unless particles were compared
  std::optional<std::array<double, 2>> mass;   ///< kg, more in A and more in B
};

/// The metrics of a frame, counted from 0, as run.json lists them.
PairMoment moment_of(int frame, const scene::Scene& scene_a,
                     const std::vector<record::FrameRecord>& a,
                     const std::vector<record::FrameRecord>& b);

/// A row a frame: "frame,time,spread_a,spread_b,...".
std::string series_csv(const std::vector<PairMoment>& moments);

/// A list of objects with the same names.
Json series_json(const std::vector<PairMoment>& moments);

/// Panels with a curve of A and one of B.
render::Image draw_series(const std::vector<PairMoment>& moments, const std::string& title_a,
                          const std::string& title_b, render::Renderer& renderer);

}  // namespace neve::app::compare

#pragma once
/// A block of snow that comes to rest on a surface, and how far from the surface it does.

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "sim/simulation.h"

namespace neve::test {

using sim::ParticleArrays;
using sim::Vec3d;

/// h, m, and the block's measures in cells; eight particles a cell. The same block in finer cells
/// has more of them.
inline constexpr double rest_cell = 0.02;
inline constexpr int rest_width = 4, rest_height = 5;

/// A surface by a point of it, its outward normal and a direction along it.
struct RestingPlace {
  Vec3d point, normal, along;
  int finer = 1;  ///< cells are so many times smaller

  double cell() const { return rest_cell / finer; }
  int width() const { return finer * rest_width; }    ///< of the block, cells
  int height() const { return finer * rest_height; }  ///< likewise
};

/// A plane `fraction` of a cell above a plane of nodes at the block's middle, tilted by degrees.
inline RestingPlace tilted_place(double fraction, double degrees, int finer = 1) {
  const double a = degrees * std::numbers::pi / 180;
  return {{0.003, fraction * rest_cell / finer, 0.004},
          {-std::sin(a), std::cos(a), 0},
          {std::cos(a), std::sin(a), 0},
          finer};
}

/// Returns a position in cells, from the place: along it, away from it, and across.
inline Vec3d in_place(const RestingPlace& place, const Vec3d& x) {
  const Vec3d d = (x - place.point) / place.cell();
  return {d.dot(place.along), d.dot(place.normal), d.dot(place.along.cross(place.normal))};
}

/// Returns snow seeded as bodies are, with its lower side `lift` cells off the place.
inline ParticleArrays block_at(const RestingPlace& place, double lift) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> unit(-0.3, 0.3);
  const Vec3d across = place.along.cross(place.normal);
  const double spacing = 0.5 * place.cell();
  ParticleArrays p;
  for (int i = 0; i < 2 * place.width(); ++i)
    for (int j = 0; j < 2 * place.height(); ++j)
      for (int k = 0; k < 2 * place.width(); ++k) {
        const double x = i + 0.5 + unit(random) - place.width(), y = j + 0.5 + unit(random);
        const double z = k + 0.5 + unit(random) - place.width();
        p.x.push_back(place.point + spacing * (x * place.along + z * across) +
                      (spacing * y + lift * place.cell()) * place.normal);
        p.v.push_back(Vec3d::Zero());
        p.m.push_back(400 * spacing * spacing * spacing);
        p.V0.push_back(spacing * spacing * spacing);
      }
  return p;
}

/// Measures of snow at rest, in cells.
struct Rest {
  double gap = 0;     ///< of columns of a cell: how much higher their lowest particle is than in
                      ///< the same body seeded so that it touches; the mean
  double spread = 0;  ///< of the gaps along the surface: their standard deviation
  double rise = 0;    ///< of the centre of mass, likewise
  double lowest = 0;  ///< height of the lowest particle
  double torn = 0;    ///< density of the first cell above the surface over that of the next, less 1
};

inline Rest rest_of(const RestingPlace& place, const ParticleArrays& now) {
  const ParticleArrays seeded = block_at(place, 0);
  const int width = place.width();
  const auto columns = static_cast<std::size_t>(width * width);
  std::vector<double> before(columns, std::numeric_limits<double>::infinity()), after = before;
  Rest rest;
  std::vector<double> heights;
  for (std::size_t q = 0; q < now.x.size(); ++q) {
    const Vec3d from = in_place(place, seeded.x[q]), to = in_place(place, now.x[q]);
    const auto column = [&](double c) {
      return std::clamp(static_cast<int>(std::floor(c + 0.5 * width)), 0, width - 1);
    };
    const auto c = static_cast<std::size_t>(width * column(from[0]) + column(from[2]));
    before[c] = std::min(before[c], from[1]);
    after[c] = std::min(after[c], to[1]);
    rest.rise += (to[1] - from[1]) / static_cast<double>(now.x.size());
    heights.push_back(to[1]);
  }
  double squares = 0;
  for (std::size_t c = 0; c < columns; ++c) {
    const double gap = after[c] - before[c];
    rest.gap += gap / static_cast<double>(columns);
    squares += gap * gap / static_cast<double>(columns);
  }
  rest.spread = std::sqrt(squares - rest.gap * rest.gap);
  rest.lowest = *std::min_element(heights.begin(), heights.end());
  double first = 0, second = 0;
  for (const double y : heights) {
    first += y < 1;
    second += y >= 1 && y < 2;
  }
  rest.torn = first / second - 1;
  return rest;
}

struct Method {
  sim::Transfer transfer = sim::Transfer::flip;
  sim::Kernel kernel = sim::Kernel::cubic;
  sim::ContactAt contact_at = sim::ContactAt::particles;
  sim::Precision precision = sim::Precision::single;
  double beta = 0;
};

inline Method flip_cubic() {
  return {};
}
inline Method mls_quadratic() {
  return {sim::Transfer::mls, sim::Kernel::quadratic};
}

inline sim::SolverSettings rest_settings(const Method& method) {
  sim::SolverSettings s;
  s.cell_size = rest_cell;
  s.transfer = method.transfer;
  s.kernel = method.kernel;
  s.contact_at = method.contact_at;
  s.precision = method.precision;
  s.beta = method.beta;
  return s;
}

/// Dropped by half a cell along the normal onto a collider whose surface is at the place.
inline Rest rest_on(const sim::shapes::Collider& collider, const RestingPlace& place,
                    const Method& method, double seconds = 0.35) {
  sim::SolverSettings s = rest_settings(method);
  s.cell_size = place.cell();
  s.gravity = -9.81 * place.normal;
  sim::Simulation simulation(s, {sim::Material{}}, {collider}, block_at(place, 0.5), 1);
  simulation.advance_to(seconds);
  return rest_of(place, simulation.particles());
}

}  // namespace neve::test

/// Changes that a run must not depend on: direction, place, motion of everything, frame rate,
/// precision, units.

#include <Eigen/Geometry>
#include <cmath>
#include <numeric>

#include "tests/support/snow.h"
#include "tests/support/verification.h"

namespace {

using namespace neve::sim;
using namespace neve::test;

/// The same fall of a ball on a floor, seen otherwise.
struct World {
  std::string name;
  Mat3d turned = Mat3d::Identity();
  Vec3d moved = Vec3d::Zero();  ///< m
  Vec3d boost = Vec3d::Zero();  ///< m/s, of snow and floor, in the floor's plane
  double frames_per_second = 24;
  Precision precision = Precision::single;
  double mass = 1, length = 1;  ///< units; times are of the square root of lengths
};

Mat3d turn(double degrees, const Vec3d& axis) {
  return Eigen::AngleAxisd(degrees * 3.14159265358979 / 180, axis).toRotationMatrix();
}

std::vector<World> worlds() {
  constexpr double h = 0.02;
  const Vec3d x = Vec3d::UnitX(), z = Vec3d::UnitZ();
  const Mat3d mirror = Vec3d(-1, 1, 1).asDiagonal();
  return {{.name = "turned by 30° about z", .turned = turn(30, z)},
          {.name = "turned by 45° about z and 20° about x", .turned = turn(20, x) * turn(45, z)},
          {.name = "mirrored", .turned = mirror},
          {.name = "shifted by 0.37, 0.61, 0.13 cells", .moved = h * Vec3d(0.37, 0.61, 0.13)},
          {.name = "10 km away", .moved = {1e4, 0, 0}},
          {.name = "at 20 m/s, floor and snow", .boost = {20, 0, 0}},
          {.name = "240 frames a second", .frames_per_second = 240},
          {.name = "double precision", .precision = Precision::real64},
          {.name = "7 times the mass and stiffness", .mass = 7},
          {.name = "twice the size, √2 of the speed", .length = 2}};
}

/// Lengths in metres of the first world; the logarithm of J_P is the mean.
struct Pile {
  double spread = 0, height = 0, packing = 0;
};

/// A ball of five cells at 4 m/s, 0.25 s after it began just above the floor.
Pile fall(const World& w, unsigned seed) {
  const double L = w.length, T = std::sqrt(L), h = 0.02, R = 5 * h;
  SolverSettings s;
  s.cell_size = L * h;
  s.precision = w.precision;
  s.max_dt *= T;
  s.flip_reference_dt *= T;
  s.gravity = w.turned * Vec3d(0, -9.81, 0);
  Material snow;
  snow.density *= w.mass;
  snow.youngs_modulus *= w.mass * L;  // stress is density times speed squared
  // Places count from the block that holds the ball, so that numbers stay as exact as here.
  const double block = 4 * s.cell_size;
  const Vec3i origin = (w.moved / block).array().floor().matrix().cast<int>();
  const Vec3d moved = w.moved - block * origin.cast<double>();
  const Vec3d velocity = w.boost + Vec3d(0.4, -4, 0);
  ParticleArrays p = ball_of_snow({0.003, R + 0.3 * h, 0.004}, R, h / 2, velocity, seed);
  for (std::size_t q = 0; q < p.x.size(); ++q) {
    p.x[q] = w.turned * (L * p.x[q]) + moved;
    p.v[q] = w.turned * p.v[q] * (L / T);
    p.m[q] *= w.mass * L * L * L;
    p.V0[q] *= L * L * L;
  }
  shapes::Collider floor = plane(moved, w.turned * Vec3d(0, 1, 0), 0.5);
  floor.velocity = w.turned * w.boost * (L / T);
  Simulation simulation(s, {snow}, {floor}, p, 2, origin);
  const double end = 0.25 * T;
  for (double time = 0; time < end - 1e-9;) {
    time = std::min(time + T / w.frames_per_second, end);
    simulation.advance_to(time);
  }
  const ParticleArrays now = simulation.particles();
  const double n = static_cast<double>(now.x.size());
  Vec3d middle = Vec3d::Zero();
  std::vector<Vec3d> place;
  for (const Vec3d& x : now.x) place.push_back(w.turned.transpose() * (x - moved) / L);
  for (const Vec3d& x : place) middle += x / n;
  Pile pile{0, middle[1], 0};
  for (std::size_t q = 0; q < place.size(); ++q) {
    pile.spread +=
        (std::pow(place[q][0] - middle[0], 2) + std::pow(place[q][2] - middle[2], 2)) / n;
    pile.packing += std::log(now.J_P[q]) / n;
  }
  pile.spread = std::sqrt(pile.spread);
  return pile;
}

/// Each of them in standard deviations of six seeds. A world is one more draw, and mostly the same
/// one, so its numbers lie within one of the mean: three would be a draw in a hundred of Student's
/// distribution with five degrees of freedom.
TEST(Invariance, APileDependsOnNothingButItsSnow) {
  std::vector<Pile> seeds;
  for (unsigned seed = 1; seed <= 6; ++seed) seeds.push_back(fall({}, seed));
  const std::vector<World> all = worlds();
  for (const World& world : all) {
    const Pile pile = fall(world, 1);
    const auto compare = [&](const char* quantity, double Pile::*number) {
      double mean = 0, variance = 0;
      for (const Pile& one : seeds) mean += one.*number / 6;
      for (const Pile& one : seeds) variance += std::pow(one.*number - mean, 2) / 5;
      verify_near({"invariance", world.name, quantity}, 0,
                  (pile.*number - mean) / std::sqrt(variance), 3);
    };
    compare("spread, deviations of seeds", &Pile::spread);
    compare("height of the centre, deviations", &Pile::height);
    compare("mean of ln J_P, deviations", &Pile::packing);
  }
}

}  // namespace

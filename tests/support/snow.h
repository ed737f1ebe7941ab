#pragma once
/// Particle sets that several tests start from.

#include <random>

#include "sim/simulation.h"

namespace neve::test {

using sim::Mat3d;
using sim::ParticleArrays;
using sim::Vec3d;

/// Particles jittered in a lattice of `spacing` over a box; mass for 400 kg/m3.
inline ParticleArrays box_of_snow(const Vec3d& min, const Vec3d& max, double spacing,
                                  unsigned seed = 1) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> in_cell(0, spacing);
  ParticleArrays p;
  for (double x = min[0]; x + 0.5 * spacing < max[0]; x += spacing)
    for (double y = min[1]; y + 0.5 * spacing < max[1]; y += spacing)
      for (double z = min[2]; z + 0.5 * spacing < max[2]; z += spacing) {
        const double dx = in_cell(random), dy = in_cell(random), dz = in_cell(random);
        p.x.emplace_back(x + dx, y + dy, z + dz);
        p.v.emplace_back(Vec3d::Zero());
        p.m.push_back(400 * spacing * spacing * spacing);
        p.V0.push_back(spacing * spacing * spacing);
      }
  return p;
}

/// The part of a box that lies in a ball.
inline ParticleArrays ball_of_snow(const Vec3d& center, double radius, double spacing,
                                   const Vec3d& velocity, unsigned seed = 1) {
  const Vec3d r = Vec3d::Constant(radius);
  const ParticleArrays box = box_of_snow(center - r, center + r, spacing, seed);
  ParticleArrays p;
  for (std::size_t q = 0; q < box.x.size(); ++q) {
    if ((box.x[q] - center).norm() > radius) continue;
    p.x.push_back(box.x[q]);
    p.v.push_back(velocity);
    p.m.push_back(box.m[q]);
    p.V0.push_back(box.V0[q]);
  }
  return p;
}

/// Random deformation and velocity, as a state in the middle of a run has.
inline void disturb(ParticleArrays& p, double strain, double speed, unsigned seed = 2) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(-1, 1);
  const auto number = [&] { return unit(random); };
  p.F_E.resize(p.x.size());
  p.J_P.resize(p.x.size());
  p.C.resize(p.x.size());
  for (std::size_t q = 0; q < p.x.size(); ++q) {
    p.v[q] = speed * Vec3d::NullaryExpr(number);
    p.F_E[q] = Mat3d::Identity() + strain * Mat3d::NullaryExpr(number);
    p.J_P[q] = 1 + 0.1 * number();
    p.C[q] = speed * Mat3d::NullaryExpr(number);
  }
}

/// Six hundred particles in the middle of a run; part of them is compressed.
inline ParticleArrays disturbed_snow() {
  ParticleArrays p = box_of_snow({-0.11, 0.02, 0.33}, {0.14, 0.21, 0.52}, 0.025);
  disturb(p, 0.004, 2.0);
  return p;
}

inline sim::shapes::Collider plane(const Vec3d& point, const Vec3d& normal, double friction,
                                   sim::shapes::Contact contact = sim::shapes::Contact::separate) {
  sim::shapes::Collider c;
  c.name = "plane";
  c.shape.form = sim::shapes::Plane{point, normal};
  c.friction = friction;
  c.contact = contact;
  return c;
}

}  // namespace neve::test

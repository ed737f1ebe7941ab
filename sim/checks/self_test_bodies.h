#pragma once
/// Bodies that the self-tests use, and weights computed once more and differently.

#include <vector>

#include "sim/checks/self_test.h"
#include "sim/staged.h"

namespace neve::sim::checks::self_test {

/// Cell size of every self-test, m. Not a power of two, so that rounding takes part.
inline constexpr double cell_size = 0.05;
/// Density of the bodies, kg/m3.
inline constexpr double density = 400;

/// Returns a material that feels no strain: only what happens to v, C and F then shows.
Material without_stiffness();
/// Returns materials with defaults in all but the law, in the order of the list of laws.
std::vector<Material> one_of_each_law();
/// Returns a material of the first law that never yields.
Material elastic_material();
/// Returns settings without gravity, and with a FLIP ratio that acts per step.
SolverSettings settings_of(const SelfTestCase& test);

/// Numbers in [-1, 1), always the same.
class Numbers {
 public:
  explicit Numbers(unsigned seed) : state_(seed * 0x9e3779b97f4a7c15ull + 1) {}
  double operator()();
  Vec3d vector() {
    return Vec3d::NullaryExpr([this] { return (*this)(); });
  }
  Mat3d matrix() {
    return Mat3d::NullaryExpr([this] { return (*this)(); });
  }

 private:
  std::uint64_t state_;
};

/// Particles so far apart that none shares a node with another: a node has the data of one
/// particle. At rest, with given volumes and F_E = I.
ParticleArrays isolated_particles(int count);

/// The isolated particle that a node belongs to.
std::size_t owner(const Vec3i& node);

/// Two interleaved lattices of spacing h around the origin. B-splines on such a lattice reproduce
/// linear functions, so that in its middle the grid's velocity is exactly that of the particles.
ParticleArrays even_lattice();
/// True if every node around x is surrounded by the lattice.
bool is_deep_inside(const Vec3d& x);

/// A ball of snow with some particles per cell, at rest, with its true volumes.
ParticleArrays small_ball();

/// w_ip, from the definition of the splines: cubic and quadratic hats by distance.
double weight(Kernel kernel, const Vec3d& node_minus_particle);
/// Gradient that forces and velocity gradients use, 1/m: grad_w_ip, for MLS w_ip (x_i - x_p) / D
/// (Hu et al. 2018).
Vec3d weight_gradient(Kernel kernel, Transfer transfer, const Vec3d& node_minus_particle);

/// sum w_ip v_i of the step's end, m/s.
Vec3d grid_velocity(Kernel kernel, const NodeFields& nodes, const Vec3d& x);

/// D of APIC, h^2/3 or h^2/4 (Jiang et al. 2015), m2.
double inertia(Kernel kernel);

/// Position of a node, m.
inline Vec3d place(const Vec3i& node) {
  return node.cast<double>() * cell_size;
}

/// Effective force on each node: from the change of the grid's velocity, without gravity, N.
std::vector<Vec3d> felt_forces(const StagedStep& step, double dt);

/// Kirchhoff stress of isolated particles as nodes feel it: -sum f_i (x_i - x_p)^T / V0, Pa.
std::vector<Mat3d> felt_stress(const ParticleArrays& particles, const StagedStep& step, double dt);

}  // namespace neve::sim::checks::self_test

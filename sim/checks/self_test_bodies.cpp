#include "sim/checks/self_test_bodies.h"

#include <cmath>

#include "sim/laws/law.h"

namespace neve::sim::checks::self_test {

namespace {

/// Cells from one isolated particle to the next: stencils are up to 4 nodes wide.
constexpr int cells_apart = 6;
constexpr int per_row = 3;

void add(ParticleArrays& p, const Vec3d& x, double volume) {
  p.x.push_back(x);
  p.v.push_back(Vec3d::Zero());
  p.m.push_back(density * volume);
  p.V0.push_back(volume);
}

/// N and N' at a distance in cells.
double spline(Kernel kernel, double x) {
  const double r = std::abs(x);
  if (kernel == Kernel::quadratic)
    return r < 0.5 ? 0.75 - r * r : r < 1.5 ? 0.5 * (1.5 - r) * (1.5 - r) : 0;
  if (r < 1) return 0.5 * r * r * r - r * r + 2.0 / 3;
  return r < 2 ? (2 - r) * (2 - r) * (2 - r) / 6 : 0;
}
double spline_slope(Kernel kernel, double x) {
  const double r = std::abs(x), sign = x < 0 ? -1 : 1;
  if (kernel == Kernel::quadratic) return r < 0.5 ? -2 * x : r < 1.5 ? -sign * (1.5 - r) : 0;
  if (r < 1) return sign * (1.5 * r * r - 2 * r);
  return r < 2 ? -sign * 0.5 * (2 - r) * (2 - r) : 0;
}

}  // namespace

Material without_stiffness() {
  Material m;
  m.youngs_modulus = 0;
  return m;
}

std::vector<Material> one_of_each_law() {
  std::vector<Material> materials;
  for (const laws::Law& law : laws::every()) materials.emplace_back().model = law.model;
  return materials;
}

Material elastic_material() {
  const std::vector<Material> all = one_of_each_law();
  return *std::find_if(all.begin(), all.end(),
                       [](const Material& m) { return !laws::of(m).is_plastic; });
}

SolverSettings settings_of(const SelfTestCase& test) {
  SolverSettings settings;
  settings.cell_size = cell_size;
  settings.kernel = test.kernel;
  settings.transfer = test.transfer;
  settings.precision = test.precision;
  settings.gravity.setZero();
  settings.flip_reference_dt = 0;
  return settings;
}

double Numbers::operator()() {
  // xorshift64 (Marsaglia 2003): any library's distribution would give other numbers elsewhere.
  state_ ^= state_ << 13;
  state_ ^= state_ >> 7;
  state_ ^= state_ << 17;
  return static_cast<double>(state_ >> 11) * 0x1p-52 - 1;
}

ParticleArrays isolated_particles(int count) {
  Numbers number(1);
  ParticleArrays p;
  for (int q = 0; q < count; ++q) {
    const Vec3d cell(q % per_row, q / per_row % per_row, q / (per_row * per_row));
    const Vec3d offset = 0.5 * (number.vector() + Vec3d::Ones());
    add(p, (cells_apart * cell + offset) * cell_size, std::pow(cell_size, 3) / 8);
  }
  p.F_E.assign(p.x.size(), Mat3d::Identity());
  p.J_P.assign(p.x.size(), 1);
  return p;
}

std::size_t owner(const Vec3i& node) {
  const Vec3i cell = (node + Vec3i::Constant(2)) / cells_apart;
  return static_cast<std::size_t>(cell[0] + per_row * (cell[1] + per_row * cell[2]));
}

ParticleArrays even_lattice() {
  // One particle on either side of the middle of a cell: quadratic stencils then start at two
  // different nodes.
  const Vec3d offsets[] = {{0.13, 0.47, 0.71}, {0.62, 0.88, 0.29}};
  constexpr int reach = 5;
  ParticleArrays p;
  for (const Vec3d& offset : offsets)
    for (int i = -reach; i < reach; ++i)
      for (int j = -reach; j < reach; ++j)
        for (int k = -reach; k < reach; ++k)
          add(p, (Vec3d(i, j, k) + offset) * cell_size, std::pow(cell_size, 3) / 2);
  return p;
}

bool is_deep_inside(const Vec3d& x) {
  return x.cwiseAbs().maxCoeff() < cell_size;
}

ParticleArrays small_ball() {
  Numbers number(2);
  constexpr double radius = 2 * cell_size;
  constexpr int count = 160;
  ParticleArrays p;
  while (p.x.size() < count) {
    const Vec3d x = radius * number.vector();
    if (x.norm() < radius) add(p, x, 4.18879020478639 * radius * radius * radius / count);
  }
  return p;
}

Vec3d grid_velocity(Kernel kernel, const NodeFields& nodes, const Vec3d& x) {
  Vec3d v = Vec3d::Zero();
  for (std::size_t i = 0; i < nodes.mass.size(); ++i)
    v += weight(kernel, place(nodes.node[i]) - x) * nodes.v_new[i];
  return v;
}

double inertia(Kernel kernel) {
  return cell_size * cell_size * (kernel == Kernel::cubic ? 1.0 / 3 : 1.0 / 4);
}

double weight(Kernel kernel, const Vec3d& d) {
  return spline(kernel, d[0] / cell_size) * spline(kernel, d[1] / cell_size) *
         spline(kernel, d[2] / cell_size);
}

Vec3d weight_gradient(Kernel kernel, Transfer transfer, const Vec3d& d) {
  if (transfer == Transfer::mls) return weight(kernel, d) / inertia(kernel) * d;
  Vec3d N, slope;
  for (int a = 0; a < 3; ++a) {
    N[a] = spline(kernel, d[a] / cell_size);
    // The gradient is by x_p, which is subtracted.
    slope[a] = -spline_slope(kernel, d[a] / cell_size) / cell_size;
  }
  return {slope[0] * N[1] * N[2], N[0] * slope[1] * N[2], N[0] * N[1] * slope[2]};
}

std::vector<Vec3d> felt_forces(const StagedStep& step, double dt) {
  std::vector<Vec3d> forces;
  for (std::size_t i = 0; i < step.nodes.mass.size(); ++i)
    forces.push_back(step.nodes.mass[i] / dt * (step.nodes.v_free[i] - step.nodes.v_old[i]));
  return forces;
}

std::vector<Mat3d> felt_stress(const ParticleArrays& particles, const StagedStep& step, double dt) {
  std::vector<Mat3d> stress(particles.x.size(), Mat3d::Zero());
  const std::vector<Vec3d> forces = felt_forces(step, dt);
  for (std::size_t i = 0; i < forces.size(); ++i) {
    const std::size_t q = owner(step.nodes.node[i]);
    if (q >= stress.size()) continue;
    const Vec3d arm = place(step.nodes.node[i]) - particles.x[q];
    stress[q] -= forces[i] * arm.transpose() / particles.V0[q];
  }
  return stress;
}

}  // namespace neve::sim::checks::self_test

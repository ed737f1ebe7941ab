#include "sim/state/method.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "sim/health/diagnostics.h"
#include "sim/health/shock.h"
#include "sim/kernels/simd.h"
#include "sim/laws/law.h"
#include "sim/shapes/variation.h"

namespace neve::sim::engine {

namespace {

kernels::TransferKind transfer_kind(Transfer transfer) {
  switch (transfer) {
    case Transfer::apic:
      return kernels::TransferKind::apic;
    case Transfer::mls:
      return kernels::TransferKind::mls;
    case Transfer::aflip:
    case Transfer::asflip:
      return kernels::TransferKind::aflip;
    default:
      return kernels::TransferKind::flip;
  }
}

/// Shares of its own velocity that a particle moves with.
struct OwnShares {
  double compressed, separating;
};
OwnShares own_shares(const SolverSettings& s) {
  if (s.transfer == Transfer::asflip) return {s.separation_min, s.separation_max};
  const bool moves_by_itself = s.transfer == Transfer::flip && s.advect == Advect::particle;
  return moves_by_itself ? OwnShares{1, 1} : OwnShares{0, 0};
}

template <class Real>
std::vector<kernels::MaterialConstants<Real>> table_of(const std::vector<Material>& materials) {
  std::vector<kernels::MaterialConstants<Real>> table;
  for (const Material& m : materials) {
    if (m.yields && materials.size() > 1)
      throw std::invalid_argument("material " + m.name +
                                  " yields besides snow: it must be the only material");
    table.push_back(constants_of<Real>(m));
  }
  return table;
}

}  // namespace

template <class Real>
kernels::MaterialConstants<Real> constants_of(const Material& m) {
  const Lame rest = lame(m.youngs_modulus, m.poisson_ratio);
  kernels::MaterialConstants<Real> row{.mu0 = static_cast<Real>(rest.mu),
                                       .lambda0 = static_cast<Real>(rest.lambda),
                                       .xi = static_cast<Real>(m.hardening),
                                       .theta_c = static_cast<Real>(m.critical_compression),
                                       .theta_s = static_cast<Real>(m.critical_stretch),
                                       .min_J_P = static_cast<Real>(m.min_J_P),
                                       .max_J_P = static_cast<Real>(m.max_J_P),
                                       .max_hardening = static_cast<Real>(m.max_hardening)};
  double own[kernels::own_constants] = {};
  if (const auto constants = laws::of(m).constants) constants(m, own);
  for (int k = 0; k < kernels::own_constants; ++k) row.own[k] = static_cast<Real>(own[k]);
  return row;
}

template <class Real>
Method<Real>::Method(const SolverSettings& given, const std::vector<Material>& materials_given,
                     const Vec3i& lattice_origin)
    : lattice{given.cell_size, lattice_origin} {
  if (materials_given.empty()) throw std::invalid_argument("a simulation needs a material");
  if (given.period.minCoeff() < 0 || given.period.maxCoeff() > kernels::block_limit)
    throw std::invalid_argument("a period of the lattice is negative or too long");
  simd = kernels::chosen_simd_level();
  change(given, materials_given);
}

template <class Real>
void Method<Real>::change(const SolverSettings& given,
                          const std::vector<Material>& materials_given) {
  material_constants = table_of<Real>(materials_given);
  settings = given;
  materials = materials_given;
  half_spacing.clear();
  double max_density = 0;
  for (const Material& m : materials) {
    half_spacing.push_back(static_cast<Real>(0.5 * std::cbrt(1 / m.density)));
    max_density = std::max(max_density, m.density);
  }
  // 2^-30 of a full cell at 1 m/s: 2^63 of them stop 10^8 cells at 80 m/s within a step.
  load_unit = std::ldexp(1.0, std::ilogb(max_density * std::pow(settings.cell_size, 3)) - 30);
  kernel_nodes = settings.kernel == Kernel::cubic ? kernels::cubic_nodes : kernels::quadratic_nodes;
  sweeps = &kernels::sweeps_for(simd, kernel_nodes, transfer_kind(settings.transfer), Real());
  solve_sweeps =
      &kernels::solve_sweeps_for(simd, kernel_nodes, settings.transfer == Transfer::mls, Real());
  contact_sweeps = &kernels::contact_sweeps_for(simd, kernel_nodes, Real());
}

template <class Real>
void Method<Real>::limit_hardening(StateLimits& limits) const {
  limits.max_xi = limits.max_hardened_speed = 0;
  // Sound in a particle at a corner, whose volume is estimated from nodes that it hardly shares, is
  // as fast as in snow 6.5 times as stiff.
  constexpr double corner = 6.5;
  for (const Material& material : materials)
    laws::include_hardening(material, limits,
                            corner * shapes::max_factor(material.variation.youngs_modulus));
}

template <class Real>
std::size_t Method<Real>::tile_nodes() const {
  return static_cast<std::size_t>(kernel_nodes == kernels::cubic_nodes
                                      ? kernels::Tile<kernels::cubic_nodes>::nodes
                                      : kernels::Tile<kernels::quadratic_nodes>::nodes);
}

template <class Real>
kernels::StepConstants<Real> Method<Real>::step_constants(double dt) const {
  const double h = settings.cell_size;
  kernels::StepConstants<Real> c{};
  c.h = static_cast<Real>(h);
  c.inv_h = static_cast<Real>(1 / h);
  c.dt = static_cast<Real>(dt);
  c.dt_over_h = static_cast<Real>(dt / h);
  c.alpha = static_cast<Real>(flip_share(settings, dt));
  const OwnShares shares = own_shares(settings);
  c.beta_min = static_cast<Real>(shares.compressed);
  c.beta_max = static_cast<Real>(shares.separating);
  c.separating_J_E = static_cast<Real>(settings.separation_J_E);
  if (settings.transfer == Transfer::asflip)
    for (const laws::Law& law : laws::every())
      if (!law.is_plastic) c.whole_laws |= Integer<Real>{1} << static_cast<int>(law.model);
  c.shock_quadratic = static_cast<Real>(health::shock_quadratic * settings.shock_viscosity);
  c.shock_linear = static_cast<Real>(health::shock_linear * settings.shock_viscosity);
  for (int axis = 0; axis < 3; ++axis) c.gravity[axis] = static_cast<Real>(settings.gravity[axis]);
  c.moves_with_grid = settings.advect == Advect::pic;
  c.h_double = h;
  c.materials = material_constants.data();
  return c;
}

template <class Real>
double Method<Real>::affine_inertia() const {
  return settings.cell_size * settings.cell_size *
         (kernel_nodes == kernels::cubic_nodes ? kernels::apic_inertia<kernels::cubic_nodes>
                                               : kernels::apic_inertia<kernels::quadratic_nodes>);
}

template <class Real>
double Method<Real>::kinetic_energy(const kernels::Particle<Real>& p) const {
  return 0.5 * static_cast<double>(p.m) * vector(p.v).squaredNorm() + affine_energy(p);
}

template <class Real>
double Method<Real>::affine_energy(const kernels::Particle<Real>& p) const {
  if (!settings.has_affine_velocity()) return 0;
  return 0.5 * static_cast<double>(p.m) * affine_inertia() * matrix(p.C).squaredNorm();
}

template <class Real>
double Method<Real>::elastic_energy(const kernels::Particle<Real>& p) const {
  return static_cast<double>(p.V0) * static_cast<double>(p.stiffness) *
         health::energy_density(materials[static_cast<std::size_t>(p.material())], matrix(p.F_E),
                                static_cast<double>(p.J_P));
}

template <class Real>
std::array<double, 4> Method<Real>::elastic_energies(
    const std::array<const kernels::Particle<Real>*, 4>& p) const {
  std::array<const Material*, 4> of;
  std::array<Mat3d, 4> F_E;
  std::array<double, 4> J_P;
  for (std::size_t l = 0; l < 4; ++l) {
    of[l] = &materials[static_cast<std::size_t>(p[l]->material())];
    F_E[l] = matrix(p[l]->F_E);
    J_P[l] = static_cast<double>(p[l]->J_P);
  }
  std::array<double, 4> energy = health::energy_densities(of, F_E, J_P);
  for (std::size_t l = 0; l < 4; ++l)
    energy[l] = static_cast<double>(p[l]->V0) * static_cast<double>(p[l]->stiffness) * energy[l];
  return energy;
}

template kernels::MaterialConstants<float> constants_of(const Material&);
template kernels::MaterialConstants<double> constants_of(const Material&);
template struct Method<float>;
template struct Method<double>;

}  // namespace neve::sim::engine

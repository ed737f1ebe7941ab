#pragma once
/// The method of a run: settings and materials, and the kernels that they choose.

#include <array>
#include <vector>

#include "sim/kernels/implicit.h"
#include "sim/kernels/kernels.h"
#include "sim/kernels/particle_contact.h"
#include "sim/state/lattice.h"
#include "sim/types/material.h"
#include "sim/types/settings.h"
#include "sim/types/time_step.h"

namespace neve::sim::engine {

/// A material as kernels see it.
template <class Real>
kernels::MaterialConstants<Real> constants_of(const Material& material);

template <class Real>
struct Method {
  /// @throws std::invalid_argument for materials or a period that cannot be
  Method(const SolverSettings& settings, const std::vector<Material>& materials,
         const Vec3i& lattice_origin);

  /// Changes all but the lattice. @throws std::invalid_argument, and then is as it was
  void change(const SolverSettings& settings, const std::vector<Material>& materials);

  /// True if skipped stages, or a material, force the staged driver.
  bool takes_stages() const { return settings.takes_stages() || materials[0].yields; }
  /// Sets the limits of hardening to those of the materials; the other limits stay.
  void limit_hardening(StateLimits& limits) const;
  std::size_t tile_nodes() const;
  /// Returns the constants of a step of dt, without colliders.
  kernels::StepConstants<Real> step_constants(double dt) const;

  /// True if particles keep velocities of their own and have an affine one: it has to fit them.
  bool fits_affine_velocity() const { return settings.has_affine_and_own_velocity(); }

  /// Returns the inertia of the weights around a particle, m2.
  double affine_inertia() const;
  double kinetic_energy(const kernels::Particle<Real>& p) const;
  /// Returns the energy of its affine velocity, J.
  double affine_energy(const kernels::Particle<Real>& p) const;
  double elastic_energy(const kernels::Particle<Real>& p) const;
  /// The same of four particles, at a third of the cost.
  std::array<double, 4> elastic_energies(
      const std::array<const kernels::Particle<Real>*, 4>& p) const;

  SolverSettings settings;
  std::vector<Material> materials;
  Lattice lattice;
  std::vector<kernels::MaterialConstants<Real>> material_constants;
  std::vector<Real> half_spacing;  ///< per material: of particles of 1 kg, m
  double load_unit = 0;            ///< N s: impulses on colliders are whole numbers of it
  kernels::SimdLevel simd = kernels::SimdLevel::baseline;
  int kernel_nodes = kernels::cubic_nodes;
  const kernels::Sweeps<Real>* sweeps = nullptr;
  const kernels::SolveSweeps<Real>* solve_sweeps = nullptr;
  const kernels::ContactSweeps<Real>* contact_sweeps = nullptr;
};

}  // namespace neve::sim::engine

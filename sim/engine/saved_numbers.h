#pragma once
/// The numbers of a saved state, and which of them cannot be, however right a checksum is.

#include <array>
#include <vector>

#include "sim/kernels/particle_contact.h"
#include "sim/kernels/particles.h"
#include "sim/seeding/flow.h"
#include "sim/shapes/collider.h"
#include "sim/state/method.h"
#include "sim/state/progress.h"

namespace neve::sim::engine {

template <class Real>
struct SavedNumbers {
  Progress progress;
  std::vector<kernels::Particle<Real>> records;
  std::vector<shapes::PoseOffset> offsets;  ///< of colliders
  /// m/s and rad/s, of bodies that move by themselves.
  std::vector<std::array<Vec3d, 2>> motions;
  std::vector<seeding::EmitterStream::State> emitters;
  std::vector<kernels::KeptContact<Real>> contacts;
  /// Shock pressure of changes at this moment, see ParticleStorage; empty without one of stress.
  std::vector<Real> shock_pressure;
  bool has_new_affine = false;
};

/// Refuses numbers that would be used as places in memory: of cells, materials, models, ids.
/// @throws SavedStateError
template <class Real>
void require_consistent(const SavedNumbers<Real>& saved, const Method<Real>& method);

/// Refuses numbers that a run has only after it diverged, or never: times, limits of the next step,
/// counters, and particles.
/// @throws SavedStateError
template <class Real>
void require_healthy(const SavedNumbers<Real>& saved, const Method<Real>& method);

}  // namespace neve::sim::engine

#pragma once
/// A snow simulation: particles in, steps, particles out. Knows no files and no graphics.

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "sim/engine/stepper.h"
#include "sim/seeding/flow.h"
#include "sim/shapes/collider.h"
#include "sim/types/dust.h"
#include "sim/types/energy_account.h"
#include "sim/types/errors.h"
#include "sim/types/material.h"
#include "sim/types/particle_arrays.h"
#include "sim/types/reports.h"
#include "sim/types/settings.h"
#include "sim/types/step_observer.h"

namespace neve::sim {

class Simulation {
 public:
  /// @param flow  emitters and sinks; they never change
  /// @param lattice_origin  in blocks of 4 cells; x is measured from it. Moving it changes no bit
  /// of
  ///        the result but the cells.
  /// @throws std::invalid_argument when arrays disagree in length or hold non-finite numbers
  /// @throws ShapeError for emitters and sinks without a volume
  Simulation(const SolverSettings& settings, const std::vector<Material>& materials,
             const std::vector<shapes::Collider>& colliders, const ParticleArrays& particles,
             int threads = 0, const Vec3i& lattice_origin = Vec3i::Zero(),
             const seeding::Flow& flow = {});

  /// Returns the stepper, for functions that inspect a simulation.
  const engine::Stepper& stepper() const { return *stepper_; }

  double time() const { return stepper_->progress().time; }
  std::size_t steps() const { return stepper_->progress().steps; }
  std::size_t particle_count() const { return stepper_->particle_count(); }
  seeding::FlowTotals flow_totals() const { return stepper_->progress().flow; }
  /// Births of each emitter that found no room so far.
  std::vector<std::uint64_t> withheld() const;
  /// Births of each emitter so far, and what was in their way.
  std::vector<seeding::EmitterStream::State> emitter_states() const {
    return stepper_->emitter_states();
  }
  int threads() const { return stepper_->threads(); }
  const char* simd() const { return stepper_->simd(); }
  PhaseSeconds phase_seconds() const { return stepper_->phase_seconds(); }

  /// Bytes held by particles, grid and buffers.
  std::uint64_t memory_bytes() const { return stepper_->memory_bytes(); }

  /// One step of exactly dt seconds through the fused driver.
  void step(double dt) { stepper_->step(dt); }

  /// Steps chosen by the settings until `time` is reached, ending on it exactly. Stops early on
  /// divergence, after a step when the observer says so, or when steps() has reached `last_step`;
  /// called again with the same time it continues as if it had not stopped.
  AdvanceReport advance_to(double time, const StepObserver& after_step = {},
                           std::size_t last_step = std::numeric_limits<std::size_t>::max()) {
    return stepper_->advance_to(time, after_step, last_step);
  }

  /// Changes parameters between steps, all that need no restart: settings but cell_size, precision
  /// and period; materials but their number and density; colliders, also more or fewer of them.
  /// Position, velocity, F_E and J_P of the particles stay; all that follows from them (stress,
  /// limits of the next step) is computed again, and the energy that the change put in or took out
  /// is accounted for, so that no change alone breaks a rule.
  ///
  /// C starts from zero when the transfer changes from or to FLIP, which has none (of AFLIP and
  /// ASFLIP from the fit to the velocities), and stays between the others. A collider keeps its
  /// place when its velocity or spin changes, moves by the edit when its place in the scene
  /// changes, and is the one of the same name (of several the one of the same number); a new one
  /// starts where its shape is and moves from now on. The pose offsets of the colliders given are
  /// ignored.
  ///
  /// Values that are all as before change no bit of the run. save() includes the effects of the
  /// change: restore() into a simulation built with the present parameters takes the same steps to
  /// the bit.
  /// @throws std::invalid_argument for parameters that need a restart; nothing has changed then
  /// @throws std::logic_error after a divergence: first restore() a state from before it
  void apply(const SolverSettings& settings, const std::vector<Material>& materials,
             const std::vector<shapes::Collider>& colliders);

  /// Returns colliders as they are now: pose_at(collider, time()) is the place of each of them.
  std::vector<shapes::Collider> colliders() const { return stepper_->colliders(); }

  /// The dt that the settings would choose now, and the limit that rules it.
  DtChoice choose_dt(double remaining) const { return stepper_->choose_dt(remaining); }

  /// The dt that each limit would allow now, also with fixed steps, and why.
  StepLimits step_limits() const { return stepper_->step_limits(); }

  /// Returns the divergence, set once a rule of a healthy run was broken.
  const std::optional<Divergence>& divergence() const { return stepper_->divergence(); }
  const Warnings& warnings() const { return stepper_->progress().warnings; }
  /// Report of the last step, if it was semi-implicit.
  SolveReport last_solve() const { return stepper_->last_solve(); }

  Summary summary() const { return stepper_->summary(); }

  /// All particles in id order. Volumes that are to be estimated are known from the start: they
  /// follow from the mass on the grid before the first step.
  ParticleArrays particles() const { return stepper_->particles(); }

  /// Dust in the air, and all that there has been. It never changes the snow, unless
  /// DustSettings::spray_drag asks for it.
  DustArrays dust() const { return stepper_->dust(); }

  /// Kirchhoff stress tau = P F_E^T in Pa, id order.
  std::vector<Mat3d> kirchhoff() const { return stepper_->kirchhoff(); }

  /// Cell of each particle (lattice units, absolute) and offset in it, id order.
  std::vector<Vec3i> cells() const { return stepper_->cells(); }

  /// Commutative sum of per-particle hashes keyed by id; cells enter relative to the lattice
  /// origin.
  std::uint64_t state_hash() const { return stepper_->state_hash(); }

  /// The state as bytes, for the same program and machine: a simulation with the same settings,
  /// materials and colliders that restores them takes the same steps to the bit.
  std::vector<std::uint8_t> save() const { return stepper_->save(); }

  /// True if this program saves states in the way of the bytes: builds from other sources may not.
  static bool can_read(std::span<const std::uint8_t> saved);

  /// @throws SavedStateError for bytes that no such simulation saved; nothing has changed then
  void restore(std::span<const std::uint8_t> bytes) { stepper_->restore(bytes); }

  /// Restores bytes from a file, unless no healthy run has their numbers, however well these fit
  /// together. A diverged state is no healthy one.
  /// @throws SavedStateError that names the number; nothing has changed then
  void restore_healthy(std::span<const std::uint8_t> bytes) {
    stepper_->require_healthy(bytes);
    stepper_->restore(bytes);
  }

  /// Sets the factor of every dt that the settings choose from now on, (0, 1]: a run that broke a
  /// rule continues with shorter steps.
  void set_dt_scale(double scale) { stepper_->set_dt_scale(scale); }
  double dt_scale() const { return stepper_->progress().dt_scale; }

 private:
  std::unique_ptr<engine::Stepper> stepper_;
};

/// Energy that the run has now, and that gravity and colliders explain.
EnergyAccount energy_account(const Simulation& simulation);

/// Estimates the bytes that a simulation of so many particles needs, grid and buffers included:
/// from above for packed snow, and before anything is allocated.
std::uint64_t estimate_memory(std::size_t particles, double particles_per_cell,
                              const SolverSettings& settings, int threads);

}  // namespace neve::sim

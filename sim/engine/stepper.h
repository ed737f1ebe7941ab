#pragma once
/// A simulation in one precision or the other; sim/simulation.h says what its functions do.

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "sim/shapes/collider.h"
#include "sim/state/progress.h"
#include "sim/types/energy_account.h"
#include "sim/types/grid_fields.h"
#include "sim/types/material.h"
#include "sim/types/particle_arrays.h"
#include "sim/types/reports.h"
#include "sim/types/settings.h"
#include "sim/types/step_observer.h"

namespace neve::sim::engine {

class Stepper {
 public:
  Stepper() = default;
  Stepper(const Stepper&) = delete;
  Stepper& operator=(const Stepper&) = delete;
  virtual ~Stepper() = default;

  virtual void step(double dt) = 0;
  virtual AdvanceReport advance_to(double time, const StepObserver& after_step,
                                   std::size_t last_step) = 0;
  virtual void apply(const SolverSettings& settings, const std::vector<Material>& materials,
                     const std::vector<shapes::Collider>& colliders) = 0;
  virtual void restore(std::span<const std::uint8_t> bytes) = 0;
  virtual void require_healthy(std::span<const std::uint8_t> bytes) const = 0;
  virtual void set_dt_scale(double scale) = 0;

  virtual const Progress& progress() const = 0;
  virtual std::vector<seeding::EmitterStream::State> emitter_states() const = 0;
  virtual const std::optional<Divergence>& divergence() const = 0;
  virtual SolveReport last_solve() const = 0;
  virtual PhaseSeconds phase_seconds() const = 0;
  virtual DtChoice choose_dt(double remaining) const = 0;
  virtual StepLimits step_limits() const = 0;

  virtual std::size_t particle_count() const = 0;
  virtual int threads() const = 0;
  virtual const char* simd() const = 0;
  virtual std::uint64_t memory_bytes() const = 0;

  virtual std::vector<shapes::Collider> colliders() const = 0;
  virtual Summary summary() const = 0;
  virtual EnergyAccount energy_account() const = 0;
  virtual ParticleArrays particles() const = 0;
  virtual DustArrays dust() const = 0;
  virtual std::vector<Mat3d> kirchhoff() const = 0;
  virtual std::vector<Vec3i> cells() const = 0;
  virtual std::uint64_t state_hash() const = 0;
  virtual std::vector<std::uint8_t> save() const = 0;
  virtual StagedStep staged_step(double dt) const = 0;
  virtual RasterizedNodes rasterize(const std::vector<std::vector<double>>& values) const = 0;
  virtual RasterizedNodes rasterize_some(const std::vector<std::size_t>& rows) const = 0;
};

}  // namespace neve::sim::engine

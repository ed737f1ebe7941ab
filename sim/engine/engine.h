#pragma once
/// A simulation in one precision: steps, and all that happens between them.

#include "sim/dust/dust.h"
#include "sim/engine/live_changes.h"
#include "sim/engine/rasterize.h"
#include "sim/engine/saved_state.h"
#include "sim/engine/snow_flow.h"
#include "sim/engine/staged_step.h"
#include "sim/engine/state_reader.h"
#include "sim/engine/step.h"
#include "sim/engine/stepper.h"
#include "sim/kernels/simd.h"
#include "sim/state/health_watch.h"
#include "sim/state/state.h"

namespace neve::sim::engine {

template <class Real>
class Engine final : public Stepper {
 public:
  Engine(const SolverSettings& settings, const std::vector<Material>& materials,
         const std::vector<shapes::Collider>& colliders, const ParticleArrays& particles,
         int threads, const Vec3i& lattice_origin, const seeding::Flow& flow);

  void step(double dt) override;
  AdvanceReport advance_to(double time, const StepObserver& after_step,
                           std::size_t last_step) override;
  void apply(const SolverSettings& settings, const std::vector<Material>& materials,
             const std::vector<shapes::Collider>& colliders) override;
  void restore(std::span<const std::uint8_t> bytes) override;
  void require_healthy(std::span<const std::uint8_t> bytes) const override {
    engine::require_healthy(split(bytes).snow, state_, flow_);
  }
  void set_dt_scale(double scale) override { state_.progress.dt_scale = scale; }

  const Progress& progress() const override { return state_.progress; }
  std::vector<seeding::EmitterStream::State> emitter_states() const override {
    return flow_.emitter_states();
  }
  const std::optional<Divergence>& divergence() const override { return watch_.divergence(); }
  SolveReport last_solve() const override { return solve_; }
  PhaseSeconds phase_seconds() const override { return parts_.seconds; }
  DtChoice choose_dt(double remaining) const override;
  StepLimits step_limits() const override;

  std::size_t particle_count() const override { return state_.particles.size(); }
  int threads() const override { return state_.pool->thread_count(); }
  const char* simd() const override { return kernels::name(state_.method.simd); }
  std::uint64_t memory_bytes() const override;

  std::vector<shapes::Collider> colliders() const override { return colliders_now(state_); }
  Summary summary() const override;
  EnergyAccount energy_account() const override {
    return engine::energy_account(state_.method.settings, state_.progress, summary());
  }
  ParticleArrays particles() const override { return StateReader<Real>(state_).particles(); }
  DustArrays dust() const override { return has_dust() ? dust_.arrays() : DustArrays{}; }
  std::vector<Mat3d> kirchhoff() const override { return StateReader<Real>(state_).kirchhoff(); }
  std::vector<Vec3i> cells() const override { return StateReader<Real>(state_).cells(); }
  std::uint64_t state_hash() const override { return StateReader<Real>(state_).state_hash(); }
  std::vector<std::uint8_t> save() const override;
  StagedStep staged_step(double dt) const override { return engine::staged_step(state_, dt); }
  RasterizedNodes rasterize(const std::vector<std::vector<double>>& values) const override {
    return engine::rasterize(state_, values);
  }
  RasterizedNodes rasterize_some(const std::vector<std::size_t>& rows) const override {
    return engine::rasterize_some(state_, rows);
  }

 private:
  void take_whole_step(double dt);
  void take_step(double dt);
  bool has_dust() const;
  void run_dust(bool is_frame_end);
  void take_implicit(double dt, int halvings);
  bool take_fused(double dt, bool is_implicit);
  void take_stages(double dt);
  void check_step(double dt, bool is_implicit);
  void check_sums();
  void diverge_if(const std::optional<BrokenRule>& broken);
  void advance_frame(const DtChoice& choice, AdvanceReport& report);

  State<Real> state_;
  StepParts<Real> parts_;
  std::vector<ColliderLoad> loads_;  ///< since advance_to was called
  SolveReport solve_;                ///< of the last step, if it was semi-implicit
  bool took_explicit_ = false;       ///< in place of a semi-implicit part of it
  SnowFlow<Real> flow_;
  HealthWatch watch_;
  dust::Dust dust_;
};

}  // namespace neve::sim::engine

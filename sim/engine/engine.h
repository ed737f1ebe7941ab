#pragma once
/// The state of a simulation in one precision and the drivers that advance it.

#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "sim/base/thread_pool.h"
#include "sim/engine/partition.h"
#include "sim/engine/time_step.h"
#include "sim/kernels/implicit.h"
#include "sim/kernels/simd.h"
#include "sim/seeding/flow.h"
#include "sim/shapes/collider.h"
#include "sim/shapes/distance_field.h"
#include "sim/types/energy_account.h"
#include "sim/types/errors.h"
#include "sim/types/grid_fields.h"
#include "sim/types/particle_arrays.h"
#include "sim/types/reports.h"
#include "sim/types/settings.h"

namespace neve::sim::engine {

/// Memory for kernels: aligned to a cache line, never shrinks, not initialised.
template <class Real>
class LaneBuffer {
 public:
  LaneBuffer() = default;
  LaneBuffer(const LaneBuffer&) {}  // scratch: a copied engine makes its own
  LaneBuffer& operator=(const LaneBuffer&) = delete;

  Quad<Real>* at_least(std::size_t quads) {
    if (quads > capacity_) {
      capacity_ = quads + quads / 4;
      data_.reset();
      data_.reset(::operator new(capacity_ * 4 * sizeof(Real), alignment));
    }
    return static_cast<Quad<Real>*>(data_.get());
  }
  std::size_t bytes() const { return capacity_ * 4 * sizeof(Real); }

 private:
  static constexpr std::align_val_t alignment{64};
  struct Free {
    void operator()(void* p) const { ::operator delete(p, alignment); }
  };
  std::unique_ptr<void, Free> data_;
  std::size_t capacity_ = 0;
};

/// What energy the run may have: start, and what gravity and colliders put in.
struct EnergyBudget {
  double start = 0;         ///< J, kinetic and elastic; with that of snow that came, without that
                            ///< of snow that went
  double contact_work = 0;  ///< J, only what contacts added
  double largest = 0;       ///< J, the largest budget so far: the scale of the rule
  Vec3d moment{0, 0, 0};    ///< kg m, sum m x at the start, and of snow that came and went
};

/// Where particles stand in id order.
class Ranks {
 public:
  /// @param by_id may be empty: ids are ranks
  explicit Ranks(std::vector<std::uint32_t> by_id) : by_id_(std::move(by_id)) {}
  bool are_ids() const { return by_id_.empty(); }
  template <class Real>
  std::size_t operator[](const kernels::Particle<Real>& p) const {
    const auto id = static_cast<std::size_t>(p.id);
    return by_id_.empty() ? id : by_id_[id];
  }

 private:
  std::vector<std::uint32_t> by_id_;
};

/// Ids are signed words.
inline constexpr std::uint64_t max_ids = std::uint64_t(1) << 31;

/// A sweep over blocks [begin, end).
template <class Args>
using BlockSweep = void (*)(const Args&, std::uint32_t begin, std::uint32_t end);

template <class Real>
class Engine {
 public:
  Engine(const SolverSettings& settings, const std::vector<Material>& materials,
         const std::vector<shapes::Collider>& colliders, const ParticleArrays& particles,
         int threads, const Vec3i& lattice_origin, const seeding::Flow& flow);

  /// One step, then snow comes and goes.
  void step(double dt);
  AdvanceReport advance_to(double time, bool (*interrupted)(), std::size_t last_step);
  void apply(const SolverSettings& settings, const std::vector<Material>& materials,
             const std::vector<shapes::Collider>& colliders);
  std::vector<shapes::Collider> colliders() const;
  StagedStep staged_step(double dt) const;
  std::vector<std::uint8_t> save() const;
  /// @throws SavedStateError, and then is as it was
  void restore(std::span<const std::uint8_t> bytes);
  RasterizedNodes rasterize(const std::vector<std::vector<double>>& values) const;
  DtChoice choose_dt(double remaining) const;
  StepLimits step_limits() const;

  void set_dt_scale(double scale) { dt_scale_ = scale; }
  double dt_scale() const { return dt_scale_; }
  double time() const { return time_; }
  std::size_t steps() const { return steps_; }
  std::size_t particle_count() const { return particles_.size(); }
  const seeding::FlowTotals& flow_totals() const { return totals_; }
  kernels::SimdLevel simd() const { return simd_; }
  int threads() const { return pool_->thread_count(); }
  const std::optional<Divergence>& divergence() const { return divergence_; }
  const Warnings& warnings() const { return warnings_; }
  const SolveReport& last_solve() const { return last_solve_; }
  const PhaseSeconds& phase_seconds() const { return phase_seconds_; }
  std::uint64_t memory_bytes() const;

  Summary summary() const;
  EnergyAccount energy_account() const;
  ParticleArrays particles() const;
  std::vector<Mat3d> kirchhoff() const;
  std::vector<Vec3i> cells() const;
  std::uint64_t state_hash() const;

 private:
  void load(const ParticleArrays& in);
  void take_step(double dt);

  struct Stream {
    seeding::EmitterStream births;
    std::uint16_t material;
  };
  struct OpenSink {
    shapes::Solid solid;
    bool outside;
  };
  void open(const seeding::Flow& flow);
  void exchange();
  void emit();
  void remove_gone();
  bool is_time_to_look() const;
  bool may_remove(const OpenSink& sink, std::uint64_t block) const;
  kernels::Particle<Real> record_of(const seeding::Birth& birth, std::uint16_t material) const;
  void account_for(const kernels::Particle<Real>& p, double sign);
  double kinetic_energy_of(const kernels::Particle<Real>& p) const;
  double elastic_energy_of(const kernels::Particle<Real>& p) const;
  double affine_inertia() const;
  Ranks ranks() const;

  /// Where a particle is, m from the lattice origin.
  Vec3d place(const kernels::Particle<Real>& p) const;
  void prepare();
  /// @param channels of tiles and nodes
  kernels::SweepArgs<Real> args(double dt, int channels);
  /// Per collider; null but of meshes.
  using Fields = std::vector<std::shared_ptr<const shapes::DistanceField>>;
  Fields fields_of(const std::vector<shapes::Collider>& colliders) const;
  std::optional<kernels::ColliderPose> pose_of(const shapes::Collider& collider,
                                               const shapes::DistanceField* field) const;
  void place_colliders();
  void move_colliders();
  void end_step(double dt, kernels::SweepArgs<Real> a);
  /// How deep the deepest particle is in a collider, m; 0 where all are outside.
  double max_depth() const;
  void use_materials();
  void use_sweeps();
  void stress_anew(const std::vector<bool>& is_changed);
  void rebase_energy(const SolverSettings& before, const EnergyAccount& account,
                     const Summary& found);
  void partition();
  void sort_storage();
  /// Calls a sweep over particle blocks (weighted by particles) or node blocks, on all threads.
  template <class Args>
  void over_particle_blocks(BlockSweep<Args> sweep, const Args& a);
  template <class Args>
  void over_node_blocks(BlockSweep<Args> sweep, const Args& a);
  int active_threads() const;
  /// A step through the fused driver. @return false: the solve failed, nothing was changed
  bool take_fused(double dt, bool is_implicit);
  /// v_new from v_star on the nodes. @return false: no use, they have v_star as before
  bool solve_velocities(const kernels::SweepArgs<Real>& step, double dt);
  SolveReport conjugate_residuals(kernels::SolveArgs<Real>& a, double size);
  double tolerance() const;
  double over_nodes_summed(kernels::SolveSweep<Real> sweep, const kernels::SolveArgs<Real>& a);
  /// Explicit steps that take the place of one of dt.
  int explicit_parts(double dt) const;
  /// What rules those.
  DtLimit explicit_limit() const;
  void note(double dt);
  void remember(double dt, const kernels::BlockReport<Real>& report);
  kernels::BlockReport<Real> combined_report() const;
  void check(double dt, const StateLimits& before, const kernels::BlockReport<Real>& report);
  void check_energy();
  /// dt of the step that broke a rule, and the largest that speed and sound allowed before it.
  struct StepSizes {
    double taken, stable;
  };
  void diverge(const char* rule, const char* stage, const StepSizes& step, double value,
               double limit);
  /// What the stages leave behind.
  struct Traces {
    std::vector<kernels::StagedNodes<Real>> nodes;
    std::vector<kernels::Gathered<Real>> gathered;
    std::vector<Real> F_trial, v_before_collision;
    std::array<double, stage_names.size()> seconds{};  ///< see StagedStep
  };
  /// Whether the run itself has to.
  bool takes_stages() const { return settings_.takes_stages() || material_list_[0].yields; }
  void step_by_stages(double dt);
  void take_stages(double dt, Traces& traces);
  void deform(const kernels::SweepArgs<Real>& a);
  void read_back(const Traces& traces, StagedStep& out) const;

  SolverSettings settings_;
  std::vector<Material> material_list_;
  std::vector<kernels::MaterialConstants<Real>> materials_;
  std::vector<shapes::Collider> colliders_;
  Fields fields_;
  std::vector<kernels::ColliderPose> poses_;
  Vec3i lattice_origin_;
  std::shared_ptr<ThreadPool> pool_;
  kernels::SimdLevel simd_ = kernels::SimdLevel::baseline;
  const kernels::Sweeps<Real>* sweeps_ = nullptr;
  const kernels::SolveSweeps<Real>* solve_sweeps_ = nullptr;
  int kernel_nodes_ = kernels::cubic_nodes;

  std::vector<Stream> streams_;
  std::vector<OpenSink> sinks_;
  seeding::FlowTotals totals_;
  std::uint64_t steps_since_look_ = 0;  ///< for particles that are to go
  double way_since_look_ = 0;           ///< m, of the fastest particle of each step
  std::uint64_t next_id_ = 0;

  std::vector<kernels::Particle<Real>> particles_;
  Reordering<kernels::Particle<Real>> reordering_;
  std::vector<std::uint64_t> keys_;
  std::vector<std::uint16_t> locals_;
  Partition partition_;
  LaneBuffer<Real> tiles_, nodes_;
  LaneBuffer<Real> elasticity_, solve_vectors_;  ///< during a solve
  std::vector<double> products_;
  SolveReport last_solve_;
  std::vector<kernels::BlockReport<Real>> reports_;
  std::vector<double> node_contact_work_;

  double time_ = 0;
  double colliders_time_ = 0;  ///< s, that the poses are of: steps without them leave it behind
  std::size_t steps_ = 0;
  StateLimits limits_;
  double rest_dt_ = 0, last_dt_ = 0;
  double dt_scale_ = 1;
  DtLimit last_limit_ = DtLimit::fixed;  ///< of the step that is being taken
  StartState start_;
  /// The last steps, as a ring: the step with number n stands at n modulo its size.
  std::vector<StepRecord> last_steps_;
  /// The frame that advance_to is in: an interrupted one goes on as if nothing had happened.
  double frame_start_ = 0, frame_done_ = 0, frame_end_ = 0;
  EnergyBudget energy_;
  std::optional<Divergence> divergence_;
  Warnings warnings_;
  PhaseSeconds phase_seconds_;
};

template <class Real>
template <class Args>
void Engine<Real>::over_particle_blocks(BlockSweep<Args> sweep, const Args& a) {
  const int threads = active_threads(), parts = ThreadPool::parts_for(threads);
  pool_->run(threads, parts, [&](int part) {
    sweep(a, partition_.first_block(part, parts), partition_.first_block(part + 1, parts));
  });
}

template <class Real>
template <class Args>
void Engine<Real>::over_node_blocks(BlockSweep<Args> sweep, const Args& a) {
  pool_->ranges(partition_.node_blocks().size(), active_threads(),
                [&](std::size_t begin, std::size_t end) {
                  sweep(a, static_cast<std::uint32_t>(begin), static_cast<std::uint32_t>(end));
                });
}

}  // namespace neve::sim::engine

#pragma once
/// A snow simulation: particles in, steps, particles out. Knows no files and no graphics.

#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "sim/collider.h"
#include "sim/flow.h"
#include "sim/material.h"
#include "sim/settings.h"

namespace neve::sim {

/// Particles as plain arrays in id order, SI units. Empty optional arrays take their defaults.
struct ParticleArrays {
  std::vector<Vec3d> x;           ///< m, measured from the lattice origin
  std::vector<Vec3d> v;           ///< m/s
  std::vector<double> m;          ///< kg
  std::vector<double> V0;         ///< m3; empty or 0: estimated (the paper's step 2)
  std::vector<Mat3d> F_E;         ///< default I
  std::vector<double> J_P;        ///< det F_P, default 1
  std::vector<Mat3d> C;           ///< 1/s, APIC and MLS, default 0
  std::vector<int> material;      ///< index, default 0
  std::vector<double> stiffness;  ///< factor on mu and lambda, default 1
  std::vector<double> threshold;  ///< factor on theta_c and theta_s, default 1
  std::vector<std::uint32_t> id;  ///< increasing; default 0, 1, 2, ...

  std::uint32_t id_of(std::size_t index) const {
    return id.empty() ? static_cast<std::uint32_t>(index) : id[index];
  }
  /// Index of the first particle with at least this id; the number of particles if there is none.
  std::size_t first_from(std::uint64_t id) const;
  /// Index of a particle; nothing if it is not (any more) there.
  std::optional<std::size_t> index_of(std::uint64_t id) const;
  /// The material with the particle's own factors.
  Material material_of(std::size_t index, const std::vector<Material>& materials) const;
};

/// What limited a time step.
enum class DtLimit { max_dt, cfl, acoustic, strain, fixed, frame_end };
inline constexpr int dt_limit_count = 6;
const char* name(DtLimit limit);

/// Sums and extremes over all particles at one time.
struct Summary {
  double time = 0;
  std::size_t particles = 0;
  std::uint64_t emitted = 0, removed = 0;  ///< particles that came and went since the start
  double mass = 0;
  double kinetic_energy = 0, elastic_energy = 0;  ///< J
  Vec3d momentum{0, 0, 0}, centre_of_mass{0, 0, 0};
  Vec3d angular_momentum{0, 0, 0};  ///< about the lattice origin
  double max_speed = 0, min_J_P = 1, max_J_P = 1;
  double max_depth = 0;  ///< m, of the particle that is deepest in a collider
};

/// How well the velocities of semi-implicit steps were found.
struct SolveReport {
  int iterations = 0;   ///< of conjugate residuals
  double residual = 0;  ///< |v_star - (I + beta dt^2 M^-1 H) v_new| / |v_star|, weighted by mass
  std::size_t cut_short = 0;  ///< solves taken as they were after solve_iterations
  std::size_t given_up = 0;   ///< solves of no use: explicit steps in their place
  /// The worst of both, and how many of both ended early.
  void add(const SolveReport& other);
};

/// Steps taken by one call of advance_to.
struct AdvanceReport {
  std::size_t steps = 0;
  double dt_min = 0, dt_max = 0;
  std::array<std::size_t, dt_limit_count> ruled{};  ///< steps that each limit ruled
  DtLimit limit() const;                            ///< the one that ruled most
  std::optional<SolveReport> solve;                 ///< the worst; none of explicit steps
  /// Adds the steps that followed in the same frame.
  void append(const AdvanceReport& later);
};

/// One of the last steps before something went wrong; extremes are those at its end.
struct StepRecord {
  std::size_t step = 0;
  double time = 0, dt = 0;  ///< s; time is that of the end
  DtLimit limit = DtLimit::fixed;
  double max_speed = 0, max_sound_speed = 0;  ///< m/s
  double max_strain_rate = 0;                 ///< 1/s
  double min_J_P = 1, max_J_P = 1;
  std::size_t inverted = 0;  ///< trial det F_E <= 0
};

/// Extremes of the particles that a simulation was given.
struct StartState {
  double max_speed = 0, max_sound_speed = 0;  ///< m/s
  double min_J_E = 1, max_J_E = 1, min_J_P = 1, max_J_P = 1;
  std::int64_t strangest = -1;  ///< id of the particle whose F_E or J_P is furthest from rest, or
                                ///< is no number; -1: all are at rest
};

/// Why a run had to stop. Numerical trouble is data, not an exception.
struct Divergence {
  std::size_t step = 0;
  double time = 0;
  std::string stage;  ///< name of the stage that broke the rule
  std::string rule;   ///< energy, speed_cfl, acoustic_cfl, J_P, inverted, not_finite, overflow
  std::int64_t particle = -1;  ///< id of a culprit, -1 if none stands out
  int material = 0;            ///< of the culprit, like what follows
  Vec3d x{0, 0, 0}, v{0, 0, 0};
  Mat3d F_E = Mat3d::Identity();
  Mat3d kirchhoff = Mat3d::Zero();  ///< tau = P F_E^T, Pa
  Vec3d stretches{1, 1, 1};         ///< singular values of F_E
  double J_E = 1, J_P = 1;
  double sound_speed = 0;       ///< m/s, hardened
  double value = 0, limit = 0;  ///< what was found and what the rule allows
  double dt = 0, dt_that_holds = 0;
  std::vector<std::uint32_t> culprits;  ///< ids, at most 1000
  std::vector<StepRecord> last_steps;   ///< oldest first, the broken one last
  StartState start;
  std::string what;      ///< one line for people
  std::string sentence;  ///< with the dt that would have held
};

/// What was noticed but did not stop the run.
struct Warnings {
  std::size_t inverted_trials = 0;   ///< trial det F_E <= 0, repaired by the projection
  double worst_acoustic_cfl = 0;     ///< of fixed steps
  std::size_t solves_cut_short = 0;  ///< taken as they were after solve_iterations
  std::size_t solves_given_up = 0;   ///< of no use: explicit steps in their place
};

/// Seconds spent in each phase of the steps so far.
struct PhaseSeconds {
  double partition = 0;          ///< particles to blocks
  double particles_to_grid = 0;  ///< rasterize, elastic_forces
  double grid_update = 0;        ///< grid_velocities, grid_collisions
  double solve = 0;              ///< implicit_solve
  double grid_to_particles = 0;  ///< deformation to advection
  double checks = 0;             ///< limits of the next dt, rules of a healthy run
};

/// Bytes that are no saved state; what() says why.
struct SavedStateError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

class Simulation {
 public:
  /// @param flow snow that comes and goes; emitters and sinks stay as they are
  /// @param lattice_origin in blocks of 4 cells; x is measured from it. Moving it changes no bit of
  ///        the result but the cells.
  /// @throws std::invalid_argument when arrays disagree in length or hold non-finite numbers
  /// @throws ShapeError for emitters and sinks without a volume
  Simulation(const SolverSettings& settings, const std::vector<Material>& materials,
             const std::vector<Collider>& colliders, const ParticleArrays& particles,
             int threads = 0, const Vec3i& lattice_origin = Vec3i::Zero(), const Flow& flow = {});
  ~Simulation();
  Simulation(Simulation&&) noexcept;
  Simulation& operator=(Simulation&&) noexcept;

  double time() const;
  std::size_t steps() const;
  std::size_t particle_count() const;
  FlowTotals flow_totals() const;
  int threads() const;
  const char* simd() const;
  PhaseSeconds phase_seconds() const;

  /// Bytes held by particles, grid and buffers.
  std::uint64_t memory_bytes() const;

  /// One step of exactly dt seconds through the fused driver.
  void step(double dt);

  /// Steps chosen by the settings until `time` is reached, ending on it exactly. Stops early on
  /// divergence, after a step when `interrupted` (polled, may be null) returns true, or when
  /// steps() has reached `last_step`; called again with the same time it goes on as if it had not
  /// stopped.
  AdvanceReport advance_to(double time, bool (*interrupted)() = nullptr,
                           std::size_t last_step = std::numeric_limits<std::size_t>::max());

  /// Goes on with other parameters: between steps, whatever needs no restart. Settings but
  /// cell_size, precision and period; materials but their number and density; colliders, also more
  /// or fewer of them. Position, velocity, F_E and J_P of the particles stay; what is derived from
  /// them (stress, limits of the next step) is worked out anew, and the energy that the change put
  /// in or took out is accounted for, so that no change alone breaks a rule.
  ///
  /// C starts from zero when the transfer changes from or to FLIP, which has none, and stays
  /// between APIC and MLS. A collider keeps its place when its velocity or spin changes, moves by
  /// the edit when its place in the scene changes, and is the one of the same name (of several the
  /// one of the same number); a new one stands where it says and moves from now on. The travel of
  /// the colliders given is not looked at.
  ///
  /// Values that are all as before change no bit of the run. save() holds what the change left
  /// behind: restore() into a simulation built with the present parameters goes on to the bit.
  /// @throws std::invalid_argument for what needs a restart; nothing has changed then
  /// @throws std::logic_error after a divergence: first restore() a state from before it
  void apply(const SolverSettings& settings, const std::vector<Material>& materials,
             const std::vector<Collider>& colliders);

  /// As they are now: pose_at(collider, time()) is where each stands.
  std::vector<Collider> colliders() const;

  /// The dt that the settings would choose now, and which limit rules it.
  struct Choice {
    double dt;
    DtLimit limit;
  };
  Choice choose_dt(double remaining) const;

  /// What each limit would allow now, whatever the settings say about fixed steps, and why.
  struct StepLimits {
    std::array<double, dt_limit_count> dt{};  ///< s; infinite where a limit says nothing
    double max_speed = 0;                     ///< m/s
    double max_sound_speed = 0;               ///< m/s, of the stiffest particle, hardened
    double max_strain_rate = 0;               ///< 1/s
  };
  StepLimits step_limits() const;

  /// Set once a rule of a healthy run was broken.
  const std::optional<Divergence>& divergence() const;
  const Warnings& warnings() const;
  /// Of the last step, if it was semi-implicit.
  SolveReport last_solve() const;

  Summary summary() const;

  /// All particles in id order. Volumes that are to be estimated are known from the start: the
  /// mass on the grid before the first step is all that they need.
  ParticleArrays particles() const;

  /// Kirchhoff stress tau = P F_E^T in Pa, id order.
  std::vector<Mat3d> kirchhoff() const;

  /// Cell of each particle (lattice units, absolute) and offset in it, id order.
  std::vector<Vec3i> cells() const;

  /// Commutative sum of per-particle hashes keyed by id; cells enter relative to the lattice
  /// origin.
  std::uint64_t state_hash() const;

  /// The state as bytes, for the same program and machine: a simulation with the same settings,
  /// materials and colliders that restores them takes the same steps to the bit.
  std::vector<std::uint8_t> save() const;

  /// @throws SavedStateError when the bytes are no state of such a simulation; it is then as before
  void restore(std::span<const std::uint8_t> bytes);

  /// Factor of every dt that the settings choose from now on, (0, 1]: a run that broke a rule goes
  /// on more carefully.
  void set_dt_scale(double scale);
  double dt_scale() const;

  struct Impl;

 private:
  friend struct InsideAccess;
  std::unique_ptr<Impl> impl_;
};

/// Bytes that a simulation of so many particles needs, grid and buffers included. An estimate from
/// above for packed snow; computed before anything is allocated.
std::uint64_t estimate_memory(std::size_t particles, double particles_per_cell,
                              const SolverSettings& settings, int threads);

}  // namespace neve::sim

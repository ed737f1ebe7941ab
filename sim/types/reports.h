#pragma once
/// Reports of a simulation about its steps and its state.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "sim/types/dust.h"
#include "sim/types/math.h"

namespace neve::sim {

/// Limit of a time step.
enum class DtLimit { max_dt, cfl, acoustic, strain, fixed, frame_end, collider };
inline constexpr int dt_limit_count = 7;
const char* name(DtLimit limit);

/// The dt that the settings would choose now, and which limit rules it.
struct DtChoice {
  double dt;
  DtLimit limit;
};

/// dt that each limit allows now, also with fixed steps, and the reasons.
struct StepLimits {
  std::array<double, dt_limit_count> dt{};  ///< s; infinite where a limit says nothing
  double max_speed = 0;                     ///< m/s
  double max_sound_speed = 0;               ///< m/s, of the stiffest particle, hardened
  double max_strain_rate = 0;               ///< 1/s
  double max_collider_speed = 0;            ///< m/s, of colliders that snow may meet
};

/// Sums and extremes over all particles at one time.
struct Summary {
  double time = 0;
  std::size_t particles = 0;
  std::uint64_t emitted = 0, removed = 0;  ///< particles that came and went since the start
  std::uint64_t withheld = 0;              ///< particles of emitters that found no room so far
  std::size_t grid_blocks = 0;             ///< of 4^3 nodes that the snow reaches
  double mass = 0;
  double kinetic_energy = 0, elastic_energy = 0;  ///< J
  double affine_energy = 0;                       ///< J, of the kinetic energy: in C
  Vec3d momentum{0, 0, 0}, centre_of_mass{0, 0, 0};
  Vec3d angular_momentum{0, 0, 0};  ///< about the lattice origin
  double max_speed = 0, min_J_P = 1, max_J_P = 1;
  double packed = 0;  ///< share of the mass of snow that is packed as far as Law::packed allows
  double denser_than_ice = 0;  ///< the same share, by its density without elastic strain
  double max_depth = 0;        ///< m, of the particle that is deepest in a collider
  /// Pa, per collider: the most that snow within a cell of its surface presses on it, -n sigma n
  /// with the Cauchy stress sigma of a particle; 0 where it only pulls.
  std::vector<double> max_pressure;
  DustTotals dust;  ///< of no part in the sums above
};

/// Accuracy of the velocities of semi-implicit steps.
struct SolveReport {
  int iterations = 0;  ///< of conjugate residuals
  /// |v_star - (I + beta dt^2 M^-1 H) v_new|, weighted by mass, over the same norm of v_star less
  /// the velocity of the centre of mass and of what gravity adds in the step; no number where every
  /// solve was given up
  double residual = 0;
  std::size_t solves = 0;            ///< also those of no use; steps without snow have none
  std::size_t cut_short = 0;         ///< solves taken as they were after solve_iterations
  std::size_t given_up = 0;          ///< solves of no use: shorter steps in their place
  std::uint64_t all_iterations = 0;  ///< of all solves
  /// The worst of both, all iterations, and how many of both ended early.
  void add(const SolveReport& other);
};

/// Contact of snow with a collider over some steps. Divided by their time: force and torque.
struct ColliderLoad {
  Vec3d impulse{0, 0, 0};  ///< on the collider, N s
  /// N m s, about the point of the collider's shape as it moves (of a box: its centre).
  Vec3d angular_impulse{0, 0, 0};
};

/// Steps taken by one call of advance_to.
struct AdvanceReport {
  std::size_t steps = 0;
  double dt_min = 0, dt_max = 0;
  std::array<std::size_t, dt_limit_count> ruled{};  ///< steps that each limit ruled
  DtLimit limit() const;                            ///< the one that ruled most
  std::optional<SolveReport> solve;                 ///< the worst; empty in explicit steps
  double seconds = 0;                               ///< of all steps
  std::vector<ColliderLoad> loads;                  ///< per collider; empty before the first step
  double max_force() const;  ///< N, mean over the steps, on the collider that snow presses most
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
  std::int64_t worst_particle = -1;  ///< id of the particle whose F_E or J_P is furthest from rest,
                                     ///< or is no number; -1: all are at rest
};

/// Reason for which a run had to stop. Numerical trouble is data, not an exception.
struct Divergence {
  std::size_t step = 0;
  double time = 0;
  std::string stage;           ///< name of the stage that broke the rule
  std::string rule;            ///< energy, speed_cfl, acoustic_cfl, J_P, packed, inverted, ...
  std::int64_t particle = -1;  ///< id of a culprit, -1 if unknown
  int material = 0;            ///< of the culprit, like the members below
  Vec3d x{0, 0, 0}, v{0, 0, 0};
  Mat3d F_E = Mat3d::Identity();
  Mat3d kirchhoff = Mat3d::Zero();  ///< tau = P F_E^T, Pa
  Vec3d stretches{1, 1, 1};         ///< singular values of F_E
  double J_E = 1, J_P = 1;
  double sound_speed = 0;       ///< m/s, hardened
  double value = 0, limit = 0;  ///< value found, and value allowed by the rule
  double dt = 0, dt_that_holds = 0;
  std::vector<std::uint32_t> culprits;  ///< ids, at most 1000
  std::vector<StepRecord> last_steps;   ///< oldest first, the broken one last
  StartState start;
  std::string what;      ///< one line for the user
  std::string sentence;  ///< with the dt that would have held
};

/// Rules that stop a run. The first two stop it even where rules are ignored: there is no number,
/// or no place, to continue with.
inline constexpr std::array<std::string_view, 9> stop_rules{
    "not_finite",   "overflow",  "speed_cfl", "inverted", "J_P",
    "acoustic_cfl", "time_step", "energy",    "packed"};
constexpr bool is_final_rule(std::string_view rule) {
  return rule == stop_rules[0] || rule == stop_rules[1];
}

/// Events that did not stop the run.
struct Warnings {
  std::size_t rules_ignored = 0;       ///< steps, or sums over the snow, that broke a rule
  std::size_t first_ignored = 0;       ///< step of the first of them
  std::size_t first_ignored_rule = 0;  ///< its place in stop_rules
  std::size_t inverted_trials = 0;     ///< trial det F_E <= 0, repaired by the projection
  double worst_acoustic_cfl = 0;       ///< of fixed steps
  std::size_t solves_cut_short = 0;    ///< taken as they were after solve_iterations
  std::size_t solves_given_up = 0;     ///< of no use: shorter steps in their place
  double least_J_P = 1;                ///< of the most packed particle so far
};

/// Seconds spent in each phase of the steps so far.
struct PhaseSeconds {
  double partition = 0;          ///< particles to blocks
  double particles_to_grid = 0;  ///< rasterize, elastic_forces
  double grid_update = 0;        ///< grid_velocities, grid_collisions
  double solve = 0;              ///< implicit_solve
  double grid_to_particles = 0;  ///< deformation to advection
  double checks = 0;             ///< limits of the next dt, rules of a healthy run
  double dust = 0;               ///< air and dust, where there is any

  double total() const {
    return partition + particles_to_grid + grid_update + solve + grid_to_particles + checks + dust;
  }
};

}  // namespace neve::sim

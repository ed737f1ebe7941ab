#pragma once
/// Parameters of the time integration. Defaults are the paper's method where no sweep has found a
/// better one: docs/transfers.md and docs/time_step.md say which.

#include <algorithm>
#include <vector>

#include "sim/types/dust.h"
#include "sim/types/math.h"
#include "sim/types/stage.h"

namespace neve::sim {

enum class Kernel { cubic, quadratic };
/// The last two are FLIP with an affine velocity; ASFLIP also lets separating snow go.
enum class Transfer { flip, apic, mls, aflip, asflip };
enum class Advect { particle, pic };
/// Points that a step stops at colliders: particles, by impulses through the grid, or nodes, as in
/// the paper.
enum class ContactAt { particles, nodes };
enum class TimeStep { adaptive, fixed };
/// Reaction to a broken rule: end the run, go back and try with half the dt, or continue anyway
/// while there are numbers to continue with.
enum class OnDivergence { stop, retry, ignore };
enum class Precision { single, real64 };  ///< written "float" and "double" in scenes

struct SolverSettings {
  double cell_size = 0.02;  ///< h, m
  /// m, of the cells that thresholds of snow were meant for; 0: of any. See threshold_cell.h.
  double threshold_cell = 0;
  Kernel kernel = Kernel::cubic;  ///< B-spline of the transfers
  /// The velocity that moves the snow also strains it. The paper's `flip` moves particles by a
  /// velocity that the grid does not see, and their places part from F.
  Transfer transfer = Transfer::asflip;
  double flip_ratio = 0.95;         ///< the paper's alpha
  double flip_reference_dt = 5e-4;  ///< s; 0: alpha acts per step, as in the paper
  /// Velocity that moves particles: v_p (paper) or the grid's; AFLIP and ASFLIP know themselves.
  Advect advect = Advect::particle;
  /// ASFLIP: shares of a particle's own velocity that it moves with, compressed and separating, and
  /// J_E from which it separates.
  double separation_min = 0, separation_max = 1, separation_J_E = 0.999;
  /// Share of the artificial viscosity that spreads shocks in snow over cells; 0: the paper.
  double shock_viscosity = 1;
  ContactAt contact_at = ContactAt::particles;
  TimeStep time_step = TimeStep::adaptive;
  double dt = 2e-4;                  ///< s; used by fixed steps
  double max_dt = 1e-3;              ///< s; adaptive
  double cfl = 0.4;                  ///< |v| dt / h
  double acoustic_cfl = 0.5;         ///< c dt / h with the hardened c
  double strain_limit = 0.3;         ///< |dt grad v|
  double beta = 0.0;                 ///< 0: explicit; (0, 1]: the paper's semi-implicit step
  double solve_tolerance = 1e-2;     ///< of the solve for v_new: see SolveReport::residual
  int solve_iterations = 50;         ///< of the solve, at most
  bool collide_after_solve = false;  ///< nodes meet colliders again, after the solve
  /// Particles deeper than a tenth of a cell in a collider are moved out to there after the step,
  /// velocities and deformation kept. The paper leaves them where they are.
  bool push_out = false;
  Vec3d gravity{0.0, -9.81, 0.0};  ///< m/s2
  Precision precision = Precision::single;
  OnDivergence on_divergence = OnDivergence::stop;
  DustSettings dust;
  /// Stages to skip while debugging; the run then takes the staged driver, and its energy is not
  /// watched. Without rasterize the grid stays empty; explicit steps have no solve to skip.
  std::vector<Stage> bypass;
  /// Least number of passes of contact at particles in an explicit step. They begin where the last
  /// step ended: loads that stay are carried whole, and an impact, a press and a rebound come out
  /// as with a hundred passes, within a percent. For verification; no scene key.
  int contact_passes = 2;
  /// kg; nodes of at most this mass rest and feel no force. For comparison with solvers that have
  /// such a rule; no scene key. Above 0 the run takes the staged driver.
  double resting_mass = 0;
  /// Period of the lattice, in blocks of 4 cells per axis, 0: open. For verification by waves and
  /// manufactured solutions; no scene key. Places stay unwrapped, and contact ignores the seam:
  /// only planes along the periodic axes make sense.
  Vec3i period{0, 0, 0};

  bool has_affine_velocity() const { return transfer != Transfer::flip; }
  bool has_affine_and_own_velocity() const {
    return transfer == Transfer::aflip || transfer == Transfer::asflip;
  }
  bool takes_stages() const { return !bypass.empty() || resting_mass > 0; }
  bool is_contact_at_particles() const { return contact_at == ContactAt::particles; }
  bool is_implicit() const { return beta > 0 && !skips(Stage::implicit_solve); }
  bool skips(Stage stage) const {
    return std::find(bypass.begin(), bypass.end(), stage) != bypass.end();
  }
};

}  // namespace neve::sim

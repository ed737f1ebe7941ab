#pragma once
/// The laws of a healthy run in one table, and where each of its readers draws the line.
///
/// `neve check` reads the scene before it runs, `--validate` looks at the state between steps, the
/// engine stops a run, the diagnosis looks for the cause of a stop, and dumps mark values that they
/// did not expect. Each asks its own question, so the same law has a column for each of them.

#include <array>
#include <cstddef>
#include <limits>

namespace neve::sim::health {

/// The laws: --validate watches the first two groups, those of the user's choices and those of the
/// solver itself.
enum class Law {
  acoustic_cfl,  ///< c dt/h with the hardened c
  speed_cfl,     ///< |v| dt/h
  strain_step,   ///< |dt grad v|, largest entry
  inverted,      ///< det F_E
  not_finite,    ///< particles whose state is no number
  compaction,    ///< smallest J_P
  dilation,      ///< largest J_P
  hardening,     ///< e^(xi (1 - J_P))
  mach,          ///< |v| over the speed of sound
  energy,        ///< EnergyAccount::ratio
  places,        ///< det F over the volume that particles take, or its inverse
  force_sum,     ///< |sum f| / sum |f|
  torque,        ///< |sum x x f| / sum |x x f|
  newton,        ///< m dv against dt (f + m g) on nodes
  power,         ///< power of the forces against the stress power of the particles
  work,          ///< elastic energy of the trial state against trapezoidal work
  mass,          ///< mass on the grid against that of the particles
  p2g_momentum,  ///< particles to grid
  g2p_momentum,  ///< grid to particles

  overflow,            ///< particles beyond the lattice
  time_step,           ///< dt over that of snow at rest
  small_J_E,           ///< det F_E of the start, smallest
  large_J_E,           ///< the same, largest
  impact_mach,         ///< speed of snow at impact over that of its sound
  collider_mach,       ///< speed of a collider over that of sound
  collider_cfl,        ///< speed of a collider, dt/h
  low_density,         ///< kg/m3
  high_density,        ///< kg/m3
  low_stiffness,       ///< Pa, youngs_modulus
  high_stiffness,      ///< Pa, youngs_modulus
  poisson_ratio,       ///< near 0.5 what compresses locks
  gravity,             ///< m/s2
  extent,              ///< m, of a piece of snow
  particles_per_cell,  ///< fewer leave gaps
  light_node,          ///< mass over rho h^3: lighter nodes have velocities that mean nothing
  packed,              ///< share of the snow at J_P <= packed_J_P
};
inline constexpr std::size_t law_count = 36;
inline constexpr int watched_laws = 19;

/// A reader that draws no line at a law: no value is beyond it.
inline constexpr double no_line = std::numeric_limits<double>::quiet_NaN();
/// The line of checks that warn and never fail.
inline constexpr double never = std::numeric_limits<double>::infinity();

/// Thresholds of the readers of a law, and their words.
struct Limits {
  Law law;
  const char* name;
  const char* quantity;
  bool is_below = false;           ///< broken below its lines, not above
  double check_warning = no_line;  ///< neve check: worth a warning
  double check_error = no_line;    ///< neve check: the run will explode
  double watch_warning = no_line;  ///< --validate: worth a warning
  double watch_error = never;      ///< --validate: wrong, the run fails
  double watch_single = no_line;   ///< both in single precision, where rounding is the line
  double stop = no_line;           ///< the engine stops the run
  double mention = no_line;        ///< the message of another stop tells it too
  double at_start = no_line;  ///< the diagnosis: a cause, in the state that the run started from
  double cause = no_line;     ///< the diagnosis: a cause, in the settings and the last steps
  double expected = no_line;  ///< dumps and the inspector: beyond it is not expected
  const char* meaning = "";   ///< of a watched law that is broken
  const char* remedy = "";    ///< %dt: the step that would do
};

/// Lines of the first group are those of the step limits and of experience with runs that went
/// wrong, those of the second are rounding.
inline constexpr std::array<Limits, law_count> laws = {{
    {.law = Law::acoustic_cfl,
     .name = "acoustic_cfl",
     .quantity = "the acoustic CFL c dt/h",
     .check_warning = 0.5,
     .check_error = 1.5,
     .watch_warning = 0.5,
     .watch_error = 1,
     .stop = 1.5,
     .mention = 0.7,
     .at_start = 0.9,
     .cause = 1,
     .meaning = "sound crosses too much of a cell in a step; hardened snow is the stiffest",
     .remedy = "use dt = %dt, or adaptive steps"},
    {.law = Law::speed_cfl,
     .name = "speed_cfl",
     .quantity = "the CFL number |v| dt/h",
     .check_warning = 0.5,
     .check_error = 1,
     .watch_warning = 0.5,
     .watch_error = 1,
     .stop = 1,
     .at_start = 0.9,
     .cause = 0.9,
     .meaning = "particles cross too much of a cell in a step",
     .remedy = "use dt = %dt, or adaptive steps"},
    {.law = Law::strain_step,
     .name = "strain_step",
     .quantity = "|dt grad v|",
     .watch_warning = 0.4,
     .cause = 1,
     .meaning = "the deformation of a step is no longer small; inversion comes next",
     .remedy = "use dt = %dt, or adaptive steps"},
    {.law = Law::inverted,
     .name = "inverted",
     .quantity = "the smallest det F_E",
     .is_below = true,
     .watch_warning = 0,
     .watch_error = 0,
     .stop = 0,
     .meaning = "a particle is turned inside out",
     .remedy = "a smaller dt, or a softer material"},
    {.law = Law::not_finite,
     .name = "not_finite",
     .quantity = "the number of particles that are not finite",
     .watch_warning = 0,
     .watch_error = 0,
     .stop = 0,
     .meaning = "the run has diverged",
     .remedy = "a smaller dt; neve check names the limits"},
    {.law = Law::compaction,
     .name = "compaction",
     .quantity = "the smallest J_P",
     .is_below = true,
     .watch_warning = 0.2,
     .stop = 0.1,
     .at_start = 0.5,
     .expected = 0.2,
     .meaning = "snow is packed to a fifth of its volume: it is too soft for its impact",
     .remedy = "a larger youngs_modulus or hardening, or less speed"},
    {.law = Law::dilation,
     .name = "dilation",
     .quantity = "the largest J_P",
     .watch_warning = 1000,
     .at_start = 2,
     .expected = 1000,
     .meaning = "snow is stretched to a thousand times its volume: particles fly apart",
     .remedy = "a larger critical_stretch, or a smaller dt"},
    {.law = Law::hardening,
     .name = "hardening",
     .quantity = "the hardening e^(xi (1 - J_P))",
     .watch_warning = 1000,
     .cause = 100,
     .meaning = "snow has become a thousand times as stiff; steps become short",
     .remedy = "less hardening (xi), or a smaller critical_compression"},
    {.law = Law::mach,
     .name = "mach",
     .quantity = "the speed relative to sound",
     .watch_warning = 1,
     .meaning = "snow moves faster than sound in it: a shock, or an ejected particle",
     .remedy = "inspect the fastest particles; use a stiffer material or a slower start"},
    // A tenth is left to the coarse accounting of contacts and to the error of a step.
    {.law = Law::energy,
     .name = "energy",
     .quantity = "the energy relative to that of start, gravity and colliders",
     .watch_warning = 1.1,
     .watch_error = 1.1,
     .stop = 1.1,
     .meaning = "snow can only lose energy, but the steps add some",
     .remedy = "a smaller dt"},
    // Packed snow that moves as it is strained is within 1.1, and 1.14 behind a plate at 60 m/s;
    // the paper's way to move particles ends at 1.2 to 1.7 in any impact.
    {.law = Law::places,
     .name = "places",
     .quantity = "the volume that F believes in against that of the places of packed particles",
     .watch_warning = 1.2,
     .meaning = "snow moves by a velocity that does not strain it, so its stress and its packing "
                "are not those of where it is",
     .remedy = "transfer = \"asflip\", or advect = \"pic\" with flip"},
    {.law = Law::force_sum,
     .name = "force_sum",
     .quantity = "|sum f| / sum |f|",
     .watch_warning = 1e-9,
     .watch_error = 1e-9,
     .watch_single = 1e-4,
     .meaning = "internal forces do not cancel: gradients of the weights are wrong",
     .remedy = "this is an error in neve: please report it"},
    {.law = Law::torque,
     .name = "torque",
     .quantity = "|sum x x f| / sum |x x f|",
     .watch_warning = 1e-7,
     .watch_error = 1e-7,
     .watch_single = 1e-4,
     .meaning = "internal forces turn the body: the stress is not symmetric",
     .remedy = "this is an error in neve: please report it"},
    {.law = Law::newton,
     .name = "newton",
     .quantity = "m dv - dt (f + m g) on nodes",
     .watch_warning = 1e-9,
     .watch_error = 1e-9,
     .watch_single = 1e-5,
     .meaning = "the grid's velocity does not follow from its forces",
     .remedy = "this is an error in neve: please report it"},
    {.law = Law::power,
     .name = "power",
     .quantity = "power of the forces against power of the stress",
     .watch_warning = 1e-6,
     .watch_error = 1e-6,
     .watch_single = 1e-2,
     .meaning = "forces and the update of F_E are inconsistent: a side, a sign, 1/h, J or V0",
     .remedy = "this is an error in neve: please report it"},
    {.law = Law::work,
     .name = "work",
     .quantity = "change of the elastic energy against work",
     .watch_warning = 0.05,
     .meaning = "the energy of a step does not match the work of its forces: dt is too large for "
                "the stiffness",
     .remedy = "a smaller dt"},
    {.law = Law::mass,
     .name = "mass",
     .quantity = "mass on the grid against that of the particles",
     .watch_warning = 1e-9,
     .watch_error = 1e-9,
     .watch_single = 1e-5,
     .meaning = "nodes or particles are lost",
     .remedy = "this is an error in neve: please report it"},
    {.law = Law::p2g_momentum,
     .name = "p2g_momentum",
     .quantity = "momentum, particles to grid",
     .watch_warning = 1e-9,
     .watch_error = 1e-9,
     .watch_single = 1e-5,
     .meaning = "the transfer loses momentum",
     .remedy = "this is an error in neve: please report it"},
    {.law = Law::g2p_momentum,
     .name = "g2p_momentum",
     .quantity = "momentum, grid to particles",
     .watch_warning = 1e-9,
     .watch_error = 1e-9,
     .watch_single = 1e-5,
     .meaning = "the transfer loses momentum, or FLIP uses the wrong difference",
     .remedy = "this is an error in neve: please report it"},

    {.law = Law::overflow,
     .name = "overflow",
     .quantity = "the number of particles beyond the lattice",
     .stop = 0},
    // This is no law of stability: without it a run that hardens without end would never end.
    {.law = Law::time_step,
     .name = "time_step",
     .quantity = "dt relative to snow at rest",
     .is_below = true,
     .stop = 1e-4},
    {.law = Law::small_J_E,
     .name = "small_J_E",
     .quantity = "the smallest det F_E of the start",
     .is_below = true,
     .at_start = 0.5},
    {.law = Law::large_J_E,
     .name = "large_J_E",
     .quantity = "the largest det F_E of the start",
     .at_start = 2},
    {.law = Law::impact_mach,
     .name = "impact_mach",
     .quantity = "the speed at impact relative to sound",
     .check_warning = 1,
     .cause = 1.5},
    {.law = Law::collider_mach,
     .name = "collider_mach",
     .quantity = "the speed of a collider relative to sound",
     .check_warning = 1,
     .cause = 1},
    {.law = Law::collider_cfl,
     .name = "collider_cfl",
     .quantity = "cells that a collider crosses in a step",
     .check_warning = 0.5,
     .cause = 0.5},
    {.law = Law::low_density,
     .name = "low_density",
     .quantity = "density, kg/m3",
     .is_below = true,
     .check_warning = 20,
     .cause = 20},
    // Ice has 917.
    {.law = Law::high_density,
     .name = "high_density",
     .quantity = "density, kg/m3",
     .check_warning = 1.3 * 917},
    {.law = Law::low_stiffness,
     .name = "low_stiffness",
     .quantity = "youngs_modulus, Pa",
     .is_below = true,
     .check_warning = 2000},
    {.law = Law::high_stiffness,
     .name = "high_stiffness",
     .quantity = "youngs_modulus, Pa",
     .check_warning = 1e8,
     .cause = 1e6},
    {.law = Law::poisson_ratio,
     .name = "poisson_ratio",
     .quantity = "poisson_ratio",
     .cause = 0.45},
    // These two are lines beyond which numbers look like centimetres.
    {.law = Law::gravity,
     .name = "gravity",
     .quantity = "gravity, m/s2",
     .check_warning = 60,
     .cause = 60},
    {.law = Law::extent,
     .name = "extent",
     .quantity = "the largest piece of snow, m",
     .check_warning = 20,
     .cause = 20},
    {.law = Law::particles_per_cell,
     .name = "particles_per_cell",
     .quantity = "particles per cell",
     .is_below = true,
     .check_warning = 4},
    {.law = Law::light_node,
     .name = "light_node",
     .quantity = "the mass of a node over rho h^3",
     .is_below = true,
     .expected = 1e-4},
    // Some particles of an impact may be crushed; snow that is has no room, or no stiffness.
    {.law = Law::packed,
     .name = "packed",
     .quantity = "the share of the snow that is packed to a tenth of its volume",
     .stop = 0.1},
}};

constexpr const Limits& limits_of(Law law) {
  return laws[static_cast<std::size_t>(law)];
}

constexpr const char* name(Law law) {
  return limits_of(law).name;
}
/// Name of the compared number, for the user.
constexpr const char* quantity(Law law) {
  return limits_of(law).quantity;
}
/// Meaning of a broken law, for the user; empty if --validate does not measure it.
constexpr const char* meaning(Law law) {
  return limits_of(law).meaning;
}

/// Snow is packed as far as it may be, within rounding of float: below, the law of compaction stops
/// the run; the default range of J_P ends here.
inline constexpr double packed_J_P = limits_of(Law::compaction).stop * (1 + 1e-6);

/// Share of the energy of affine velocities that may be traded in aflip and asflip: transfers keep
/// the momentum that those share with particles' own velocities, not its energy. A ball of one
/// cell's radius that spins has as much energy in each, and gains 0.28 of one, at any dt; a tenth
/// of the whole is allowed anyway. Check: Divergence.AThinBodyMaySpinInEveryTransfer
inline constexpr double traded_share = 0.25;

/// False for no_line, which is NaN.
constexpr bool is_line(double value) {
  return value == value;
}

/// True if each law has its own row and the watched ones come first.
constexpr bool is_in_order() {
  for (std::size_t k = 0; k < law_count; ++k) {
    const bool is_watched = is_line(laws[k].watch_warning);
    if (static_cast<std::size_t>(laws[k].law) != k || is_watched != (k < watched_laws))
      return false;
  }
  return true;
}
static_assert(is_in_order());

}  // namespace neve::sim::health

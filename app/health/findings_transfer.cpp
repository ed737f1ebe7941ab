/// Findings about the transfer between particles and grid: what it damps, and what it moves.

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "app/health/findings.h"
#include "app/setup/snow_pieces.h"
#include "app/support/text.h"
#include "sim/types/time_step.h"

namespace neve::app::health {

namespace {

constexpr const char* keeps_turning = "transfer = \"asflip\" or \"aflip\" keeps them turning";

bool has_flip_ratio(sim::Transfer transfer) {
  return transfer != sim::Transfer::apic && transfer != sim::Transfer::mls;
}

/// Share of the motion of a cell or less that a frame leaves.
double kept_after(double seconds, const sim::SolverSettings& s, const Check& check) {
  const double steps = std::max(1.0, seconds / std::max(check.dt_start, 1e-12));
  return std::pow(sim::flip_share(s, seconds / steps), steps);
}

void check_damping(const scene::Scene& scene, const Check& check, std::vector<Finding>& findings) {
  const sim::SolverSettings& s = scene.solver;
  if (!has_flip_ratio(s.transfer)) return;
  const double frame = 1 / scene.fps;
  const double kept = kept_after(frame, s, check);
  if (s.flip_reference_dt == 0)
    findings.push_back(
        {Severity::warning, "solver.flip_reference_dt",
         fmt::format("flip_ratio acts per step: with about {} steps a frame {} of "
                     "the finest motion is left after a frame, and less with smaller "
                     "steps",
                     rough_text(std::max(1.0, frame / std::max(check.dt_start, 1e-12))),
                     percent_text(kept)),
         "flip_reference_dt = 5e-4 makes damping independent of dt"});
  // The defaults are no news.
  const sim::SolverSettings usual;
  const bool is_usual =
      s.flip_ratio == usual.flip_ratio && s.flip_reference_dt == usual.flip_reference_dt;
  if (s.flip_reference_dt == 0 || is_usual) return;
  const bool stops = s.transfer == sim::Transfer::flip && s.flip_ratio < 1;
  findings.push_back({Severity::note, "solver.flip_ratio",
                      percent_text(kept) +
                          " of the finest motion (a cell or less) is left after a frame; bodies "
                          "fly on undamped" +
                          (stops ? ", but pieces a few cells across stop turning" : ""),
                      stops ? keeps_turning : ""});
}

/// FLIP damps rotation at the rate of its finest motion, twice over the square of the radius in
/// cells: measured on balls of 3 to 8 cells, see docs/transfers.md.
void check_spin(const scene::Scene& scene, const Check& check, std::vector<Finding>& findings) {
  const sim::SolverSettings& s = scene.solver;
  if (s.transfer != sim::Transfer::flip) return;
  constexpr double second = 1, longest = 0.5;
  const double rate = -std::log(kept_after(second, s, check));
  if (!(rate > 0)) return;
  for (const setup::SnowPiece& piece : setup::snow_pieces(scene)) {
    constexpr const char* body = "body.";
    if (piece.angular_velocity.norm() == 0 || !piece.address.starts_with(body)) continue;
    const double radius = std::cbrt(3 * piece.volume / (4 * std::numbers::pi)) / s.cell_size;
    const double half_life = std::numbers::ln2 * radius * radius / (2 * rate);
    if (!(half_life < longest)) continue;
    findings.push_back(
        {Severity::note, piece.address + ".angular_velocity",
         fmt::format("{} has the volume of a ball of {} cells in radius: FLIP {}",
                     display_name("body", piece.address.substr(std::string(body).size())),
                     rough_text(radius),
                     half_life < check.dt_start
                         ? "takes its spin in the first steps"
                         : fmt::format("halves its spin every {} s", rough_text(half_life))),
         "solver.transfer = \"asflip\" or \"aflip\" keeps it"});
  }
}

/// The law `places` of sim/health/limits.h, which such a run breaks.
void check_places(const sim::SolverSettings& s, std::vector<Finding>& findings) {
  if (s.transfer != sim::Transfer::flip || s.advect != sim::Advect::particle || s.flip_ratio == 0)
    return;
  findings.push_back({Severity::note, "solver.advect",
                      "flip moves particles by a velocity that does not strain them: packed snow "
                      "ends in as little as 0.6 of the volume that F believes in, and carries less",
                      "solver.advect = \"pic\" or solver.transfer = \"asflip\" moves what is "
                      "strained; keep it for the paper's pictures"});
}

}  // namespace

void check_transfer(const scene::Scene& scene, const Check& check, std::vector<Finding>& findings) {
  check_places(scene.solver, findings);
  check_damping(scene, check, findings);
  check_spin(scene, check, findings);
}

}  // namespace neve::app::health

/// Findings about the transfer between particles and grid: what it damps, and what it moves.

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "app/health/findings.h"
#include "app/health/softness.h"
#include "app/scene/coarsen.h"
#include "app/setup/auto_ranges.h"
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

/// Spacing of floats at a number.
double float_spacing(double x) {
  const auto single = static_cast<float>(std::abs(x));
  return std::nextafter(single, std::numeric_limits<float>::infinity()) - single;
}

/// Advice on steps that are too short. @param needed  s, that would do
std::string advice_on_short_steps(const sim::SolverSettings& s, double needed, double coarsening) {
  const std::string precise = "solver.precision = \"double\"";
  if (s.time_step == sim::TimeStep::fixed)
    return precise + ", or longer steps: " + scene::setting_text("solver.dt", needed, coarsening);
  return precise + ", or softer snow, which takes longer steps";
}

}  // namespace

void check_rounding(const scene::Scene& scene, std::vector<Finding>& findings, double coarsening) {
  const sim::SolverSettings& s = scene.solver;
  if (s.precision != sim::Precision::single) return;
  const double dt = setup::step_at_rest(scene), g = s.gravity.norm(), fastest = load_speed(scene);
  const double shown = fastest > 0 ? fastest : std::sqrt(g * s.cell_size);
  const auto add = [&](const std::string& what, double needed) {
    findings.push_back(
        {Severity::warning, "solver.precision",
         fmt::format("steps of {} s are so short that single precision {}", rough_text(dt), what),
         advice_on_short_steps(s, needed, coarsening)});
  };
  // Places are kept in shares of a cell, and a step is rounded by up to half of their spacing.
  constexpr double place_rounding = 0.5 * 6e-8, notable = 0.01;
  const double lost = place_rounding * s.cell_size / dt;
  const double slow = g > 0 ? std::min(shown, std::sqrt(g * s.cell_size)) : shown;
  if (slow > 0 && lost > notable * slow)
    add(fmt::format("does not move snow slower than {} m/s, and moves snow at {} m/s by up to {} "
                    "too much or too little",
                    rough_text(lost), rough_text(shown), percent_text(lost / shown)),
        place_rounding * s.cell_size / (notable * slow));
  // Speeds grow by g dt, rounded in the same way.
  constexpr double spacings = 16;
  const double spacing = float_spacing(fastest);
  if (g > 0 && g * dt < spacings * spacing)
    add(fmt::format("adds {} m/s of gravity to speeds of {} m/s, which have a spacing of {} m/s",
                    rough_text(g * dt), rough_text(fastest), rough_text(spacing)),
        spacings * spacing / g);
}

void check_transfer(const scene::Scene& scene, const Check& check, std::vector<Finding>& findings) {
  check_places(scene.solver, findings);
  check_damping(scene, check, findings);
  check_spin(scene, check, findings);
}

}  // namespace neve::app::health

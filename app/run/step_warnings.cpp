#include "app/run/step_warnings.h"

#include <fmt/core.h>

#include <algorithm>

#include "app/health/findings.h"
#include "app/health/softness.h"
#include "app/picture/snapshot.h"
#include "app/support/text.h"

namespace neve::app::run {

namespace {

std::string semi_implicit_steps(std::size_t count) {
  return std::to_string(count) + (count == 1 ? " semi-implicit step " : " semi-implicit steps ");
}

constexpr double worth_a_word = 10;  ///< times as long as the first frame
constexpr double short_frame = 2;    ///< s; nobody waits for it
/// Causes that explain less are left out; seconds vary with what else the machine does.
constexpr double notable = 1.5, notable_cost = 2.5;

double steps_of(const record::FrameRecord& frame) {
  return static_cast<double>(frame.advance.steps);
}

double blocks_per_particle(const record::FrameRecord& frame) {
  return static_cast<double>(frame.summary.grid_blocks) /
         static_cast<double>(frame.summary.particles);
}

/// Tells why dt is what it is.
std::string cause_of(const record::FrameRecord& frame) {
  switch (frame.advance.limit()) {
    case sim::DtLimit::acoustic:
      return fmt::format(
          "acoustic: the stiffest snow is packed to J_P = {}; a smaller hardening or "
          "max_hardening of the material makes steps longer",
          rough_text(frame.summary.min_J_P));
    case sim::DtLimit::cfl:
      return fmt::format("cfl: the fastest particle has {} m/s",
                         rough_text(frame.summary.max_speed));
    case sim::DtLimit::strain:
      return "strain: neighbours differ much in velocity; solver.strain_limit makes steps longer";
    default:
      return sim::name(frame.advance.limit());
  }
}

}  // namespace

std::vector<std::string> step_warnings(const scene::Scene& scene,
                                       const sim::Simulation& simulation) {
  const sim::Warnings& warnings = simulation.warnings();
  const sim::SolverSettings& settings = scene.solver;
  std::vector<std::string> list;
  if (warnings.rules_ignored > 0)
    list.push_back(picture::ignored_rule_text(warnings) +
                   ": numbers and pictures from there on mean nothing; solver.on_divergence = "
                   "\"stop\" explains the cause");
  if (const std::string text = health::unstable_steps(settings, warnings); !text.empty())
    list.push_back(text);
  if (warnings.solves_cut_short > 0)
    list.push_back(
        semi_implicit_steps(warnings.solves_cut_short) +
        "ended after solver.solve_iterations = " + std::to_string(settings.solve_iterations) +
        " above solve_tolerance, and were used as they are; try more iterations, or a smaller dt "
        "(solver.max_dt, solver.dt)");
  if (warnings.solves_given_up > 0)
    list.push_back(semi_implicit_steps(warnings.solves_given_up) +
                   "could not be solved, and shorter ones, at last explicit ones, replaced them; "
                   "try a smaller dt (solver.max_dt, solver.dt)");
  const std::vector<sim::seeding::EmitterStream::State> emitters = simulation.emitter_states();
  for (std::size_t k = 0; k < emitters.size(); ++k) {
    if (emitters[k].withheld == 0) continue;
    const auto withheld = static_cast<double>(emitters[k].withheld);
    const double share = withheld / (withheld + static_cast<double>(emitters[k].born));
    if (const auto reason = health::clogging(scene, scene.emitters[k].name, share))
      list.push_back(fmt::format("emitter.{}: {} particles found no room, because {}; {}",
                                 scene.emitters[k].name, emitters[k].withheld, reason->cause,
                                 reason->remedy));
  }
  if (const auto softness = health::softness_warning(scene, simulation)) list.push_back(*softness);
  return list;
}

std::optional<std::string> slowdown_warning(const std::vector<record::FrameRecord>& frames) {
  const auto moves = [](const record::FrameRecord& frame) {
    return frame.advance.steps > 0 && frame.summary.particles > 0;
  };
  const auto first = std::find_if(frames.begin(), frames.end(), moves);
  if (first == frames.end()) return std::nullopt;
  const record::FrameRecord& slow =
      *std::ranges::max_element(first, frames.end(), {}, &record::FrameRecord::seconds_sim);
  const double ratio = slow.seconds_sim / first->seconds_sim;
  if (!(ratio >= worth_a_word && slow.seconds_sim >= short_frame)) return std::nullopt;
  std::string text = fmt::format("frame {} took {} s, {} times as long as frame {}", slow.frame,
                                 rough_text(slow.seconds_sim), rough_text(ratio), first->frame);
  const double more_steps = steps_of(slow) / steps_of(*first);
  if (more_steps > notable)
    text +=
        fmt::format("; it has {} times as many steps ({})", rough_text(more_steps), cause_of(slow));
  const auto more_snow =
      static_cast<double>(slow.summary.particles) / static_cast<double>(first->summary.particles);
  if (more_snow > notable)
    text += fmt::format("; {} times as many particles", rough_text(more_snow));
  const double dearer = (slow.seconds_sim / record::particle_steps(slow)) /
                        (first->seconds_sim / record::particle_steps(*first));
  if (dearer > notable_cost)
    text += fmt::format("; each step of a particle costs {} times as much, {}", rough_text(dearer),
                        blocks_per_particle(slow) > notable * blocks_per_particle(*first)
                            ? "because the snow is spread over more of the grid; a sink removes "
                              "spray that nobody sees"
                            : "though the snow is as dense on the grid as before; other programs "
                              "may have used the processor");
  return text;
}

}  // namespace neve::app::run

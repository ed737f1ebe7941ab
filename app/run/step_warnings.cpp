#include "app/run/step_warnings.h"

#include "app/health/findings.h"
#include "app/health/softness.h"
#include "app/picture/snapshot.h"
#include "app/support/text.h"

namespace neve::app::run {

namespace {

std::string semi_implicit_steps(std::size_t count) {
  return std::to_string(count) + (count == 1 ? " semi-implicit step " : " semi-implicit steps ");
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
  if (settings.time_step == sim::TimeStep::fixed && warnings.worst_acoustic_cfl > 1.5)
    list.push_back("fixed steps: the acoustic CFL reached " +
                   fixed_text(warnings.worst_acoustic_cfl, 1) +
                   "; steps above 1.5 are unstable: make solver.dt smaller");
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
  const std::vector<std::uint64_t> withheld = simulation.withheld();
  for (std::size_t k = 0; k < withheld.size(); ++k)
    if (withheld[k] > 0)
      list.push_back("emitter." + scene.emitters[k].name + ": " + std::to_string(withheld[k]) +
                     " particles found no room, because snow fills the emitter; use " +
                     health::remedy_for_clogging(scene, scene.emitters[k].name));
  if (const auto softness = health::softness_warning(scene, simulation)) list.push_back(*softness);
  return list;
}

}  // namespace neve::app::run

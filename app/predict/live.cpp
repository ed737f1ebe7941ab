#include "app/predict/live.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "app/health/check.h"
#include "app/predict/copies.h"
#include "app/scene/override.h"
#include "app/scene/read.h"
#include "app/setup/plan.h"
#include "app/support/errors.h"
#include "app/support/text.h"

namespace neve::app::predict {

namespace {

/// Coarser snow shows little of the film.
constexpr double max_coarsening = 6;

/// The cells, in quarters, that a pace asks for: a run costs as the fourth power of its cells.
double wanted_cells(double coarsening, double pace) {
  return std::ceil(4 * coarsening * std::pow(pace / LiveChoice::room, 0.25)) / 4;
}

}  // namespace

std::string LiveChoice::sentence() const {
  std::string settings = fast ? "--fast" : "";
  if (coarsening > 1)
    settings += fmt::format("{}--coarsen {}", settings.empty() ? "" : " ", rough_text(coarsening));
  return fmt::format("{}: a second of the film takes about {} s on this machine{}",
                     settings.empty() ? "the scene as it is" : settings, rough_text(pace),
                     keeps_up() ? "" : "; it does not keep up with the clock");
}

Pace measured_pace(int threads) {
  return [threads](const scene::Scene& scene) {
    const setup::Plan plan =
        setup::make_plan(scene, {0, scene::last_frame(scene)}, setup::Quality::preview, threads);
    return health::examine(scene, plan, threads).seconds().expected / scene::duration(scene);
  };
}

LiveChoice choose_live(const scene::Scene& scene, int last, const std::vector<std::string>& chosen,
                       const Pace& pace) {
  // Each takes seconds; the fourth power needs few of them.
  constexpr int max_trials = 4;
  constexpr double step = 0.25;
  LiveChoice choice;
  choice.pace = pace(scene);
  if (choice.pace <= LiveChoice::room) return choice;
  scene::Scene faster = scene;
  forecast::FastLook look = forecast::fast_look(scene, last, chosen);
  if (!look.overrides.empty()) {
    faster = scene::apply(scene, scene::parse_overrides(look.overrides));
    if (look.work && look.work_before) choice.pace *= *look.work / *look.work_before;
    choice.fast = std::move(look);
  }
  // Known to be too slow, and to keep up.
  double slow = 1, quick = max_coarsening + step;
  LiveChoice tried = choice, best = choice;
  for (int trial = 0; trial < max_trials && choice.pace > LiveChoice::room; ++trial) {
    const double next = std::clamp(wanted_cells(tried.coarsening, tried.pace), slow + step,
                                   std::max(slow + step, quick - step));
    if (next >= quick || next > max_coarsening) break;
    try {
      tried.pace = pace(copy_of(faster, next, faster.seed));
    } catch (const UsageError&) {
      quick = next;  // a body would have no particle
      continue;
    }
    tried.coarsening = next;
    (tried.pace <= LiveChoice::room ? quick : slow) = next;
    if (tried.pace <= LiveChoice::room || next > best.coarsening) best = tried;
  }
  return best;
}

}  // namespace neve::app::predict

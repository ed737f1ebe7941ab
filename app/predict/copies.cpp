#include "app/predict/copies.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <utility>

#include "app/record/metrics.h"
#include "app/record/run_json.h"
#include "app/scene/coarsen.h"
#include "app/support/errors.h"
#include "app/support/interrupt.h"
#include "app/support/text.h"
#include "app/timeline/timeline.h"

namespace neve::app::predict {

namespace {

double largest_force(const timeline::Timeline& timeline) {
  double force = 0;
  for (const record::ColliderForce& on :
       record::forces_of(timeline.here().advance, timeline.summary(), timeline.start().colliders))
    force = std::max(force, on.force.norm());
  return force;
}

/// @param say  gets each frame
void run(const scene::Scene& scene, int last, int threads, std::function<void(int frame)> say,
         Copy& copy) {
  timeline::Watch watch;
  watch.after_step = [](double) { return is_interrupted(); };
  watch.after_frame = std::move(say);
  timeline::Timeline timeline(scene, {},
                              std::make_shared<const setup::SeededScene>(setup::seed_scene(scene)),
                              threads, {}, std::move(watch));
  const record::Metrics first = record::measure(timeline.simulation().particles(), scene);
  double force = 0;
  for (int frame = 1; frame <= last; ++frame) {
    if (!timeline.advance_frame()) {
      copy.failure = timeline.simulation().divergence() ? "it diverged" : "it was interrupted";
      return;
    }
    force = std::max(force, largest_force(timeline));
  }
  const record::Metrics end = record::measure(timeline.simulation().particles(), scene);
  copy.has_broken = record::has_broken(first, end);
  copy.whole = record::held_whole(first, end).value_or(copy.whole);
  const double values[] = {end.spread, end.height, end.mean_J_P, end.largest_fragment, force};
  std::copy(std::begin(values), std::end(values), copy.values);
}

}  // namespace

const QuantityInfo& info_of(Quantity quantity) {
  static constexpr QuantityInfo infos[] = {{"spread", "m", "spread"},
                                           {"height", "m", "height"},
                                           {"mean_J_P", "", "mean J_P"},
                                           {"largest_fragment", "", "largest piece"},
                                           {"max_force", "N", "top force"}};
  return infos[static_cast<int>(quantity)];
}

std::string why_not(const scene::Scene& scene) {
  return scene::which_are_snow(scene).empty() ? "no material of the scene breaks" : "";
}

scene::Scene copy_of(const scene::Scene& scene, double coarsening, std::uint64_t seed) {
  scene::Scene copy = scene::without_dust(scene);
  copy.seed = seed;
  scene::coarsen(copy, coarsening);
  return copy;
}

double share_of_work() {
  double share = 0;
  for (const CopyPlan& plan : copy_plans) share += plan.seeds / std::pow(plan.coarsening, 4);
  return share;
}

namespace {

int copy_count() {
  int count = 0;
  for (const CopyPlan& plan : copy_plans) count += plan.seeds;
  return count;
}

}  // namespace

std::string cost_text() {
  std::string copies;
  for (const CopyPlan& plan : copy_plans)
    copies += fmt::format("{}{} with --coarsen {}", copies.empty() ? "" : ", ", plan.seeds,
                          rough_text(plan.coarsening));
  return fmt::format("runs {} coarse copies ({}), about {:.0f} % of the work of the run",
                     copy_count(), copies, 100 * share_of_work());
}

std::vector<Copy> run_copies(const scene::Scene& scene, int last, int threads, Progress& progress) {
  std::vector<Copy> copies;
  for (const CopyPlan& plan : copy_plans)
    for (int k = 0; k < plan.seeds; ++k) {
      Copy copy;
      copy.coarsening = plan.coarsening;
      copy.seed = scene.seed + static_cast<std::uint64_t>(k);
      const auto say = [&, number = copies.size() + 1](int frame) {
        progress.line(fmt::format("coarse copy {} of {}, frame {} of {}", number, copy_count(),
                                  scene::number_of(scene, frame), scene::number_of(scene, last)));
      };
      try {
        run(copy_of(scene, copy.coarsening, copy.seed), last, threads, say, copy);
      } catch (const UsageError& error) {
        copy.failure = error.what();
      }
      copies.push_back(copy);
    }
  return copies;
}

}  // namespace neve::app::predict

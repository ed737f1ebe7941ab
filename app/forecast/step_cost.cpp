#include "app/forecast/step_cost.h"

#include <algorithm>
#include <array>
#include <set>
#include <utility>
#include <vector>

#include "app/support/clock.h"
#include "app/support/interrupt.h"

namespace neve::app::forecast {

namespace {

/// Cost of a block over that of a packed particle, measured with about a particle to a block:
/// blocks without neighbours take no room on the grid (neve bench sim: spray_lattice), the others
/// do, and cost 40 with quadratic weights and 90 with cubic ones.
constexpr double cost_alone = 3, cost_on_grid = 60;

using Block = std::array<int, 3>;

bool is_alone(const Block& block, const std::set<Block>& blocks) {
  for (int i = -1; i <= 1; ++i)
    for (int j = -1; j <= 1; ++j)
      for (int k = -1; k <= 1; ++k)
        if ((i || j || k) && blocks.contains({block[0] + i, block[1] + j, block[2] + k}))
          return false;
  return true;
}

}  // namespace

Spread spread_of(const sim::Simulation& simulation, const sim::SolverSettings& solver) {
  std::set<Block> blocks;
  const std::vector<sim::Vec3i> cells = simulation.cells();
  for (const sim::Vec3i& cell : cells) blocks.insert({cell[0] >> 2, cell[1] >> 2, cell[2] >> 2});
  if (cells.empty()) return {};
  const auto alone = std::count_if(blocks.begin(), blocks.end(),
                                   [&](const Block& block) { return is_alone(block, blocks); });
  // In semi-implicit steps all snow is on the grid.
  const bool is_alone_off_grid = !solver.is_implicit();
  return {static_cast<double>(blocks.size()) / static_cast<double>(cells.size()),
          is_alone_off_grid ? static_cast<double>(alone) / static_cast<double>(blocks.size()) : 0};
}

double cost_of_step(const Spread& spread) {
  return 1 + spread.blocks * (cost_on_grid + spread.alone * (cost_alone - cost_on_grid));
}

StepTime measure_steps(sim::Simulation& simulation, double frame, const StepTiming& timing) {
  StepTime time;
  std::vector<double> seconds;
  const auto start = Clock::now();
  for (int k = 0; k < timing.steps && seconds_since(start) < timing.seconds; ++k) {
    const auto before = Clock::now();
    const std::size_t steps_before = simulation.steps();
    simulation.step(simulation.choose_dt(frame).dt);
    time.solve.add(simulation.last_solve());
    ++time.steps;
    // A solve that is given up is followed by many explicit steps.
    const auto taken =
        static_cast<double>(std::max<std::size_t>(1, simulation.steps() - steps_before));
    seconds.push_back(seconds_since(before) / taken);
    if (simulation.divergence() || is_interrupted()) break;
  }
  // The first two warm caches up. Steps so long that there are no others tell the time all the
  // same.
  constexpr std::ptrdiff_t warming = 2;
  if (std::ssize(seconds) > warming) seconds.erase(seconds.begin(), seconds.begin() + warming);
  time.seconds = median_of(std::move(seconds));
  return time;
}

double median_of(std::vector<double> list) {
  if (list.empty()) return 0;
  const auto middle = list.begin() + static_cast<std::ptrdiff_t>(list.size() / 2);
  std::nth_element(list.begin(), middle, list.end());
  return *middle;
}

}  // namespace neve::app::forecast

#include "app/sweep/plan/sweep_forecast.h"

#include <fmt/core.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <future>
#include <map>
#include <numeric>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "app/forecast/step_cost.h"
#include "app/setup/curves.h"
#include "app/setup/seed_scene.h"
#include "app/support/interrupt.h"
#include "app/support/progress.h"
#include "app/support/text.h"
#include "app/sweep/plan/order.h"
#include "app/sweep/plan/sweep_plan.h"

namespace neve::app::sweep::plan {

namespace {

/// A value that a run leaves to the scene comes first, then numbers by their size, then texts.
struct ByValue {
  static int kind(const std::string& value) { return value.empty() ? 0 : number_of(value) ? 1 : 2; }
  bool operator()(const std::string& a, const std::string& b) const {
    if (kind(a) != kind(b)) return kind(a) < kind(b);
    return kind(a) == 1 ? *number_of(a) < *number_of(b) : a < b;
  }
};

/// Places of the runs of a sweep along each of its parameters, from 0 to 1 by the rank of the value
/// among the values of the sweep. Runs that differ in their seed alone are
/// in one place.
class RunPlaces {
 public:
  explicit RunPlaces(const std::vector<PlannedRun>& runs);

  /// The one of `others`, which are not empty, with the least squared distance; of equal ones the
  /// first.
  std::size_t nearest(std::size_t run, const std::vector<std::size_t>& others) const;

 private:
  double distance(std::size_t a, std::size_t b) const;

  std::vector<std::vector<double>> places_;  ///< by run, then by parameter
};

RunPlaces::RunPlaces(const std::vector<PlannedRun>& runs) : places_(runs.size()) {
  std::set<std::string> addresses;
  for (const PlannedRun& item : runs)
    for (const scene::Override& setting : item.run.settings) addresses.insert(setting.address);
  addresses.erase("seed");  // another draw of the same values
  for (const std::string& address : addresses) {
    std::map<std::string, double, ByValue> ranks;
    for (const PlannedRun& item : runs) ranks[item.run.setting(address)] = 0;
    double rank = 0;
    for (auto& [value, place] : ranks)
      place = rank++ / static_cast<double>(std::max<std::size_t>(1, ranks.size() - 1));
    for (std::size_t k = 0; k < runs.size(); ++k)
      places_[k].push_back(ranks.at(runs[k].run.setting(address)));
  }
}

double RunPlaces::distance(std::size_t a, std::size_t b) const {
  double sum = 0;
  for (std::size_t k = 0; k < places_[a].size(); ++k) {
    const double apart = places_[a][k] - places_[b][k];
    sum += apart * apart;
  }
  return sum;
}

std::size_t RunPlaces::nearest(std::size_t run, const std::vector<std::size_t>& others) const {
  return *std::min_element(others.begin(), others.end(), [&](std::size_t a, std::size_t b) {
    return distance(run, a) < distance(run, b);
  });
}

/// Seconds of a particle and step that a forecast counts with where nothing was measured: about
/// those of one thread of a machine of 2022.
constexpr double usual_seconds = 5e-8;
constexpr double start_seconds = 0.1, tile_seconds = 0.02;

constexpr double max_copied = 1500, min_copied = 200;  // particles of a copy
constexpr double longest_copy = 2;                     // s
/// Above this many particles, seeding the scene itself takes too long.
constexpr double max_timed = 3e5;

/// A copy of N of P particles has cells (P / N)^(1/3) times as large, and takes as many times fewer
/// steps.
constexpr double cost_exponent = 4.0 / 3;

double steps_at_rest(const PlannedRun& item) {
  return forecast::work_at_rest(item.scene, item.plan);
}

/// A run's copy and what it says.
struct Copy {
  std::size_t run = 0;
  forecast::ForecastBudget budget{longest_copy, 0};
  forecast::Forecast foreseen{};
};

/// Chooses as many copies as the effort allows.
std::vector<Copy> choose_copies(const SweepPlan& plan, const std::vector<std::size_t>& chosen,
                                const ForecastEffort& effort) {
  double all = 0;
  std::vector<std::vector<int>> coordinates;
  const std::vector<int> all_draws = draws_of(plan);
  std::vector<int> draws;
  for (const std::size_t k : chosen) {
    all += steps_at_rest(plan.runs[k]);
    coordinates.push_back(plan.runs[k].run.coordinates);
    draws.push_back(all_draws[k]);
  }
  const double fineness = std::pow(effort.particle_steps / std::max(1.0, all), 1 / cost_exponent);
  std::vector<Copy> copies;
  double cost = 0;
  for (const std::size_t place : coarse_first(coordinates, axis_sizes(plan), draws)) {
    const PlannedRun& item = plan.runs[chosen[place]];
    if (!is_possible(item) || !(item.plan.particles > 0)) continue;
    Copy copy;
    copy.run = chosen[place];
    copy.budget.particles = std::clamp(fineness * item.plan.particles, min_copied, max_copied);
    const double share = std::min(1.0, copy.budget.particles / item.plan.particles);
    const double own = steps_at_rest(item) * std::pow(share, cost_exponent);
    if (cost + own > effort.particle_steps) break;
    cost += own;
    // Snow that hardens takes more steps than snow at rest.
    constexpr double hardening = 4;
    copy.budget.particle_steps = hardening * own;
    copies.push_back(std::move(copy));
  }
  return copies;
}

/// Calls task(k) for each k below `count`, on some threads.
template <class Task>
void side_by_side(std::size_t count, int threads, const Task& task) {
  std::atomic<std::size_t> next = 0;
  std::vector<std::future<void>> workers;
  for (int worker = 0; worker < threads; ++worker)
    workers.push_back(std::async(std::launch::async, [&] {
      for (std::size_t k = next++; k < count; k = next++) task(k);
    }));
  for (std::future<void>& worker : workers) worker.get();
}

/// The cost of a run by some steps of its own.
struct Timing {
  double seconds_per_work = 0;
  forecast::Spread spread{};
};

/// Takes some steps of a run on one thread.
Timing time_run(const PlannedRun& item) {
  if (item.plan.particles > max_timed) return {};
  const setup::SeededScene seeded = setup::seed_scene(item.scene);
  if (seeded.particles.x.empty()) return {};
  sim::Simulation simulation =
      setup::make_simulation(setup::with_curves(item.scene, 0), seeded.particles, 1);
  Timing timing{0, forecast::spread_of(simulation, item.scene.solver)};
  const forecast::StepTime step =
      forecast::measure_steps(simulation, 1 / item.scene.fps, {20, 0.5});
  const double iterations =
      static_cast<double>(step.solve.all_iterations) / std::max(1, step.steps);
  timing.seconds_per_work = step.seconds / forecast::explicit_steps(iterations) /
                            static_cast<double>(seeded.particles.x.size());
  return timing;
}

/// The chosen run that costs most at rest.
std::optional<std::size_t> costliest_of(const SweepPlan& plan,
                                        const std::vector<std::size_t>& chosen) {
  std::optional<std::size_t> costliest;
  for (const std::size_t k : chosen)
    if (is_possible(plan.runs[k]) &&
        (!costliest || plan.runs[k].run.work > plan.runs[*costliest].run.work))
      costliest = k;
  return costliest;
}

double median_seconds(const std::vector<Copy>& copies) {
  std::vector<double> seconds;
  for (const Copy& copy : copies)
    if (copy.foreseen.seconds_per_particle_step > 0)
      seconds.push_back(copy.foreseen.seconds_per_particle_step);
  return forecast::median_of(std::move(seconds));
}

/// Steps of a particle in the frames of a run that are its own.
forecast::Cost own_work(const SweepPlan& plan, const PlannedRun& item,
                        const forecast::Forecast& foreseen) {
  const int fork = plan.beginnings.empty() ? 0 : plan.beginnings.front().plan.frames.last;
  return item.plan.particles * foreseen.work(fork, item.plan.frames.last);
}

forecast::Cost beginning_work(const SweepPlan& plan, const ForecastEffort& effort) {
  if (plan.beginnings.empty() || plan.source) return {};
  // Beginnings with other seeds cost as much.
  const PlannedRun& item = plan.beginnings.front();
  const int last = item.plan.frames.last;
  forecast::ForecastBudget budget{longest_copy, effort.particle_steps, max_copied};
  return static_cast<double>(plan.beginnings.size()) * item.plan.particles *
         forecast::foresee(item.scene, item.plan.particles, last, budget).work(0, last);
}

}  // namespace

bool is_possible(const PlannedRun& item) {
  return item.plan.memory <= item.plan.memory_limit &&
         item.plan.particles <= item.plan.particle_limit;
}

ForecastEffort whole_effort(int cores) {
  constexpr double seconds = 40;
  return {seconds / usual_seconds * cores};
}

ForecastEffort small_effort(const SweepPlan& plan, const std::vector<std::size_t>& chosen,
                            int cores) {
  constexpr double share = 0.03, least = 4e6, max_seconds = 15;
  double all = 0;
  for (const std::size_t k : chosen) all += plan.runs[k].run.work;
  return {std::clamp(share * all, least, max_seconds / usual_seconds * cores)};
}

SweepForecast foresee_sweep(const SweepPlan& plan, const std::vector<std::size_t>& chosen,
                            const ForecastEffort& effort, int cores) {
  SweepForecast result;
  for (const PlannedRun& item : plan.runs) {
    result.work.push_back({item.run.work, item.run.work, item.run.work});
    result.drawing.push_back(start_seconds + tile_seconds * item.run.frames.count());
  }
  const std::optional<std::size_t> costliest = costliest_of(plan, chosen);
  if (!costliest) return result;
  const Timing timing = time_run(plan.runs[*costliest]);
  std::vector<Copy> copies = choose_copies(plan, chosen, effort);
  side_by_side(copies.size(), cores, [&](std::size_t k) {
    Copy& copy = copies[k];
    const PlannedRun& item = plan.runs[copy.run];
    if (is_interrupted()) return;
    copy.foreseen =
        forecast::foresee(item.scene, item.plan.particles, item.plan.frames.last, copy.budget);
    copy.foreseen.include_spread(timing.spread);
  });
  result.beginning = beginning_work(plan, effort);
  result.seconds_per_work =
      timing.seconds_per_work > 0 ? timing.seconds_per_work : median_seconds(copies);
  if (is_interrupted()) return result;
  for (const Copy& copy : copies) {
    const PlannedRun& item = plan.runs[copy.run];
    const forecast::Cost work = own_work(plan, item, copy.foreseen);
    if (!(work.expected > 0)) continue;
    result.own.push_back(copy.run);
    result.work[copy.run] = work;
  }
  if (result.own.empty()) return result;
  const RunPlaces places(plan.runs);
  for (std::size_t k = 0; k < plan.runs.size(); ++k) {
    if (std::find(result.own.begin(), result.own.end(), k) != result.own.end()) continue;
    const std::size_t near = places.nearest(k, result.own);
    const double more = plan.runs[k].run.work / std::max(1.0, plan.runs[near].run.work);
    result.work[k] = more * result.work[near];
  }
  return result;
}

forecast::Cost SweepForecast::seconds(std::size_t run) const {
  return seconds_per_work * work[run] + forecast::Cost{drawing[run], drawing[run], drawing[run]};
}

double SweepForecast::cost(std::size_t run) const {
  return work[run].expected + drawing[run] / usual_seconds;
}

forecast::Cost SweepForecast::seconds_of_all(const std::vector<std::size_t>& chosen,
                                             int cores) const {
  forecast::Cost sum, longest;
  for (const std::size_t k : chosen) {
    sum = sum + seconds(k);
    if (seconds(k).expected > longest.expected) longest = seconds(k);
  }
  const forecast::Cost side_by_side = 1.0 / cores * sum;
  return seconds_per_work / cores * beginning +
         (longest.expected > side_by_side.expected ? longest : side_by_side);
}

std::string longest_text(const SweepPlan& plan, const std::vector<std::size_t>& chosen,
                         const SweepForecast& forecast) {
  constexpr double much_longer = 1.5;  // than the median
  constexpr std::size_t max_named = 5;
  std::vector<std::size_t> order = chosen;
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return forecast.seconds(a).expected > forecast.seconds(b).expected;
  });
  if (order.empty()) return {};
  const double usual = forecast.seconds(order[order.size() / 2]).expected;
  std::string text;
  for (std::size_t k = 0; k < std::min(order.size(), max_named); ++k) {
    const double seconds = forecast.seconds(order[k]).expected;
    if (!(seconds > much_longer * usual)) break;
    text += fmt::format("{}run {}, {}", text.empty() ? "the longest: " : "; ",
                        plan.runs[order[k]].run.index, duration_text(seconds));
  }
  return text.empty() ? "" : text + fmt::format("; most take about {}", duration_text(usual));
}

namespace {

/// "the budget is enough for about 12 of 40 runs"; "" if all fit.
std::string budget_text(const std::vector<std::size_t>& chosen, const SweepForecast& forecast,
                        int cores, double budget) {
  if (budget <= 0 || forecast.seconds_of_all(chosen, cores).expected <= budget) return {};
  double sum = 0;
  for (const std::size_t k : chosen) sum += forecast.seconds(k).expected;
  const double mean = sum / static_cast<double>(chosen.size());
  const double runs = std::floor(
      std::max(0.0, budget * cores - forecast.beginning.expected * forecast.seconds_per_work) /
      mean);
  return fmt::format("; the budget of {} is enough for about {:.0f} of them", duration_text(budget),
                     runs);
}

}  // namespace

std::string forecast_text(const SweepPlan& plan, const std::vector<std::size_t>& chosen,
                          const SweepForecast& forecast, int cores, double budget) {
  std::string text = fmt::format(
      "forecast: {}{}, about {} on {}", count_text(chosen.size(), "run"), seeds_text(plan.sweep),
      duration_text(forecast.seconds_of_all(chosen, cores).expected), count_text(cores, "core"));
  if (forecast.own.size() < chosen.size())
    text += fmt::format(", from coarse copies of {} of them", forecast.own.size());
  text += budget_text(chosen, forecast, cores, budget);
  const std::string longest = longest_text(plan, chosen, forecast);
  return longest.empty() ? text : text + "\n" + longest;
}

}  // namespace neve::app::sweep::plan

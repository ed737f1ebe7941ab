#include "app/sweep/plan/dry_run_report.h"

#include <fmt/core.h>

#include <algorithm>
#include <atomic>
#include <future>
#include <iostream>
#include <numeric>
#include <string>
#include <vector>

#include "app/health/checkup.h"
#include "app/support/json.h"
#include "app/support/progress.h"
#include "app/support/text.h"
#include "app/sweep/plan/labels.h"

namespace neve::app::sweep::plan {

namespace {

bool is_possible(const PlannedRun& item) {
  return item.plan.memory <= item.plan.memory_limit &&
         item.plan.particles <= item.plan.particle_limit;
}

/// Drawing a tile takes about as long as it takes for one: 20 ms.
constexpr double seconds_per_tile = 0.02;
/// Coarse copies of all runs together take no longer; one is worth no less, and no more.
constexpr double all_forecasts = 40, least_forecast = 0.15, longest_forecast = 2;

/// Seconds of one thread.
struct RunSeconds {
  std::vector<double> runs;
  double beginning = 0;  ///< of forked runs
};

/// Steps of a run, from where it parts from the others.
double own_steps(const SweepPlan& plan, const health::Forecast& forecast, int last) {
  const double all = forecast.steps_until(last);
  return plan.beginning ? all - forecast.steps_until(plan.beginning->run.frames.last) : all;
}

/// Seconds of one thread for each run, measured now: the time of a particle and step in the
/// costliest run, and the steps of a coarse copy of each. Copies of very many runs would take too
/// long: these are compared by the steps that snow at rest allows. 0: not known.
RunSeconds seconds_of_runs(const SweepPlan& plan, int cores) {
  RunSeconds result{std::vector<double>(plan.runs.size(), 0)};
  std::vector<double>& seconds = result.runs;
  const PlannedRun* costliest = nullptr;
  for (const PlannedRun& item : plan.runs)
    if (is_possible(item) && (!costliest || item.run.work > costliest->run.work)) costliest = &item;
  if (!costliest) return result;
  const health::Checkup checkup = health::examine(costliest->scene, costliest->plan, 1);
  const double per_particle_step = checkup.seconds_per_step / std::max(1.0, checkup.plan.particles);
  const double per_run =
      std::min(longest_forecast, all_forecasts * cores / static_cast<double>(plan.runs.size()));
  const auto estimate = [&](std::size_t k) {
    const PlannedRun& item = plan.runs[k];
    const double drawn = seconds_per_tile * item.run.frames.count();
    if (per_run < least_forecast || !is_possible(item)) {
      seconds[k] = checkup.seconds() * item.run.work / costliest->run.work + drawn;
      return;
    }
    const health::Forecast forecast =
        health::foresee(item.scene, item.plan.particles, item.run.frames.last, {per_run, 1e12});
    seconds[k] =
        own_steps(plan, forecast, item.run.frames.last) * item.plan.particles * per_particle_step +
        drawn;
  };
  if (plan.beginning && !plan.source) {
    const PlannedRun& item = *plan.beginning;
    const int last = item.run.frames.last;
    result.beginning =
        health::foresee(item.scene, item.plan.particles, last, {longest_forecast, 1e12})
            .steps_until(last) *
        item.plan.particles * per_particle_step;
  }
  std::atomic<std::size_t> next = 0;
  std::vector<std::future<void>> workers;
  for (int worker = 0; worker < cores; ++worker)
    workers.push_back(std::async(std::launch::async, [&] {
      for (std::size_t k = next++; k < plan.runs.size(); k = next++) estimate(k);
    }));
  for (std::future<void>& worker : workers) worker.get();
  return result;
}

struct Totals {
  double seconds = 0;  ///< of one core
  double longest = 0;
  double largest = 0;  ///< bytes
  int too_large = 0;   ///< runs over [limits] memory
};

bool is_over_limit(const SweepPlan& plan, const Run& run) {
  const std::uint64_t limit = plan.sweep.limits.memory;
  return limit > 0 && run.memory > static_cast<double>(limit);
}

std::uint64_t whole_bytes(double bytes) {
  return static_cast<std::uint64_t>(bytes);
}

Totals totals_of(const SweepPlan& plan, const RunSeconds& each) {
  Totals totals;
  const std::vector<double>& seconds = each.runs;
  for (std::size_t k = 0; k < plan.runs.size(); ++k) {
    const Run& run = plan.runs[k].run;
    totals.seconds += seconds[k];
    totals.longest = std::max(totals.longest, seconds[k]);
    totals.largest = std::max(totals.largest, run.memory);
    totals.too_large += is_over_limit(plan, run);
  }
  return totals;
}

void print_json(const SweepPlan& plan, const RunSeconds& each, double seconds_of_all) {
  const Totals totals = totals_of(plan, each);
  const std::vector<double>& seconds = each.runs;
  Json json;
  json["title"] = plan.title;
  json["scene"] = plan.sweep.scene_file;
  json["out"] = plan.folder.string();
  json["view"] = plan.view;
  json["runs"] = Json::array();
  for (std::size_t k = 0; k < plan.runs.size(); ++k) {
    const Run& run = plan.runs[k].run;
    Json settings = Json::object();
    for (const scene::Override& setting : run.settings) settings[setting.address] = setting.value;
    json["runs"].push_back({{"run", run.index},
                            {"label", run.label},
                            {"settings", settings},
                            {"first_frame", run.frames.first},
                            {"last_frame", run.frames.last},
                            {"particles", count_json(run.particles)},
                            {"memory_bytes", whole_bytes(run.memory)},
                            {"over_memory_limit", is_over_limit(plan, run)},
                            {"seconds", seconds[k]}});
  }
  if (plan.beginning)
    json["beginning"] = {{"time", plan.fork},
                         {"frame", plan.beginning->run.frames.last},
                         {"seconds", each.beginning}};
  if (plan.keeps_states) json["state_bytes"] = whole_bytes(bytes_of_states(plan));
  json["memory_bytes"] = whole_bytes(totals.largest);
  json["seconds"] = seconds_of_all;
  std::cout << to_text(json) << "\n";
}

std::string padded(const std::string& text, std::size_t width, bool to_the_right = false) {
  const std::string space(width > text.size() ? width - text.size() : 0, ' ');
  return to_the_right ? space + text : text + space;
}

/// True of all runs.
std::string frames_text(const SweepPlan& plan) {
  setup::FrameRange all = plan.runs.front().run.frames;
  bool is_same = true;
  for (const PlannedRun& item : plan.runs) {
    const setup::FrameRange& frames = item.run.frames;
    is_same = is_same && frames.first == all.first && frames.last == all.last;
    all.last = std::max(all.last, frames.last);
  }
  return is_same ? fmt::format("frames {} to {}", all.first, all.last)
                 : fmt::format("up to frame {}", all.last);
}

void print_table(const SweepPlan& plan, const std::vector<double>& seconds) {
  std::size_t width = 4;
  std::vector<std::string> what;
  for (const PlannedRun& item : plan.runs) {
    const std::string settings = settings_text(plan, item.run);
    const bool has_both = !item.run.label.empty() && !settings.empty();
    what.push_back(item.run.label + (has_both ? ": " : "") + settings);
    width = std::max(width, std::min<std::size_t>(what.back().size(), 100));
  }
  std::cout << padded("run", 6) << padded("what", width) << "   particles     memory       time\n";
  for (std::size_t k = 0; k < plan.runs.size(); ++k) {
    const Run& run = plan.runs[k].run;
    std::cout << padded(std::to_string(run.index), 6) << padded(what[k], width)
              << padded(fixed_text(run.particles, 0), 12, true)
              << padded(bytes_text(whole_bytes(run.memory)), 11, true)
              << padded(duration_text(seconds[k]), 11, true)
              << (is_over_limit(plan, run) ? "  over [limits] memory" : "") << "\n";
  }
}

/// "the longest: run 4, 3 min; run 7, 2 min": those that take much longer than most, "" without.
std::string longest_text(const SweepPlan& plan, const std::vector<double>& seconds) {
  constexpr double much_longer = 1.5;  // than the median
  constexpr std::size_t most_named = 5;
  std::vector<std::size_t> order(seconds.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return seconds[a] > seconds[b]; });
  const double usual = seconds[order[order.size() / 2]];
  std::string text;
  for (std::size_t k = 0; k < std::min(order.size(), most_named); ++k) {
    if (!(seconds[order[k]] > much_longer * usual)) break;
    text += fmt::format("{}run {}, {}", text.empty() ? "the longest: " : "; ",
                        plan.runs[order[k]].run.index, duration_text(seconds[order[k]]));
  }
  return text.empty() ? "" : text + fmt::format("; most take about {}\n", duration_text(usual));
}

}  // namespace

void print_sweep_plan(const SweepPlan& plan, int cores, bool is_json) {
  const RunSeconds each = seconds_of_runs(plan, cores);
  const Totals totals = totals_of(plan, each);
  const double seconds = each.beginning / cores + std::max(totals.longest, totals.seconds / cores);
  if (is_json) return print_json(plan, each, seconds);
  print_table(plan, each.runs);
  if (plan.source)
    std::cout << fmt::format("\nthe beginning, to {} s, is that of {}\n", rough_text(plan.fork),
                             plan.sweep.scene_file);
  else if (plan.beginning)
    std::cout << fmt::format("\nthe beginning, to {} s, is computed once: {}\n",
                             rough_text(plan.fork), duration_text(each.beginning));
  std::cout << fmt::format("\n{} {} of {}, {}, view {} in tiles of {}x{}\n", plan.runs.size(),
                           plan.runs.size() == 1 ? "run" : "runs", plan.sweep.scene_file,
                           frames_text(plan), plan.view, plan.base.size.width,
                           plan.base.size.height)
            << fmt::format(
                   "about {} on {} {}, measured now on this machine; at most {} of memory "
                   "a run\n",
                   duration_text(seconds), cores, cores == 1 ? "core" : "cores",
                   bytes_text(whole_bytes(totals.largest)))
            << longest_text(plan, each.runs)
            << (plan.keeps_states ? fmt::format("kept states take about {} on disk\n",
                                                bytes_text(whole_bytes(bytes_of_states(plan))))
                                  : "")
            << fmt::format("out: {}\n", plan.folder.string());
  if (totals.too_large > 0)
    std::cout << fmt::format(
        "{} more than [limits] memory = {} and will not be started\n",
        totals.too_large == 1 ? "1 run needs" : fmt::format("{} runs need", totals.too_large),
        bytes_text(plan.sweep.limits.memory));
}

}  // namespace neve::app::sweep::plan

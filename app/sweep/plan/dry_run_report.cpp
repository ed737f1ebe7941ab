#include "app/sweep/plan/dry_run_report.h"

#include <fmt/core.h>

#include <algorithm>
#include <iostream>

#include "app/health/checkup.h"
#include "app/support/json.h"
#include "app/support/progress.h"
#include "app/support/text.h"
#include "app/sweep/plan/labels.h"

namespace neve::app::sweep::plan {

namespace {

/// Seconds of one thread per unit of work, from a few steps of the costliest run; 0: not known.
double seconds_per_work(const SweepPlan& plan) {
  const PlannedRun* costliest = nullptr;
  for (const PlannedRun& item : plan.runs) {
    const bool is_possible =
        item.plan.memory <= item.plan.memory_limit &&
        item.plan.particles <= static_cast<double>(item.scene.limits.particles);
    if (is_possible && (!costliest || item.run.work > costliest->run.work)) costliest = &item;
  }
  if (!costliest) return 0;
  const health::Checkup checkup = health::examine(costliest->scene, costliest->plan, 1);
  // Drawing a tile takes about as long as it takes for one: 20 ms.
  constexpr double drawn = 0.02;
  return (checkup.seconds() + drawn * costliest->run.frames.count()) / costliest->run.work;
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

Totals totals_of(const SweepPlan& plan, double seconds_per_unit) {
  Totals totals;
  for (const PlannedRun& item : plan.runs) {
    const Run& run = item.run;
    totals.seconds += run.work * seconds_per_unit;
    totals.longest = std::max(totals.longest, run.work * seconds_per_unit);
    totals.largest = std::max(totals.largest, run.memory);
    totals.too_large += is_over_limit(plan, run);
  }
  return totals;
}

void print_json(const SweepPlan& plan, double seconds_per_unit, double seconds) {
  const Totals totals = totals_of(plan, seconds_per_unit);
  Json json;
  json["title"] = plan.title;
  json["scene"] = plan.sweep.scene_file;
  json["out"] = plan.folder.string();
  json["view"] = plan.view;
  json["runs"] = Json::array();
  for (const PlannedRun& item : plan.runs) {
    const Run& run = item.run;
    Json settings = Json::object();
    for (const scene::Override& setting : run.settings) settings[setting.address] = setting.value;
    json["runs"].push_back({{"run", run.index},
                            {"label", run.label},
                            {"settings", settings},
                            {"first_frame", run.frames.first},
                            {"last_frame", run.frames.last},
                            {"particles", run.particles},
                            {"memory_bytes", whole_bytes(run.memory)},
                            {"over_memory_limit", is_over_limit(plan, run)},
                            {"seconds", run.work * seconds_per_unit}});
  }
  json["memory_bytes"] = whole_bytes(totals.largest);
  json["seconds"] = seconds;
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

void print_table(const SweepPlan& plan, double seconds_per_unit) {
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
              << padded(duration_text(run.work * seconds_per_unit), 11, true)
              << (is_over_limit(plan, run) ? "  over [limits] memory" : "") << "\n";
  }
}

}  // namespace

void print_sweep_plan(const SweepPlan& plan, int cores, bool is_json) {
  const double unit = seconds_per_work(plan);
  const Totals totals = totals_of(plan, unit);
  const double seconds = std::max(totals.longest, totals.seconds / cores);
  if (is_json) return print_json(plan, unit, seconds);
  print_table(plan, unit);
  std::cout << fmt::format("\n{} {} of {}, {}, view {} in tiles of {}x{}\n", plan.runs.size(),
                           plan.runs.size() == 1 ? "run" : "runs", plan.sweep.scene_file,
                           frames_text(plan), plan.view, plan.base.size.width,
                           plan.base.size.height)
            << fmt::format(
                   "about {} on {} {}, measured now on this machine; at most {} of memory "
                   "a run\n",
                   duration_text(seconds), cores, cores == 1 ? "core" : "cores",
                   bytes_text(whole_bytes(totals.largest)))
            << fmt::format("out: {}\n", plan.folder.string());
  if (totals.too_large > 0)
    std::cout << fmt::format(
        "{} more than [limits] memory = {} and will not be started\n",
        totals.too_large == 1 ? "1 run needs" : fmt::format("{} runs need", totals.too_large),
        bytes_text(plan.sweep.limits.memory));
}

}  // namespace neve::app::sweep::plan

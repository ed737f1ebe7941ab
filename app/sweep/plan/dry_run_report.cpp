#include "app/sweep/plan/dry_run_report.h"

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
  const RunPlan* costliest = nullptr;
  for (const RunPlan& run : plan.runs) {
    const bool is_possible = run.plan.memory <= run.plan.memory_limit &&
                             run.plan.particles <= static_cast<double>(run.scene.limits.particles);
    if (is_possible && (!costliest || run.work > costliest->work)) costliest = &run;
  }
  if (!costliest) return 0;
  const health::Checkup checkup = health::examine(costliest->scene, costliest->plan, 1);
  // Drawing a tile takes about as long as it takes for one: 20 ms.
  constexpr double drawn = 0.02;
  return (checkup.seconds() + drawn * costliest->frames.count()) / costliest->work;
}

struct Totals {
  double seconds = 0;  ///< of one core
  double longest = 0;
  std::uint64_t largest = 0;  ///< bytes
  int too_large = 0;          ///< runs over [limits] memory
};

bool is_over_limit(const SweepPlan& plan, const RunPlan& run) {
  return plan.sweep.limits.memory > 0 && run.memory() > plan.sweep.limits.memory;
}

Totals totals_of(const SweepPlan& plan, double seconds_per_unit) {
  Totals totals;
  for (const RunPlan& run : plan.runs) {
    totals.seconds += run.work * seconds_per_unit;
    totals.longest = std::max(totals.longest, run.work * seconds_per_unit);
    totals.largest = std::max(totals.largest, run.memory());
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
  for (const RunPlan& item : plan.runs) {
    Json settings = Json::object();
    for (const scene::Override& setting : item.run.settings)
      settings[setting.address] = setting.value;
    json["runs"].push_back({{"run", item.run.index},
                            {"label", item.run.label},
                            {"settings", settings},
                            {"first_frame", item.frames.first},
                            {"last_frame", item.frames.last},
                            {"particles", item.plan.particles},
                            {"memory_bytes", item.memory()},
                            {"over_memory_limit", is_over_limit(plan, item)},
                            {"seconds", item.work * seconds_per_unit}});
  }
  json["memory_bytes"] = totals.largest;
  json["seconds"] = seconds;
  std::cout << to_text(json) << "\n";
}

std::string padded(const std::string& text, std::size_t width, bool to_the_right = false) {
  const std::string space(width > text.size() ? width - text.size() : 0, ' ');
  return to_the_right ? space + text : text + space;
}

/// True of all runs.
std::string frames_text(const SweepPlan& plan) {
  setup::FrameRange all = plan.runs.front().frames;
  bool is_same = true;
  for (const RunPlan& run : plan.runs) {
    is_same = is_same && run.frames.first == all.first && run.frames.last == all.last;
    all.last = std::max(all.last, run.frames.last);
  }
  return is_same ? "frames " + std::to_string(all.first) + " to " + std::to_string(all.last)
                 : "up to frame " + std::to_string(all.last);
}

void print_table(const SweepPlan& plan, double seconds_per_unit) {
  std::size_t width = 4;
  std::vector<std::string> what;
  for (const RunPlan& item : plan.runs) {
    const std::string settings = settings_text(plan, item.run);
    const bool has_both = !item.run.label.empty() && !settings.empty();
    what.push_back(item.run.label + (has_both ? ": " : "") + settings);
    width = std::max(width, std::min<std::size_t>(what.back().size(), 100));
  }
  std::cout << padded("run", 6) << padded("what", width) << "   particles     memory       time\n";
  for (std::size_t k = 0; k < plan.runs.size(); ++k) {
    const RunPlan& item = plan.runs[k];
    std::cout << padded(std::to_string(item.run.index), 6) << padded(what[k], width)
              << padded(fixed_text(item.plan.particles, 0), 12, true)
              << padded(bytes_text(item.memory()), 11, true)
              << padded(duration_text(item.work * seconds_per_unit), 11, true)
              << (is_over_limit(plan, item) ? "  over [limits] memory" : "") << "\n";
  }
}

}  // namespace

void print_sweep_plan(const SweepPlan& plan, int cores, bool is_json) {
  const double unit = seconds_per_work(plan);
  const Totals totals = totals_of(plan, unit);
  const double seconds = std::max(totals.longest, totals.seconds / cores);
  if (is_json) return print_json(plan, unit, seconds);
  print_table(plan, unit);
  std::cout << "\n"
            << plan.runs.size() << (plan.runs.size() == 1 ? " run of " : " runs of ")
            << plan.sweep.scene_file << ", " << frames_text(plan) << ", view " << plan.view
            << " in tiles of " << plan.base.size.width << "x" << plan.base.size.height << "\n"
            << "about " << duration_text(seconds) << " on " << cores
            << (cores == 1 ? " core" : " cores") << ", measured now on this machine; at most "
            << bytes_text(totals.largest) << " of memory a run\n"
            << "out: " << plan.folder.string() << "\n";
  if (totals.too_large > 0)
    std::cout << totals.too_large << (totals.too_large == 1 ? " run needs" : " runs need")
              << " more than [limits] memory = " << bytes_text(plan.sweep.limits.memory)
              << " and will not be started\n";
}

}  // namespace neve::app::sweep::plan

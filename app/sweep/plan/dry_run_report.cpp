#include "app/sweep/plan/dry_run_report.h"

#include <fmt/core.h>

#include <algorithm>
#include <iostream>
#include <numeric>
#include <string>
#include <vector>

#include "app/support/json.h"
#include "app/support/progress.h"
#include "app/support/text.h"
#include "app/sweep/plan/labels.h"
#include "app/sweep/plan/sweep_forecast.h"

namespace neve::app::sweep::plan {

namespace {

struct Totals {
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

Totals totals_of(const SweepPlan& plan) {
  Totals totals;
  for (const PlannedRun& item : plan.runs) {
    totals.largest = std::max(totals.largest, item.run.memory);
    totals.too_large += is_over_limit(plan, item.run);
  }
  return totals;
}

/// s of one thread, of all copies for the prediction.
double seconds_of_copies(const SweepPlan& plan, const SweepForecast& forecast) {
  double seconds = 0;
  for (const PlannedVariant& variant : plan.variants)
    if (variant.failure.empty())
      seconds += forecast.seconds(variant.of).expected * work_ratio(plan, variant.coarsening);
  return seconds;
}

/// s on these cores, of the runs of all rounds and of what is made besides them.
double seconds_in_all(const SweepPlan& plan, const Refinement& refinement,
                      const SweepForecast& forecast, double of_runs, int rounds, int cores) {
  return rounds * of_runs +
         (seconds_of_copies(plan, forecast) + cost_of(refinement, plan, forecast).seconds) / cores;
}

Json refinement_json(const SweepPlan& plan, const Refinement& refinement,
                     const SweepForecast& forecast) {
  const RefinementCost cost = cost_of(refinement, plan, forecast);
  return {{"points", cost.points},
          {"named", refinement.named},
          {"runs", cost.runs},
          {"seconds", cost.seconds},
          {"memory_bytes", whole_bytes(refinement.memory)}};
}

void print_json(const SweepPlan& plan, const SweepForecast& foreseen,
                const forecast::Cost& seconds_of_all, const Refinement& refinement, int rounds,
                int cores) {
  Json json;
  json["title"] = plan.title;
  json["scene"] = plan.sweep.scene_file;
  json["out"] = plan.folder.string();
  json["view"] = plan.view;
  json["seeds"] = plan.sweep.runs_per_point();
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
                            {"seconds", foreseen.seconds(k).expected}});
  }
  if (!plan.beginnings.empty())
    json["beginning"] = {{"time", plan.fork},
                         {"frame", plan.beginnings.front().run.frames.last},
                         {"seeds", plan.beginnings.size()},
                         {"seconds", foreseen.beginning.expected * foreseen.seconds_per_work}};
  if (plan.keeps_states)
    json["state_bytes"] = whole_bytes(bytes_of_states(plan) + refinement.state_bytes);
  if (!plan.variants.empty())
    json["prediction"] = {{"copies", plan.variants.size()},
                          {"seconds", seconds_of_copies(plan, foreseen)}};
  if (rounds > 1) {
    json["rounds"] = rounds;
    json["runs_in_all"] = static_cast<std::size_t>(rounds) * plan.runs.size();
  }
  if (refinement.is_wanted()) json["refinement"] = refinement_json(plan, refinement, foreseen);
  json["memory_bytes"] = whole_bytes(totals_of(plan).largest);
  json["seconds"] = seconds_of_all.expected;
  json["seconds_range"] = {seconds_of_all.least, seconds_of_all.most};
  json["seconds_in_all"] =
      seconds_in_all(plan, refinement, foreseen, seconds_of_all.expected, rounds, cores);
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

void print_table(const SweepPlan& plan, const SweepForecast& forecast) {
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
              << padded(duration_text(forecast.seconds(k).expected), 11, true)
              << (is_over_limit(plan, run) ? "  over [limits] memory" : "") << "\n";
  }
}

/// Rounds of a search, of which the table has the first.
std::string rounds_text(const SweepPlan& plan, int rounds, double seconds) {
  if (rounds == 1) return "";
  return fmt::format(
      "this is the next of {} rounds: {} runs, about {} if the others cost as much; the search may "
      "end after any of them\n",
      rounds, static_cast<std::size_t>(rounds) * plan.runs.size(), duration_text(rounds * seconds));
}

std::string copies_text(const SweepPlan& plan, const SweepForecast& forecast, int cores) {
  if (plan.variants.empty()) return "";
  return fmt::format(
      "the prediction takes {} coarse copies, {} more at most: copies that are runs "
      "of the sweep are made once\n",
      plan.variants.size(), duration_text(seconds_of_copies(plan, forecast) / cores));
}

/// Points at full resolution, which are no part of what is said of the runs.
std::string full_runs_text(const SweepPlan& plan, const Refinement& refinement,
                           const SweepForecast& forecast, int cores) {
  if (!refinement.is_wanted()) return "";
  const auto limit = static_cast<double>(plan.sweep.limits.memory);
  return fmt::format("{}; at most {} of memory a run{}\n",
                     refinement_text(refinement, plan, forecast, cores),
                     bytes_text(whole_bytes(refinement.memory)),
                     limit > 0 && refinement.memory > limit
                         ? ", over [limits] memory: such a run will not be started"
                         : "");
}

}  // namespace

void print_sweep_plan(const SweepPlan& plan, const Refinement& refinement, int rounds, int cores,
                      bool is_json) {
  std::vector<std::size_t> all(plan.runs.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  const SweepForecast forecast = foresee_sweep(plan, all, whole_effort(cores), cores);
  const Totals totals = totals_of(plan);
  const auto seconds = forecast.seconds_of_all(all, cores);
  if (is_json) return print_json(plan, forecast, seconds, refinement, rounds, cores);
  print_table(plan, forecast);
  const std::string longest = longest_text(plan, all, forecast);
  if (plan.source)
    std::cout << fmt::format("\nthe beginning, to {} s, is that of {}\n", rough_text(plan.fork),
                             plan.sweep.scene_file);
  else if (!plan.beginnings.empty())
    std::cout << fmt::format(
        "\nthe beginning, to {} s, is computed once{}: {}\n", rough_text(plan.fork),
        plan.beginnings.size() > 1
            ? fmt::format(" for each of the {} seeds", plan.beginnings.size())
            : "",
        duration_text(forecast.beginning.expected * forecast.seconds_per_work));
  std::cout << fmt::format("\n{} of {}{}, {}, view {} in tiles of {}x{}\n",
                           count_text(plan.runs.size(), "run"), plan.sweep.scene_file,
                           seeds_text(plan.sweep), frames_text(plan), plan.view,
                           plan.base.size.width, plan.base.size.height)
            << fmt::format(
                   "about {} on {}, measured now on this machine; at most {} of memory "
                   "a run\n",
                   duration_text(seconds.expected), count_text(cores, "core"),
                   bytes_text(whole_bytes(totals.largest)))
            << rounds_text(plan, rounds, seconds.expected) << copies_text(plan, forecast, cores)
            << full_runs_text(plan, refinement, forecast, cores)
            << (plan.variants.empty() && !refinement.is_wanted() && rounds == 1
                    ? ""
                    : fmt::format("in all about {}\n",
                                  duration_text(seconds_in_all(plan, refinement, forecast,
                                                               seconds.expected, rounds, cores))))
            << (longest.empty() ? "" : longest + "\n")
            << (plan.keeps_states
                    ? fmt::format(
                          "kept states take about {} on disk\n",
                          bytes_text(whole_bytes(bytes_of_states(plan) + refinement.state_bytes)))
                    : "")
            << fmt::format("out: {}\n", plan.folder.string());
  if (totals.too_large > 0)
    std::cout << fmt::format(
        "{} more than [limits] memory = {} and will not be started\n",
        totals.too_large == 1 ? "1 run needs" : fmt::format("{} runs need", totals.too_large),
        bytes_text(plan.sweep.limits.memory));
}

}  // namespace neve::app::sweep::plan

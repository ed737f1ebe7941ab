#include "app/sweep/plan/expand.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <iterator>
#include <numeric>

#include "app/scene/describe.h"
#include "app/scene/params.h"
#include "app/support/errors.h"
#include "app/support/text.h"
#include "app/sweep/plan/designs.h"
#include "app/sweep/read/condition.h"
#include "sim/base/hash.h"

namespace neve::app::sweep::plan {

namespace {

double six_digits(double x) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", x);
  return std::strtod(text, nullptr);
}

/// The value at a place between 0 and 1 of a distribution.
double drawn_value(const read::AxisRule& spec, double u) {
  if (spec.uniform) return spec.uniform->first + u * (spec.uniform->last - spec.uniform->first);
  if (spec.log_uniform)
    return spec.log_uniform->first * std::pow(spec.log_uniform->last / spec.log_uniform->first, u);
  return spec.normal->first + spec.normal->last * normal_quantile(std::clamp(u, 1e-9, 1 - 1e-9));
}

void append_value(Run& run, const read::Axis& axis, std::size_t value) {
  for (const read::Axis::Parameter& parameter : axis.parameters)
    run.settings.push_back(parameter.values[value]);
  if (axis.value_labels.empty()) return;
  run.label += (run.label.empty() ? "" : ", ") + axis.value_labels[value];
}

/// The entry of a list at a place, 0 to 1.
std::size_t entry_at(const read::Axis& axis, double u) {
  const auto count = static_cast<double>(axis.size());
  return static_cast<std::size_t>(std::min(u * count, count - 1));
}

bool is_whole(const read::Axis::Parameter& parameter) {
  const std::optional<scene::ParamInfo> info = scene::param_at(parameter.address);
  return info && info->type == "integer";
}

/// The value of a drawn axis at a place, as runs have it; both ends are among its values.
double value_at(const read::Axis::Parameter& parameter, double u) {
  const double x = drawn_value(*parameter.drawn, u);
  return is_whole(parameter) ? std::round(x) : six_digits(x);
}

/// Returns the value at u, as value_at(), but each whole number between the ends is as likely as
/// its share of the axis: value_at() rounds to the first and the last from one side only.
double sample_at(const read::Axis::Parameter& parameter, double u) {
  const read::AxisRule& rule = *parameter.drawn;
  const std::optional<read::Ends>& ends = rule.log_uniform ? rule.log_uniform : rule.uniform;
  if (!ends || !is_whole(parameter)) return value_at(parameter, u);
  const double first = std::ceil(ends->first), last = std::floor(ends->last);
  if (first > last) return value_at(parameter, u);
  const double low = first - 0.5, high = last + 0.5;
  const double x = rule.log_uniform ? std::round(low * std::pow(high / low, u))
                                    : std::floor(first + u * (last + 1 - first));
  return std::clamp(x, first, last);
}

/// @param value_of  value_at() or sample_at() @param u place on the axis, 0 to 1
template <class F>
void append_at(Run& run, const read::Axis& axis, double u, const F& value_of) {
  const read::Axis::Parameter& parameter = axis.parameters.front();
  if (!parameter.drawn) return append_value(run, axis, entry_at(axis, u));
  scene::Override setting = parameter.values.front();
  setting.value = scene::toml::number_text(value_of(parameter, u));
  run.settings.push_back(setting);
}

/// Samples in a random order, the same for the same seed and axis.
std::vector<std::size_t> shuffled(std::size_t count, std::uint64_t seed) {
  std::vector<std::size_t> order(count);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return mix64(seed, a) < mix64(seed, b); });
  return order;
}

/// A sample of a method that draws each sample by itself.
Run sample(const read::Sweep& sweep, std::uint32_t k) {
  Run run;
  for (std::size_t a = 0; a < sweep.axes.size(); ++a) {
    const std::uint64_t seed = mix64(sweep.settings.seed, a);
    append_at(run, sweep.axes[a],
              sweep.settings.method == read::Method::sobol ? sobol_place(k, a, sweep.settings.seed)
                                                           : unit_double(mix64(seed + 1, k)),
              sample_at);
  }
  return run;
}

std::vector<Run> latin_hypercube(const read::Sweep& sweep) {
  const auto count = static_cast<std::size_t>(sweep.settings.samples);
  std::vector<Run> runs(count);
  for (std::size_t a = 0; a < sweep.axes.size(); ++a) {
    const std::uint64_t seed = mix64(sweep.settings.seed, a);
    const std::vector<std::size_t> stratum = shuffled(count, seed);
    const read::Axis& axis = sweep.axes[a];
    // A list that is no longer than the samples gives each entry as often as the others, or once
    // more: with places at random within their parts an entry could be left out.
    const bool is_short_list = !axis.parameters.front().drawn && axis.size() <= count;
    for (std::size_t k = 0; k < count; ++k) {
      const double within = is_short_list ? 0.5 : unit_double(mix64(seed + 1, k));
      append_at(runs[k], axis,
                (static_cast<double>(stratum[k]) + within) / static_cast<double>(count), sample_at);
    }
  }
  return runs;
}

/// The place of a level of a screening on its axis, 0 to 1.
double place_of_level(const read::Axis& axis, int level) {
  // Ends of a normal distribution are infinite: its levels lie between these shares.
  constexpr double first_share = 0.05, last_share = 0.95;
  const double place = static_cast<double>(level) / (morris_levels - 1);
  const std::optional<read::AxisRule>& drawn = axis.parameters.front().drawn;
  return drawn && drawn->normal ? first_share + place * (last_share - first_share) : place;
}

/// The runs of a trajectory, with their levels as coordinates.
std::vector<Run> trajectory(const read::Sweep& sweep, std::uint32_t k) {
  std::vector<Run> runs;
  for (const std::vector<int>& levels :
       morris_trajectory(k, sweep.axes.size(), sweep.settings.seed)) {
    Run& run = runs.emplace_back();
    run.coordinates = levels;
    for (std::size_t a = 0; a < levels.size(); ++a)
      append_at(run, sweep.axes[a], place_of_level(sweep.axes[a], levels[a]), value_at);
  }
  return runs;
}

bool meets(const Run& run, const std::vector<read::Condition>& conditions) {
  return std::all_of(conditions.begin(), conditions.end(), [&](const read::Condition& condition) {
    return condition.holds([&](const std::string& address) { return run.setting(address); });
  });
}

/// Draws until as many as wanted meet the conditions; those that do not are left out, and the
/// others stay the same whatever their number.
std::vector<Run> drawn(const read::Sweep& sweep, const std::vector<read::Condition>& conditions) {
  if (sweep.settings.method == read::Method::lhs) return latin_hypercube(sweep);
  constexpr std::uint32_t max_tries = 1000;  // for each that is wanted
  const bool is_screening = sweep.settings.method == read::Method::morris;
  const auto wanted = static_cast<std::uint32_t>(sweep.settings.samples);
  std::vector<Run> runs;
  std::uint32_t found = 0;
  for (std::uint32_t k = 0; found < wanted; ++k) {
    if (k / max_tries > found)
      sweep.fail("sweep.where", fmt::format("only {} of {} samples meet the conditions", found, k),
                 "make the conditions weaker, or the axes narrower where they rule runs out");
    std::vector<Run> next =
        is_screening ? trajectory(sweep, k) : std::vector<Run>{sample(sweep, k)};
    if (!std::all_of(next.begin(), next.end(),
                     [&](const Run& run) { return meets(run, conditions); }))
      continue;
    ++found;
    std::move(next.begin(), next.end(), std::back_inserter(runs));
  }
  return runs;
}

std::vector<Run> zipped(const read::Sweep& sweep) {
  std::vector<Run> runs(sweep.axes.empty() ? 0 : sweep.axes.front().size());
  for (std::size_t k = 0; k < runs.size(); ++k)
    for (const read::Axis& axis : sweep.axes) append_value(runs[k], axis, k);
  return runs;
}

std::vector<Run> combined(const read::Sweep& sweep) {
  std::vector<Run> runs;
  if (sweep.axes.empty()) return runs;
  std::vector<int> at(sweep.axes.size(), 0);
  while (true) {
    Run& run = runs.emplace_back();
    run.coordinates = at;
    for (std::size_t a = 0; a < at.size(); ++a)
      append_value(run, sweep.axes[a], static_cast<std::size_t>(at[a]));
    std::size_t a = at.size();
    while (a > 0 && ++at[a - 1] == static_cast<int>(sweep.axes[a - 1].size())) at[--a] = 0;
    if (a == 0) return runs;
  }
}

/// Counts the runs before anything is made; a double, so that absurd grids do not overflow it.
double count_of(const read::Sweep& sweep) {
  const auto rows = static_cast<double>(sweep.rows.size());
  double count = 0;
  switch (sweep.settings.method) {
    case read::Method::grid:
      count = sweep.axes.empty() ? 0 : 1;
      for (const read::Axis& axis : sweep.axes) count *= static_cast<double>(axis.size());
      break;
    case read::Method::zip:
      count = sweep.axes.empty() ? 0 : static_cast<double>(sweep.axes.front().size());
      break;
    case read::Method::random:
    case read::Method::lhs:
    case read::Method::sobol:
      count = sweep.settings.samples;
      break;
    case read::Method::morris:
      count = sweep.settings.samples * (static_cast<double>(sweep.axes.size()) + 1);
      break;
    case read::Method::list:
      break;
  }
  return (count + rows) * sweep.runs_per_point();
}

/// Axes of the command line come after the file was checked.
void check_axes(const read::Sweep& sweep) {
  const bool is_drawing = read::draws(sweep.settings.method);
  if (sweep.settings.method == read::Method::sobol && sweep.axes.size() > max_sobol_axes)
    sweep.fail("sweep.method",
               fmt::format("method \"sobol\" has at most {} axes, not {}", max_sobol_axes,
                           sweep.axes.size()),
               "use method \"lhs\"");
  for (const read::Axis& axis : sweep.axes) {
    const scene::Override& first = axis.parameters.front().values.front();
    if (axis.parameters.front().drawn && !is_drawing)
      first.fail(first.place, axis.parameters.front().address + " is drawn",
                 "that needs a sweep file with method \"random\", \"lhs\", \"sobol\" or "
                 "\"morris\"");
    if (sweep.settings.method == read::Method::list)
      first.fail(first.key, "method \"list\" has no axes, only [[run]]s");
    if (sweep.settings.method == read::Method::zip && axis.size() != sweep.axes.front().size())
      first.fail(first.place, axis.parameters.front().address + " has a different number of values",
                 "method \"zip\" needs the same number on all axes");
  }
}

/// True for a list of numbers from a larger one to a smaller one.
bool is_falling_list(const read::Axis::Parameter& parameter) {
  if (parameter.drawn || parameter.values.empty()) return false;
  const std::optional<double> first = finite_number(parameter.values.front().value),
                              last = finite_number(parameter.values.back().value);
  return first && last && *last < *first;
}

}  // namespace

std::vector<double> level_shares(const read::Axis& axis) {
  const read::Axis::Parameter& parameter = axis.parameters.front();
  const auto value = [&](int level) {
    const double place = place_of_level(axis, level);
    return parameter.drawn ? value_at(parameter, place)
                           : static_cast<double>(entry_at(axis, place));
  };
  const double first = value(0), last = value(morris_levels - 1);
  const bool is_logarithmic = parameter.drawn && parameter.drawn->log_uniform && first > 0;
  std::vector<double> shares;
  for (int level = 0; level < morris_levels; ++level) {
    const double x = value(level);
    shares.push_back(!(last > first)  ? 0
                     : is_logarithmic ? std::log(x / first) / std::log(last / first)
                                      : (x - first) / (last - first));
  }
  if (last > first && is_falling_list(parameter))
    for (double& share : shares) share = 1 - share;
  return shares;
}

double normal_quantile(double p) {
  double low = -8, high = 8;
  for (int k = 0; k < 64; ++k) {
    const double middle = 0.5 * (low + high);
    (0.5 * std::erfc(-middle / std::sqrt(2.0)) < p ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

std::vector<Run> expand(const read::Sweep& sweep) {
  check_axes(sweep);
  const double count = count_of(sweep);
  const bool has_seeds = sweep.settings.seeds > 0;
  const std::string fewer = has_seeds ? "fewer seeds" : "method \"lhs\" with samples";
  if (count > read::max_runs)
    throw LimitError(
        fmt::format("refused: {} runs are more than the {} of the largest sweep; use {}",
                    count < 1e15 ? fixed_text(count, 0) : scene::toml::number_text(count),
                    read::max_runs, fewer),
        "limits.runs", "use " + fewer);
  if (count > sweep.limits.runs)
    throw LimitError(
        fmt::format("refused: {} runs{} are more than limits.runs = {}; raise it in the sweep "
                    "file, or use {}",
                    count < 1e15 ? fixed_text(count, 0) : scene::toml::number_text(count),
                    has_seeds ? fmt::format(", {} of each point,", sweep.settings.seeds) : "",
                    sweep.limits.runs, fewer),
        "limits.runs", "raise limits.runs, or use " + fewer);
  const std::vector<read::Condition> conditions = read::conditions_of(sweep);
  std::vector<Run> runs;
  switch (sweep.settings.method) {
    case read::Method::grid:
      runs = combined(sweep);
      break;
    case read::Method::zip:
      runs = zipped(sweep);
      break;
    case read::Method::random:
    case read::Method::lhs:
    case read::Method::sobol:
    case read::Method::morris:
      runs = drawn(sweep, conditions);
      break;
    case read::Method::list:
      break;
  }
  std::erase_if(runs, [&](const Run& run) { return !meets(run, conditions); });
  if (runs.empty() && !conditions.empty())
    sweep.fail("sweep.where", "no run meets the conditions", "make them weaker, or the axes wider");
  runs.insert(runs.end(), sweep.rows.begin(), sweep.rows.end());
  for (std::size_t k = 0; k < runs.size(); ++k) runs[k].index = static_cast<int>(k);
  return runs;
}

std::vector<Run> with_seeds(const std::vector<Run>& points, std::uint64_t first, int seeds) {
  if (static_cast<double>(first) + seeds > scene::max_count)
    throw UsageError("--seeds", fmt::format("{} seeds from {} on are beyond 2^53", seeds, first),
                     "set a smaller seed");
  std::vector<Run> runs;
  for (const Run& point : points)
    for (int k = 0; k < seeds; ++k) {
      Run& run = runs.emplace_back(point);
      run.index = static_cast<int>(runs.size()) - 1;
      run.settings.push_back(
          {"seed", std::to_string(first + static_cast<std::uint64_t>(k)), "--seeds"});
    }
  return runs;
}

}  // namespace neve::app::sweep::plan

#include "app/sweep/plan/around.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <optional>

#include "app/options/arguments.h"
#include "app/scene/params.h"
#include "app/support/errors.h"
#include "app/sweep/plan/sweep_options.h"

namespace neve::app::sweep::plan {

namespace {

constexpr int steps_each_way = 2;

std::optional<double> double_of(const std::optional<scene::toml::Value>& value) {
  if (!value) return std::nullopt;
  if (const auto* whole = std::get_if<std::int64_t>(&value->data))
    return static_cast<double>(*whole);
  if (const auto* x = std::get_if<double>(&value->data)) return *x;
  return std::nullopt;
}

/// Rounds to three significant digits, as people write numbers.
double three_digits(double x) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", x);
  return std::strtod(text, nullptr);
}

/// x moved into the bounds; an open bound is not reached by a tenth of the way from `from`.
double inside(const scene::Valid& valid, double x, double from) {
  if (x <= valid.min) return valid.is_min_open ? from + 0.9 * (valid.min - from) : valid.min;
  if (x >= valid.max) return valid.is_max_open ? from + 0.9 * (valid.max - from) : valid.max;
  return x;
}

bool do_ratios_matter(const scene::FlatParam& param, double x) {
  return x > 0 && scene::spans_decades(param.valid, double_of(param.default_value));
}

/// Distance of the outer values from a number: half of it, or of its known scale.
double reach(const scene::FlatParam& param, double x) {
  constexpr double usual_memory = 0x1p33;
  if (x != 0) return 0.5 * std::abs(x);
  if (std::string_view(param.unit) == "B") return usual_memory;
  const double usual = double_of(param.default_value).value_or(0);
  return usual != 0 ? std::abs(usual) : 1;
}

std::vector<double> numbers_around(const scene::FlatParam& param, double x) {
  std::vector<double> numbers{x};
  const bool is_whole = param.type == "integer";
  const auto add = [&](double candidate) {
    const double nice = is_whole ? std::round(candidate) : three_digits(candidate);
    numbers.push_back(param.valid.contains(nice) ? nice : candidate);
  };
  if (do_ratios_matter(param, x) && !is_whole) {
    const double ratio = std::string_view(param.unit) == "Pa" ? std::sqrt(10.0) : 2;
    for (int k = 1; k <= steps_each_way; ++k)
      for (const double candidate : {x * std::pow(ratio, k), x * std::pow(ratio, -k)})
        if (param.valid.contains(candidate)) add(candidate);
  } else {
    const double far = is_whole ? std::max(2.0, std::round(reach(param, x))) : reach(param, x);
    const double high = inside(param.valid, x + far, x), low = inside(param.valid, x - far, x);
    // Without room on one side all steps go to the other.
    const int up = low == x ? 2 * steps_each_way : steps_each_way;
    const int down = high == x ? 2 * steps_each_way : steps_each_way;
    for (int k = 1; k <= up && high > x; ++k) add(x + (high - x) * k / up);
    for (int k = 1; k <= down && low < x; ++k) add(x + (low - x) * k / down);
  }
  std::sort(numbers.begin(), numbers.end());
  numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
  return numbers;
}

scene::toml::Value value_of(const scene::FlatParam& param, double x) {
  if (param.type == "integer") return {static_cast<std::int64_t>(x)};
  return {x};
}

[[noreturn]] void refuse(const scene::FlatParam& param, const std::string& why) {
  throw UsageError(param.address, "no values can be chosen around it: " + why,
                   "choose a number, a choice, or a vector other than zero");
}

std::vector<scene::toml::Value> vectors_around(const scene::FlatParam& param,
                                               const scene::toml::Array& array) {
  std::vector<scene::toml::Value> vectors;
  bool is_zero = true;
  for (const scene::toml::Value& item : array)
    is_zero = is_zero && double_of(item).value_or(0) == 0;
  if (is_zero) refuse(param, "it is a vector of zeros");
  for (const double factor : {0.5, 0.75, 1.0, 1.25, 1.5}) {
    scene::toml::Array scaled;
    bool is_valid = true;
    for (const scene::toml::Value& item : array) {
      const double x = double_of(item).value_or(0);
      const double stretched = factor == 1 ? x : three_digits(factor * x);
      scaled.emplace_back().data = stretched;
      is_valid = is_valid && param.valid.contains(stretched);
    }
    if (is_valid) vectors.emplace_back().data = std::move(scaled);
  }
  return vectors;
}

std::string relative_to(const std::string& scene_file, const std::string& sweep_file) {
  namespace fs = std::filesystem;
  const fs::path folder = fs::absolute(sweep_file).lexically_normal().parent_path();
  const fs::path scene = fs::absolute(scene_file).lexically_normal();
  const fs::path relative = scene.lexically_relative(folder);
  return relative.empty() ? scene.generic_string() : relative.generic_string();
}

/// The value of a --set as a sweep file writes it.
std::string literal_of(const scene::Override& change) {
  const std::optional<scene::ParamInfo> info = scene::param_at(change.address);
  return scene::toml::toml_literal(scene::value_of(change, info ? info->type : "table"));
}

}  // namespace

std::vector<scene::toml::Value> values_around(const scene::FlatParam& param) {
  std::vector<scene::toml::Value> values;
  if (param.type == "choice") {
    for (const std::string& choice : param.choices) values.emplace_back().data = choice;
    return values;
  }
  if (const std::optional<double> x = double_of(param.value)) {
    for (const double number : numbers_around(param, *x)) values.push_back(value_of(param, number));
    return values;
  }
  const scene::toml::Array* array =
      param.value ? std::get_if<scene::toml::Array>(&param.value->data) : nullptr;
  if (param.type == "vector" && array) return vectors_around(param, *array);
  refuse(param, param.value ? "it is a " + param.type : "it has no value of its own");
}

std::string sweep_command(const std::string& sweep_file, double coarsening) {
  SweepOptions options;
  options.file = sweep_file;
  if (coarsening > 1) options.coarsening = coarsening;
  return options::shell_line(options::words_of(options));
}

std::string sweep_around(const std::string& scene_file, const std::string& sweep_file,
                         const scene::FlatParam& param, const std::vector<scene::Override>& set,
                         double coarsening, const std::vector<std::string>& set_later) {
  const std::vector<scene::toml::Value> values = values_around(param);
  const std::string scene = relative_to(scene_file, sweep_file);
  std::string text = "# Effect of " + param.address + " around its value of " + param.text() +
                     (*param.unit ? std::string(" ") + param.unit : "") + ".\n# " + param.help +
                     "\n#   " + sweep_command(sweep_file, coarsening) + "\n";
  if (!set_later.empty()) {
    text +=
        "# Changed during the run. Here they are start values of all runs, so no run repeats that "
        "one:";
    for (const std::string& address : set_later) text += "\n#   " + address;
    text += "\n";
  }
  text += "\n[sweep]\nscene = " + scene::toml::toml_string(scene) + "\n";
  std::string fixed;
  for (std::size_t k = 0; k < set.size(); ++k) {
    const auto is_same = [&](const scene::Override& later) {
      return later.address == set[k].address;
    };
    const auto next = set.begin() + static_cast<std::ptrdiff_t>(k) + 1;
    const bool is_last = std::none_of(next, set.end(), is_same);
    if (is_last && set[k].address != param.address)
      fixed += scene::toml::toml_string(set[k].address) + " = " + literal_of(set[k]) + "\n";
  }
  if (!fixed.empty()) text += "\n[set]                        # the same in all runs\n" + fixed;
  return text + "\n[axis]\n" + scene::toml::toml_string(param.address) + " = " +
         scene::toml::toml_literal({scene::toml::Array(values)}) + "\n";
}

}  // namespace neve::app::sweep::plan

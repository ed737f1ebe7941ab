#include "app/pick/axes.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string_view>

#include "app/scene/params.h"
#include "app/support/errors.h"
#include "app/support/text.h"
#include "app/sweep/plan/labels.h"

namespace neve::app::pick {

namespace {

constexpr double decade = 10;

[[noreturn]] void refuse_axis(const std::string& address, const std::string& why) {
  throw UsageError("-p " + address, why,
                   "expected two numbers, as in -p material.snow.hardening=5,20");
}

/// Numbers of a list. @throws UsageError
std::vector<double> numbers_of(const sweep::read::Axis::Parameter& parameter) {
  std::vector<double> numbers;
  for (const scene::Override& setting : parameter.values) {
    const std::optional<double> x = number_of(setting.value);
    if (!x) refuse_axis(parameter.address, "\"" + setting.value + "\" is not a number");
    numbers.push_back(*x);
  }
  return numbers;
}

PickAxis axis_of(const sweep::read::Axis::Parameter& parameter) {
  PickAxis axis;
  axis.address = parameter.address;
  const std::optional<scene::ParamInfo> info = scene::param_at(parameter.address);
  if (info && info->type != "number" && info->type != "integer")
    refuse_axis(axis.address, "is a " + info->type + "; a search needs numbers");
  if (info) axis.unit = info->unit;
  axis.is_whole = info && info->type == "integer";
  if (parameter.drawn && parameter.drawn->normal)
    refuse_axis(axis.address, "a normal distribution has no ends");
  if (parameter.drawn) {
    axis.is_logarithmic = parameter.drawn->log_uniform.has_value();
    const sweep::read::Ends ends =
        axis.is_logarithmic ? *parameter.drawn->log_uniform : *parameter.drawn->uniform;
    axis.low = ends.first;
    axis.high = ends.last;
    return axis;
  }
  const std::vector<double> numbers = numbers_of(parameter);
  axis.low = *std::min_element(numbers.begin(), numbers.end());
  axis.high = *std::max_element(numbers.begin(), numbers.end());
  if (!(axis.low < axis.high)) refuse_axis(axis.address, "has only one value, so it does not vary");
  axis.is_logarithmic = axis.low > 0 && axis.high / axis.low >= decade;
  return axis;
}

}  // namespace

double PickAxis::value(double u) const {
  const double x = is_logarithmic ? low * std::pow(high / low, u) : low + u * (high - low);
  return is_whole ? std::round(x) : std::clamp(x, low, high);
}

std::string PickAxis::text(double u) const {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", value(u));
  return scene::toml::number_text(number_of(text).value_or(0));
}

std::string with_two_ends(const std::string& axis) {
  const std::size_t equals = axis.find('=');
  if (equals == std::string::npos) return axis;
  const std::string values = axis.substr(equals + 1);
  for (const std::string_view between : {"..", ":", "-"})
    for (std::size_t at = values.find(between, 1); at != std::string::npos;
         at = values.find(between, at + 1)) {
      const std::string low = values.substr(0, at), high = values.substr(at + between.size());
      if (number_of(low) && number_of(high)) return axis.substr(0, equals + 1) + low + "," + high;
    }
  return axis;
}

std::vector<PickAxis> axes_of(const sweep::read::Sweep& sweep) {
  std::vector<PickAxis> axes;
  std::vector<std::string> addresses;
  for (const sweep::read::Axis& axis : sweep.axes) {
    axes.push_back(axis_of(axis.parameters.front()));
    addresses.push_back(axes.back().address);
  }
  if (axes.size() > max_axes)
    throw UsageError(
        "-p", fmt::format("{} parameters are too many to find by eye", axes.size()),
        fmt::format("expected at most {}; neve sweep with method = \"morris\" finds those that "
                    "matter",
                    max_axes));
  const std::vector<std::string> names = sweep::plan::short_names(addresses);
  for (std::size_t k = 0; k < axes.size(); ++k) axes[k].name = names[k];
  return axes;
}

std::vector<scene::Override> settings_at(const std::vector<PickAxis>& axes,
                                         const search::Point& place) {
  std::vector<scene::Override> settings;
  for (std::size_t k = 0; k < axes.size(); ++k)
    settings.push_back({axes[k].address, axes[k].text(place[static_cast<Eigen::Index>(k)]), "-p"});
  return settings;
}

}  // namespace neve::app::pick

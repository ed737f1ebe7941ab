#include "app/sweep/plan/labels.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "app/scene/params.h"
#include "app/scene/toml/toml_source.h"
#include "app/scene/toml/value.h"
#include "app/support/text.h"

namespace neve::app::sweep::plan {

namespace {

/// The last `words` words of an address.
std::string tail(const std::string& address, int words) {
  std::size_t from = address.size();
  for (int k = 0; k < words && from != std::string::npos; ++k)
    from = from == 0 ? std::string::npos : address.rfind('.', from - 1);
  return from == std::string::npos ? address : address.substr(from + 1);
}

}  // namespace

std::vector<std::string> short_names(const std::vector<std::string>& addresses) {
  std::vector<std::string> names;
  for (const std::string& address : addresses) {
    std::string name;
    for (int words = 1; words <= 8; ++words) {
      name = tail(address, words);
      const auto alike = std::count_if(addresses.begin(), addresses.end(), [&](const auto& other) {
        return other != address && tail(other, words) == name;
      });
      if (alike == 0) break;
    }
    names.push_back(name);
  }
  return names;
}

std::string value_text(const std::string& value) {
  const std::optional<double> number = number_of(value);
  if (!number) return scene::toml::unquoted(value);
  const double x = *number;
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", x);
  const double rounded = std::strtod(text, nullptr);
  // Computed values have all digits that a number can have; those that somebody wrote are kept.
  constexpr std::ptrdiff_t max_written = 12;
  const std::string exact = scene::toml::number_text(x);
  const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
  if (rounded != x && std::ranges::count_if(exact, is_digit) <= max_written) return exact;
  const std::string plain = scene::toml::number_text(rounded);
  // 1.4e5, not 140000.
  if (plain.size() < 6 || std::abs(x) < 1e5) return plain;
  const int power = static_cast<int>(std::floor(std::log10(std::abs(x))));
  std::snprintf(text, sizeof text, "%.6g", x / std::pow(10, power));
  return std::string(text) + "e" + std::to_string(power);
}

std::string titled(const std::string& title, const std::string& unit) {
  return title + (unit.empty() ? "" : " (" + unit + ")");
}

std::vector<Parameter> varied_parameters(const SweepPlan& plan) {
  std::vector<std::string> addresses;
  for (const PlannedRun& item : plan.runs)
    for (const scene::Override& setting : item.run.settings)
      if (std::find(addresses.begin(), addresses.end(), setting.address) == addresses.end())
        addresses.push_back(setting.address);
  std::vector<std::string> names = short_names(addresses);
  for (const read::Axis& axis : plan.sweep.axes)
    for (const read::Axis::Parameter& parameter : axis.parameters)
      for (std::size_t k = 0; k < addresses.size(); ++k)
        if (addresses[k] == parameter.address && !parameter.label.empty())
          names[k] = parameter.label;
  std::vector<Parameter> varied;
  for (std::size_t k = 0; k < addresses.size(); ++k) {
    const std::optional<scene::ParamInfo> info = scene::param_at(addresses[k]);
    varied.push_back(
        {addresses[k], names[k], info ? info->unit : "", info ? info->type : "string"});
  }
  return varied;
}

std::string settings_text(const SweepPlan& plan, const Run& run) {
  std::string text;
  for (const Parameter& parameter : varied_parameters(plan)) {
    const std::string value = run.setting(parameter.address);
    if (value.empty()) continue;
    text += (text.empty() ? "" : ", ") + parameter.name + " = " + value_text(value);
    if (!parameter.unit.empty()) text += " " + parameter.unit;
  }
  return text;
}

}  // namespace neve::app::sweep::plan

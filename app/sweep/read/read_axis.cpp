#include "app/sweep/read/read_axis.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <optional>

#include "app/scene/params.h"
#include "app/scene/reader.h"
#include "app/scene/toml/error.h"
#include "app/scene/toml/toml_source.h"
#include "app/support/errors.h"
#include "app/support/text.h"
#include "app/sweep/read/describe_sweep.h"
#include "app/sweep/read/sweep_leaf.h"

namespace neve::app::sweep::read {

namespace {

constexpr std::size_t max_values = 100'000;

std::vector<std::string> rule_names() {
  scene::Keys keys;
  AxisRule spec;
  describe(keys, spec);
  return keys.keys;
}

/// Things of a scene may have the name of a word of rules, and so may parameters: a slice has a
/// normal.
bool is_rule(const scene::toml::Table& table, const std::string& address) {
  const std::vector<std::string> names = rule_names();
  return std::any_of(table.entries.begin(), table.entries.end(),
                     [&](const scene::toml::Entry& entry) {
                       return std::find(names.begin(), names.end(), entry.key) != names.end() &&
                              !std::holds_alternative<scene::toml::Table>(entry.value.data) &&
                              !scene::param_at(address + "." + entry.key);
                     });
}

void collect_addresses(const scene::toml::Table& table, const std::string& prefix, bool has_rules,
                       std::vector<scene::toml::Entry>& found) {
  for (const scene::toml::Entry& entry : table.entries) {
    const std::string address = prefix.empty() ? entry.key : prefix + "." + entry.key;
    const scene::toml::Table* inner = std::get_if<scene::toml::Table>(&entry.value.data);
    const bool is_quoted = entry.key.find('.') != std::string::npos;
    if (inner && !is_quoted && !(has_rules && is_rule(*inner, address)))
      collect_addresses(*inner, address, has_rules, found);
    else
      found.push_back({address, entry.where, entry.value});
  }
}

/// Twelve digits: 0.3, not 0.30000000000000004.
double rounded(double x) {
  char text[32];
  std::snprintf(text, sizeof text, "%.12g", x);
  return std::strtod(text, nullptr);
}

std::vector<scene::toml::Value> spaced(const Ends& ends, int num, bool is_logarithmic) {
  std::vector<scene::toml::Value> values;
  for (int k = 0; k < num; ++k) {
    const double part = num > 1 ? static_cast<double>(k) / (num - 1) : 0;
    const double x = is_logarithmic ? ends.first * std::pow(ends.last / ends.first, part)
                                    : ends.first + part * (ends.last - ends.first);
    values.push_back({rounded(x)});
  }
  return values;
}

std::vector<scene::toml::Value> counted(const WholeRange& range) {
  std::vector<scene::toml::Value> values;
  const std::int64_t count = (range.last - range.first) / range.step + 1;
  for (std::int64_t k = 0; k < std::min<std::int64_t>(count, max_values + 1); ++k)
    values.push_back({range.first + k * range.step});
  return values;
}

int kinds_given(const AxisRule& s) {
  return s.values.has_value() + s.linspace.has_value() + s.logspace.has_value() +
         s.range.has_value() + s.uniform.has_value() + s.log_uniform.has_value() +
         s.normal.has_value();
}

/// numpy's logspace takes exponents: 4 to 6 Pa is snow of nobody.
void refuse_exponents(const Ends& ends, const std::string& address, const scene::Source& source,
                      scene::toml::Location where) {
  const auto is_exponent = [](double x) { return x == std::round(x) && std::abs(x) <= 12; };
  const std::optional<scene::ParamInfo> info = scene::param_at(address);
  if (!is_exponent(ends.first) || !is_exponent(ends.last) || !info || !info->default_value) return;
  const double* usual = std::get_if<double>(&info->default_value->data);
  constexpr double far = 1000;  // from the usual value
  const double largest = std::max(ends.first, ends.last);
  if (!usual || !(std::abs(*usual) > far * std::max(1.0, largest))) return;
  source.fail(
      where,
      fmt::format("logspace = [{}, {}] has the ends themselves, no exponents",
                  scene::toml::number_text(ends.first), scene::toml::number_text(ends.last)),
      fmt::format("write [{}, {}]", scene::toml::number_text(std::pow(10, ends.first)),
                  scene::toml::number_text(std::pow(10, ends.last))));
}

/// @param where for complaints
std::vector<scene::toml::Value> values_of(const AxisRule& spec, const std::string& address,
                                          const scene::Source& source,
                                          scene::toml::Location where) {
  if (spec.values) return spec.values->items;
  if (spec.range) return counted(*spec.range);
  const bool is_spaced = spec.linspace || spec.logspace;
  if (is_spaced && spec.num == 0)
    source.fail(where, "num is missing",
                "linspace and logspace need the number of values, as num = 4");
  if (spec.logspace) refuse_exponents(*spec.logspace, address, source, where);
  if (spec.linspace) return spaced(*spec.linspace, spec.num, false);
  return spec.logspace ? spaced(*spec.logspace, spec.num, true) : std::vector<scene::toml::Value>{};
}

/// A text that looks like a number is that text wherever it is shown or compared: 1.10 is not 1.1.
void quote_numbers(Axis::Parameter& parameter) {
  const std::optional<scene::ParamInfo> info = scene::param_at(parameter.address);
  if (!info || info->type != "string") return;
  for (scene::Override& setting : parameter.values)
    if (const std::string text = trimmed(setting.value); number_of(text))
      setting.value = scene::toml::toml_string(text);
}

scene::Override override_of(const scene::Source& source, const scene::toml::Entry& entry,
                            const scene::toml::Value& value) {
  scene::Override setting;
  setting.address = entry.key;
  setting.value = scene::toml::toml_literal(value);
  setting.file = source.file;
  setting.key = entry.where;
  setting.place = value.where.line > 0 ? value.where : entry.value.where;
  return setting;
}

/// Numbers and vectors as they are written in tables and labels, as those of sweep files: 48000 for
/// 48_000. A text that is not TOML is refused where a scene reads it.
std::string plain_value(const std::string& address, const std::string& typed) {
  const std::string text = trimmed(typed);
  const std::optional<scene::ParamInfo> info = scene::param_at(address);
  if (!info || (info->type != "number" && info->type != "integer" && info->type != "vector"))
    return text;
  try {
    const scene::toml::Table table = scene::toml::parse_toml("value = " + text, "");
    const scene::toml::Value& value = table.entries.at(0).value;
    const bool is_plain = std::holds_alternative<std::int64_t>(value.data) ||
                          std::holds_alternative<double>(value.data) ||
                          std::holds_alternative<scene::toml::Array>(value.data);
    return is_plain && table.entries.size() == 1 ? scene::toml::toml_literal(value) : text;
  } catch (const scene::toml::SceneError&) {
    return text;
  }
}

AxisRule read_rule(const scene::Source& source, const scene::toml::Entry& entry) {
  AxisRule spec;
  scene::Reading reading{source, {}};
  scene::Reader(reading, std::get<scene::toml::Table>(entry.value.data), entry.key)
      .read([&](auto& v) { describe(v, spec); });
  if (kinds_given(spec) != 1)
    source.fail(entry.value.where, entry.key + " needs exactly one rule",
                "expected values, linspace, logspace, range, uniform, log_uniform or normal");
  for (const auto& ends : {spec.uniform, spec.log_uniform})
    if (ends && !(ends->first < ends->last))
      source.fail(entry.value.where, entry.key + " is drawn between two equal numbers or backwards",
                  "expected [smallest, largest]");
  if (spec.normal && !(spec.normal->last >= 0))
    source.fail(entry.value.where, "the standard deviation of " + entry.key + " is negative",
                "expected [mean, standard deviation]");
  return spec;
}

/// Splits a text at commas that are in no brackets and no string.
std::vector<std::string> split_list(const std::string& text) {
  std::vector<std::string> pieces(1);
  int depth = 0;
  char quote = 0;
  bool is_escaped = false;
  for (const char c : text) {
    if (quote) {
      if (c == quote && !is_escaped) quote = 0;
      is_escaped = quote == '"' && c == '\\' && !is_escaped;
    } else if (c == '"' || c == '\'') {
      quote = c;
    } else if (c == '[' || c == '{') {
      ++depth;
    } else if (c == ']' || c == '}') {
      --depth;
    }
    if (c == ',' && depth <= 0 && !quote)
      pieces.emplace_back();
    else
      pieces.back() += c;
  }
  return pieces;
}

Axis::Parameter parse_rule(const scene::Override& change) {
  try {
    const scene::Source source{"", "", {}};
    scene::toml::Entry entry = scene::toml::parse_toml("value = " + change.value, "").entries.at(0);
    entry.key = change.address;
    Axis::Parameter parameter = read_axis(source, entry);
    for (scene::Override& setting : parameter.values) setting.flag = "-p";
    return parameter;
  } catch (const scene::toml::SceneError& error) {
    throw UsageError("-p " + change.address + "=" + change.value, error.message, error.hint);
  }
}

/// The numbers of "5..20", "5:20:3" or "linspace(5, 20, 3)", as they were typed.
struct TypedRange {
  std::string ends = "[5, 10]";
  std::string count = "3";  ///< of values
};

TypedRange typed_range(std::string text) {
  const bool has_count = text.find("space(") != std::string::npos;
  for (std::size_t at = text.find(".."); at != std::string::npos; at = text.find("..", at))
    text.replace(at, 2, " ");
  std::vector<std::string> ends;
  const std::string between = " ,:;()[]";
  for (std::size_t at = text.find_first_not_of(between); at != std::string::npos;) {
    const std::size_t end = std::min(text.find_first_of(between, at), text.size());
    if (finite_number(text.substr(at, end - at))) ends.push_back(text.substr(at, end - at));
    at = text.find_first_not_of(between, end);
  }
  TypedRange range;
  if (ends.size() >= 2) range.ends = "[" + ends[0] + ", " + ends[1] + "]";
  if (has_count && ends.size() == 3) range.count = ends[2];
  return range;
}

/// "material.snow.hardening=5:10:3", "linspace(5, 10, 3)": ranges as other programs write them.
void refuse_foreign_range(const scene::Override& change, const std::string& what) {
  const std::optional<scene::ParamInfo> info = scene::param_at(change.address);
  if (!info || (info->type != "number" && info->type != "integer")) return;
  const std::string& text = change.value;
  const bool has_colons = text.find(':') != std::string::npos &&
                          text.find_first_not_of("0123456789.eE+-: ") == std::string::npos;
  const bool is_call = text.find("space(") != std::string::npos || text.starts_with("range(");
  if (text.find("..") != std::string::npos || has_colons || is_call) {
    const TypedRange range = typed_range(text);
    const bool is_whole = info->type == "integer" && !is_call && !has_colons;
    const char* const rule = text.find("logspace(") != std::string::npos ? "logspace" : "linspace";
    throw UsageError(what, "is not a list of values",
                     is_whole ? "for a range write { range = " + range.ends +
                                    " }, in quotes for the shell, or all values: 1,2,3"
                              : std::string("for a range write { ") + rule + " = " + range.ends +
                                    ", num = " + range.count + " }, in quotes for the shell");
  }
  const bool is_in_brackets = text.starts_with("[") && text.ends_with("]");
  std::string list = is_in_brackets ? text.substr(1, text.size() - 2) : text;
  std::replace(list.begin(), list.end(), ';', ',');
  if (list.find(',') == std::string::npos) std::replace(list.begin(), list.end(), ' ', ',');
  if (list != text && list.find_first_not_of("0123456789.eE+-, ") == std::string::npos)
    throw UsageError(what, "is not a list of values",
                     "separate values by commas without blanks: -p " + change.address + "=" + list);
}

/// "body.ball.velocity.y", "body.ball.velocity[1]"
void refuse_component(const std::string& address, const std::string& what) {
  const auto end = address.find_last_of(".[");
  if (end == std::string::npos) return;
  const std::optional<scene::ParamInfo> info = scene::param_at(address.substr(0, end));
  if (!info || info->type != "vector") return;
  throw UsageError(
      what, "components of a vector cannot be varied alone",
      "write whole vectors, as in -p " + address.substr(0, end) + "=[0,-1,0],[0,-2,0]");
}

}  // namespace

std::vector<scene::toml::Entry> addresses_in(const scene::toml::Table& table, bool has_rules) {
  std::vector<scene::toml::Entry> found;
  collect_addresses(table, "", has_rules, found);
  return found;
}

scene::Override setting_of(const scene::Source& source, const scene::toml::Entry& entry) {
  return override_of(source, entry, entry.value);
}

Axis::Parameter read_axis(const scene::Source& source, const scene::toml::Entry& entry) {
  Axis::Parameter parameter;
  parameter.address = entry.key;
  std::vector<scene::toml::Value> values;
  if (const scene::toml::Array* list = std::get_if<scene::toml::Array>(&entry.value.data)) {
    values = *list;
  } else if (std::holds_alternative<scene::toml::Table>(entry.value.data)) {
    const AxisRule spec = read_rule(source, entry);
    parameter.label = spec.label;
    if (spec.uniform || spec.log_uniform || spec.normal) {
      parameter.drawn = spec;
      values.push_back(entry.value);
    } else {
      values = values_of(spec, entry.key, source, entry.value.where);
    }
  } else {
    source.fail(entry.value.where, entry.key + " = " + scene::toml::toml_literal(entry.value, 60),
                "expected a list of values, as in [5, 10], or a table such as { linspace = [1, 2], "
                "num = 3 }; put constant values into [set]");
  }
  if (values.empty()) source.fail(entry.value.where, entry.key + " has no values");
  if (values.size() > max_values)
    source.fail(entry.value.where, entry.key + " has too many values", "at most 100000");
  for (const scene::toml::Value& value : values)
    parameter.values.push_back(override_of(source, entry, value));
  quote_numbers(parameter);
  return parameter;
}

Axis::Parameter parse_axis(const std::string& argument) {
  const auto equals = argument.find('=');
  const std::string what = "-p " + argument;
  if (equals == std::string::npos || equals == 0)
    throw UsageError(what, "expected ADDRESS=LIST", "for example -p material.snow.hardening=5,10");
  scene::Override change = scene::parse_override(argument);
  change.flag = "-p";
  refuse_component(change.address, what);
  refuse_foreign_range(change, what);
  if (change.value.starts_with("{")) return parse_rule(change);
  Axis::Parameter parameter;
  parameter.address = change.address;
  for (const std::string& piece : split_list(change.value)) {
    if (piece.find_first_not_of(" \t") == std::string::npos)
      throw UsageError(what, "a value is missing", "expected values with commas, as in 5,10,20");
    scene::Override setting = change;
    setting.value = plain_value(change.address, piece);
    parameter.values.push_back(setting);
  }
  quote_numbers(parameter);
  return parameter;
}

}  // namespace neve::app::sweep::read

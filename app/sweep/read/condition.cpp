#include "app/sweep/read/condition.h"

#include <fmt/core.h>

#include <array>
#include <optional>
#include <stdexcept>

#include "app/advice/suggest.h"
#include "app/scene/toml/toml_source.h"
#include "app/support/text.h"

namespace neve::app::sweep::read {

namespace {

constexpr const char* blanks = " \t\n";

/// Longer ones first: "<=" begins with "<".
constexpr std::array<const char*, 6> comparisons{"<=", ">=", "==", "!=", "<", ">"};

constexpr const char* form =
    "expected two sides with <, <=, >, >=, == or != between them, each an axis, a number, a number "
    "* an axis, or a text in quotes";

std::vector<std::string> names_of(const Sweep& sweep) {
  std::vector<std::string> names;
  for (const Axis& axis : sweep.axes)
    for (const Axis::Parameter& parameter : axis.parameters) {
      names.push_back(parameter.address);
      if (!parameter.label.empty()) names.push_back(parameter.label);
    }
  return names;
}

/// Addresses, labels, and the last words of addresses.
std::vector<std::string> all_names_of(const Sweep& sweep) {
  std::vector<std::string> names = names_of(sweep);
  for (const std::string& address : names_of(sweep))
    if (const std::size_t dot = address.rfind('.'); dot != std::string::npos)
      names.push_back(address.substr(dot + 1));
  return names;
}

/// Says what is wrong with a side that names no axis.
std::string complaint(const std::string& name, const Sweep& sweep) {
  constexpr const char* letters =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789._-[]";
  if (name.find_first_of("<>=!") != std::string::npos)
    return fmt::format(
        "it compares twice; write a condition for each, as in [\"0.1 < {0}\", \"{0} "
        "< 0.2\"]",
        names_of(sweep).empty() ? "hardening" : names_of(sweep).front());
  if (name.find_first_not_of(letters) != std::string::npos || number_of(name.substr(0, 1)))
    return fmt::format("\"{}\" is not an axis, nor a number times an axis; {}", name, form);
  const std::string question = advice::suggest(name, {"", all_names_of(sweep)});
  return fmt::format("\"{}\" is not an axis of the sweep; {}expected {}", name,
                     question.empty() ? "" : question + " ", joined(names_of(sweep), ", "));
}

/// The address of an axis by address, label, or the end of an address that no other has.
std::string address_of(const std::string& name, const Sweep& sweep) {
  if (name.empty()) throw std::invalid_argument(std::string("an axis is missing; ") + form);
  std::string found;
  for (const Axis& axis : sweep.axes)
    for (const Axis::Parameter& parameter : axis.parameters) {
      if (name == parameter.address || name == parameter.label) return parameter.address;
      if (!parameter.address.ends_with("." + name)) continue;
      if (!found.empty())
        throw std::invalid_argument(fmt::format("\"{}\" may be {} or {}; write more of its address",
                                                name, found, parameter.address));
      found = parameter.address;
    }
  if (found.empty()) throw std::invalid_argument(complaint(name, sweep));
  return found;
}

/// Values of an axis that is compared by size: texts and vectors have none.
void check_numbers(const std::string& address, const Sweep& sweep) {
  for (const Axis& axis : sweep.axes)
    for (const Axis::Parameter& parameter : axis.parameters) {
      if (parameter.address != address || parameter.drawn) continue;
      for (const scene::Override& setting : parameter.values)
        if (!number_of(setting.value))
          throw std::invalid_argument(
              fmt::format("{} has values without a size, such as {}; use == or !=, with a text in "
                          "quotes, or leave values out of the axis",
                          address, setting.value));
    }
}

bool compare(const std::string& comparison, double a, double b) {
  if (comparison == "<") return a < b;
  if (comparison == "<=") return a <= b;
  if (comparison == ">") return a > b;
  if (comparison == ">=") return a >= b;
  return (a == b) == (comparison == "==");
}

}  // namespace

Condition::Side Condition::read_side(const std::string& text, const Sweep& sweep) {
  if (text.empty()) throw std::invalid_argument(std::string("a side is empty; ") + form);
  if (const std::optional<double> number = number_of(text)) return {*number, {}, {}};
  if (const std::string inside = scene::toml::unquoted(text); inside != text)
    return {1, {}, inside};
  const std::size_t star = text.find('*');
  if (star == std::string::npos) return {1, address_of(text, sweep), {}};
  const std::string first = trimmed(text.substr(0, star), blanks),
                    second = trimmed(text.substr(star + 1), blanks);
  if (const std::optional<double> factor = number_of(first))
    return {*factor, address_of(second, sweep), {}};
  if (const std::optional<double> factor = number_of(second))
    return {*factor, address_of(first, sweep), {}};
  throw std::invalid_argument(fmt::format("\"{}\" is not a number times an axis; {}", text, form));
}

Condition::Condition(const std::string& text, const Sweep& sweep) {
  std::size_t at = std::string::npos;
  for (const char* comparison : comparisons) {
    const std::size_t found = text.find(comparison);
    if (found == std::string::npos || (at != std::string::npos && found >= at)) continue;
    at = found;
    comparison_ = comparison;
  }
  if (at == std::string::npos)
    throw std::invalid_argument(std::string("it compares nothing; ") + form);
  left_ = read_side(trimmed(text.substr(0, at), blanks), sweep);
  right_ = read_side(trimmed(text.substr(at + comparison_.size()), blanks), sweep);
  if (left_.address.empty() && right_.address.empty())
    throw std::invalid_argument(std::string("it names no axis; ") + form);
  const bool has_text = !left_.text.empty() || !right_.text.empty();
  if (has_text && comparison_ != "==" && comparison_ != "!=")
    throw std::invalid_argument("text compares only with == and !=");
  for (const Side& side : {left_, right_})
    if (!side.address.empty() && ((comparison_ != "==" && comparison_ != "!=") || side.factor != 1))
      check_numbers(side.address, sweep);
}

bool Condition::holds(
    const std::function<std::string(const std::string& address)>& value_of) const {
  const auto text_of = [&](const Side& side) {
    return side.address.empty() ? side.text : scene::toml::unquoted(value_of(side.address));
  };
  const auto number = [&](const Side& side) -> std::optional<double> {
    if (side.address.empty()) return side.text.empty() ? std::optional(side.factor) : std::nullopt;
    const std::optional<double> value = number_of(value_of(side.address));
    return value ? std::optional(side.factor * *value) : std::nullopt;
  };
  const std::optional<double> a = number(left_), b = number(right_);
  if (a && b) return compare(comparison_, *a, *b);
  return (text_of(left_) == text_of(right_)) == (comparison_ == "==");
}

std::vector<Condition> conditions_of(const Sweep& sweep) {
  std::vector<Condition> conditions;
  for (const std::string& text : sweep.settings.where) {
    try {
      conditions.emplace_back(text, sweep);
    } catch (const std::invalid_argument& error) {
      const std::string message = error.what();
      const std::size_t end = message.find("; ");
      sweep.fail("sweep.where", fmt::format("where = \"{}\": {}", text, message.substr(0, end)),
                 end == std::string::npos ? "" : message.substr(end + 2));
    }
  }
  return conditions;
}

}  // namespace neve::app::sweep::read

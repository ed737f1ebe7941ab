#include "app/sweep/read/condition.h"

#include <fmt/core.h>

#include <array>
#include <optional>
#include <stdexcept>

#include "app/support/text.h"

namespace neve::app::sweep::read {

namespace {

std::string trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t\n");
  if (first == std::string_view::npos) return {};
  return std::string(text.substr(first, text.find_last_not_of(" \t\n") - first + 1));
}

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

/// The address of an axis by address, label, or the end of an address that no other has.
std::string address_of(const std::string& name, const Sweep& sweep) {
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
  if (found.empty())
    throw std::invalid_argument(fmt::format("\"{}\" is no axis of the sweep; {}", name,
                                            names_advice(name, names_of(sweep))));
  return found;
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
  if (text.size() > 1 && text.front() == text.back() &&
      (text.front() == '"' || text.front() == '\''))
    return {1, {}, text.substr(1, text.size() - 2)};
  const std::size_t star = text.find('*');
  if (star == std::string::npos) return {1, address_of(text, sweep), {}};
  const std::string first = trimmed(text.substr(0, star)), second = trimmed(text.substr(star + 1));
  if (const std::optional<double> factor = number_of(first))
    return {*factor, address_of(second, sweep), {}};
  if (const std::optional<double> factor = number_of(second))
    return {*factor, address_of(first, sweep), {}};
  throw std::invalid_argument(fmt::format("\"{}\" is no number times an axis; {}", text, form));
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
  left_ = read_side(trimmed(text.substr(0, at)), sweep);
  right_ = read_side(trimmed(text.substr(at + comparison_.size())), sweep);
  if (left_.address.empty() && right_.address.empty())
    throw std::invalid_argument(std::string("it names no axis; ") + form);
  const bool has_text = !left_.text.empty() || !right_.text.empty();
  if (has_text && comparison_ != "==" && comparison_ != "!=")
    throw std::invalid_argument("a text is neither smaller nor larger; expected == or !=");
}

bool Condition::holds(
    const std::function<std::string(const std::string& address)>& value_of) const {
  const auto text_of = [&](const Side& side) {
    return side.address.empty() ? side.text : value_of(side.address);
  };
  const auto plain = [](std::string text) {
    return text.size() > 1 && text.front() == '"' ? text.substr(1, text.size() - 2) : text;
  };
  const auto number = [&](const Side& side) -> std::optional<double> {
    if (side.address.empty()) return side.text.empty() ? std::optional(side.factor) : std::nullopt;
    const std::optional<double> value = number_of(value_of(side.address));
    return value ? std::optional(side.factor * *value) : std::nullopt;
  };
  const std::optional<double> a = number(left_), b = number(right_);
  if (a && b) return compare(comparison_, *a, *b);
  return (plain(text_of(left_)) == plain(text_of(right_))) == (comparison_ == "==");
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

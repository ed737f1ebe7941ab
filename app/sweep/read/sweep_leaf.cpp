#include "app/sweep/read/sweep_leaf.h"

#include <charconv>
#include <cmath>

namespace neve::app::sweep::read {

namespace {

std::optional<double> seconds_in(char unit) {
  switch (unit) {
    case 's':
      return 1;
    case 'm':
      return 60;
    case 'h':
      return 3600;
    case 'd':
      return 86400;
    default:
      return std::nullopt;
  }
}

}  // namespace

std::optional<double> seconds_of(std::string_view text) {
  double total = 0;
  const bool is_empty = text.empty();
  while (!text.empty()) {
    double count = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), count);
    if (error != std::errc{} || !std::isfinite(count) || count < 0) return std::nullopt;
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
    const std::optional<double> unit = text.empty() ? std::optional(1.0) : seconds_in(text[0]);
    if (!unit) return std::nullopt;
    if (!text.empty()) text.remove_prefix(1);
    total += count * *unit;
  }
  return is_empty ? std::nullopt : std::optional(total);
}

void read_leaf(const scene::Leaf& leaf, Duration& member) {
  const auto* text = std::get_if<std::string>(&leaf.value.data);
  if (!text) return scene::read_leaf(leaf, member.seconds);
  const std::optional<double> seconds = seconds_of(*text);
  if (!seconds) leaf.fail("seconds, or a time such as \"90s\", \"20m\" or \"1h30m\"");
  if (!leaf.valid.contains(*seconds)) leaf.fail(leaf.valid.text_of_bounds());
  member.seconds = *seconds;
}

void read_leaf(const scene::Leaf& leaf, Ends& member) {
  leaf.array(2, "two numbers");
  scene::read_leaf(leaf.element(0), member.first);
  scene::read_leaf(leaf.element(1), member.last);
}

void read_leaf(const scene::Leaf& leaf, WholeRange& member) {
  const std::string what = "two or three whole numbers [first, last, step]";
  const std::size_t count = leaf.array(0, what).size();
  if (count != 2 && count != 3) leaf.fail(what);
  const auto whole = [&](std::size_t k) {
    double number = 0;
    scene::read_leaf(leaf.element(k), number);
    if (number != std::trunc(number)) leaf.element(k).fail("a whole number");
    return static_cast<std::int64_t>(number);
  };
  member.first = whole(0);
  member.last = whole(1);
  member.step = count == 3 ? whole(2) : (member.last < member.first ? -1 : 1);
  if (member.step == 0 || (member.last - member.first) * (member.step > 0 ? 1 : -1) < 0)
    leaf.fail("a step that leads from the first to the last");
}

void read_leaf(const scene::Leaf& leaf, Values& member) {
  member.items = leaf.array(0, "a list of values");
}

scene::toml::Value to_value(const Duration& member) {
  return {member.seconds};
}
scene::toml::Value to_value(const Ends& member) {
  return {scene::toml::Array{{member.first}, {member.last}}};
}
scene::toml::Value to_value(const WholeRange& member) {
  return {scene::toml::Array{{member.first}, {member.last}, {member.step}}};
}
scene::toml::Value to_value(const Values& member) {
  return {member.items};
}

std::string type_of(const Duration&) {
  return "duration";
}
std::string type_of(const Ends&) {
  return "two numbers";
}
std::string type_of(const WholeRange&) {
  return "whole numbers";
}
std::string type_of(const Values&) {
  return "list of values";
}

Json schema_of(const Duration&, const scene::Valid& valid, const char* unit) {
  return scene::schema_of_any(
      {scene::schema_of(0.0, valid, unit),
       {{"type", "string"}, {"pattern", "^([0-9.]+([eE][+-]?[0-9]+)?[smhd]?)+$"}}});
}
Json schema_of(const Ends&, const scene::Valid& valid, const char* unit) {
  return scene::schema_of_numbers(scene::schema_of(0.0, valid, unit), 2, 2);
}
Json schema_of(const WholeRange&, const scene::Valid& valid, const char* unit) {
  return scene::schema_of_numbers(scene::schema_of(0, valid, unit), 2, 3);
}
Json schema_of(const Values&, const scene::Valid&, const char*) {
  return {{"type", "array"}};
}

}  // namespace neve::app::sweep::read

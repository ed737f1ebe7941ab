#pragma once
/// Values that only sweep files have, from TOML and to TOML.

#include "app/scene/leaf.h"
#include "app/sweep/sweep.h"

namespace neve::app {

constexpr auto names(Method) {
  using enum Method;
  return std::array{Name{grid, "grid"}, Name{zip, "zip"}, Name{random, "random"}, Name{lhs, "lhs"},
                    Name{list, "list"}};
}
constexpr auto names(TileLabel) {
  using enum TileLabel;
  return std::array{Name{differences, "differences"}, Name{name, "name"}, Name{none, "none"}};
}

/// Seconds of "90", "90s", "20m", "1h30m"; nothing when it is none of that.
std::optional<double> seconds_of(std::string_view text);

void read_leaf(const Leaf& leaf, Duration& member);
void read_leaf(const Leaf& leaf, Ends& member);
void read_leaf(const Leaf& leaf, WholeRange& member);
void read_leaf(const Leaf& leaf, Values& member);

Value to_value(const Duration& member);
Value to_value(const Ends& member);
Value to_value(const WholeRange& member);
Value to_value(const Values& member);

std::string type_of(const Duration&);
std::string type_of(const Ends&);
std::string type_of(const WholeRange&);
std::string type_of(const Values&);

}  // namespace neve::app

#pragma once
/// Values that only sweep files have: from TOML, to TOML, as JSON Schema.

#include "app/scene/leaf.h"
#include "app/scene/schema_leaf.h"
#include "app/sweep/read/sweep.h"

namespace neve::app::sweep::read {

constexpr auto names(Method) {
  using enum Method;
  return std::array{scene::Name{grid, "grid"},     scene::Name{zip, "zip"},
                    scene::Name{random, "random"}, scene::Name{lhs, "lhs"},
                    scene::Name{sobol, "sobol"},   scene::Name{morris, "morris"},
                    scene::Name{list, "list"}};
}
constexpr auto names(TileLabel) {
  using enum TileLabel;
  return std::array{scene::Name{differences, "differences"}, scene::Name{name, "name"},
                    scene::Name{none, "none"}};
}
constexpr auto names(Framing) {
  using enum Framing;
  return std::array{scene::Name{sheet, "sheet"}, scene::Name{fall, "fall"},
                    scene::Name{each, "each"}};
}

/// Seconds of "90", "90s", "20m", "1h30m"; nothing for other text.
std::optional<double> seconds_of(std::string_view text);

void read_leaf(const scene::Leaf& leaf, Duration& member);
void read_leaf(const scene::Leaf& leaf, Ends& member);
void read_leaf(const scene::Leaf& leaf, WholeRange& member);
void read_leaf(const scene::Leaf& leaf, Values& member);

scene::toml::Value to_value(const Duration& member);
scene::toml::Value to_value(const Ends& member);
scene::toml::Value to_value(const WholeRange& member);
scene::toml::Value to_value(const Values& member);

std::string type_of(const Duration&);
std::string type_of(const Ends&);
std::string type_of(const WholeRange&);
std::string type_of(const Values&);

Json schema_of(const Duration&, const scene::Valid& valid, const char* unit);
Json schema_of(const Ends&, const scene::Valid& valid, const char* unit);
Json schema_of(const WholeRange&, const scene::Valid& valid, const char* unit);
Json schema_of(const Values&, const scene::Valid& valid, const char* unit);

}  // namespace neve::app::sweep::read

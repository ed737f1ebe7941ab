#pragma once
/// A run whose parameters change on its way.

#include <string>
#include <vector>

#include "app/scene/read.h"

namespace neve::test {

/// A ball of snow that falls on a floor, and a ball that moves towards it.
/// @param more  an override: "solver.cfl=0.1"
inline app::scene::Scene changed_scene(const std::string& more = {}) {
  constexpr const char* text = R"(
frames = 4
[solver]
cell_size = 0.04
[[body]]
name = "ball"
shape = { sphere = { center = [0, 0.12, 0], radius = 0.08 } }
velocity = [0, -2, 0]
[[collider]]
name = "floor"
shape = { plane = { point = [0, 0, 0], normal = [0, 1, 0] } }
[[collider]]
name = "ball"
shape = { sphere = { center = [0.2, 0, 0], radius = 0.08 } }
velocity = [-1, 0, 0]
)";
  std::vector<app::scene::Override> overrides;
  if (!more.empty()) overrides.push_back(app::scene::parse_override(more));
  return app::scene::read_scene_text(text, "s.toml", "", overrides);
}

}  // namespace neve::test

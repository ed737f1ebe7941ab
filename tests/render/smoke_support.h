#pragma once
/// Synthetic smoke for tests.

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>

#include "render/frame/frame.h"

namespace neve::render {

/// Smoke of full_density times share(place) on every block between two places.
inline Smoke make_smoke(Vec3f low, Vec3f high, float spacing,
                        const std::function<float(Vec3f)>& share) {
  Smoke smoke;
  auto nodes = std::make_shared<NodeLattice>();
  nodes->spacing = spacing;
  const auto block = [&](float x) { return static_cast<int>(std::floor(x / (4 * spacing))); };
  for (int i = block(low.x); i <= block(high.x); ++i) {
    for (int j = block(low.y); j <= block(high.y); ++j) {
      for (int k = block(low.z); k <= block(high.z); ++k) nodes->block.push_back({i, j, k});
    }
  }
  for (const Vec3i b : nodes->block) {
    for (int n = 0; n < 64; ++n) {
      const Vec3f at = {static_cast<float>(4 * b.x + n / 16),
                        static_cast<float>(4 * b.y + n / 4 % 4),
                        static_cast<float>(4 * b.z + n % 4)};
      smoke.density.edit().push_back(smoke.full_density * share(spacing * at));
    }
  }
  smoke.nodes = std::move(nodes);
  return smoke;
}

/// 1 inside, falling to 0 over two spacings at the surface.
inline Smoke smoke_ball(Vec3f center, float radius, float spacing) {
  const float reach = radius + 2 * spacing;
  const Vec3f corner = {reach, reach, reach};
  return make_smoke(center - corner, center + corner, spacing, [=](Vec3f p) {
    const float x = std::clamp((reach - length(p - center)) / (2 * spacing), 0.0f, 1.0f);
    return x * x * (3 - 2 * x);
  });
}

}  // namespace neve::render

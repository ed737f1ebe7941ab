#include "app/bench/render_frames.h"

#include <cmath>

#include "render/shapes/mesh_shapes.h"
#include "sim/base/hash.h"

namespace neve::app::bench {

namespace {

constexpr float ball_radius = 0.5f, slab_half = 0.9f, slab_low = -0.6f, slab_high = -0.5f;
constexpr float volume = 0.5236f + 1.8f * 1.8f * 0.1f;  // m3

bool is_snow(Vec3f p) {
  if (length(p) <= ball_radius) return true;
  return std::abs(p.x) <= slab_half && std::abs(p.z) <= slab_half && p.y >= slab_low &&
         p.y <= slab_high;
}

/// Off the lattice by up to a third of its spacing, as simulated snow is.
Vec3f jitter(std::uint64_t site, float spacing) {
  const auto part = [&](std::uint64_t axis) {
    return 0.66f * spacing * (static_cast<float>(unit_double(mix64(site, axis))) - 0.5f);
  };
  return {part(0), part(1), part(2)};
}

void add_snow(render::Points& points, double particles) {
  points.spacing = std::cbrt(volume / static_cast<float>(particles));
  points.radius = 0.6f * points.spacing;
  const int n = static_cast<int>(std::ceil(2 * slab_half / points.spacing));
  std::uint64_t site = 0;
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      for (int k = 0; k < n; ++k, ++site) {
        const Vec3f lattice{static_cast<float>(i), static_cast<float>(j), static_cast<float>(k)};
        const Vec3f p = points.spacing * lattice - Vec3f{slab_half, slab_half, slab_half};
        if (!is_snow(p)) continue;
        points.id.edit().push_back(static_cast<std::uint32_t>(points.position.size()));
        points.position.edit().push_back(p + jitter(site, points.spacing));
      }
    }
  }
}

/// Thinner with the distance from the ball, over the whole box.
void add_smoke(render::Smoke& smoke) {
  constexpr int blocks = 16;  // of 4 nodes
  auto nodes = std::make_shared<render::NodeLattice>();
  nodes->spacing = 2 * slab_half / (4 * blocks);
  nodes->origin = {-slab_half, -slab_half, -slab_half};
  for (int i = 0; i < blocks; ++i)
    for (int j = 0; j < blocks; ++j)
      for (int k = 0; k < blocks; ++k) nodes->block.push_back({i, j, k});
  for (const Vec3i& block : nodes->block) {
    for (int node = 0; node < 64; ++node) {
      const Vec3f at{static_cast<float>(4 * block.x + node / 16),
                     static_cast<float>(4 * block.y + node / 4 % 4),
                     static_cast<float>(4 * block.z + node % 4)};
      const float distance = length(nodes->origin + nodes->spacing * at);
      smoke.density.edit().push_back(30 * std::exp(-8 * std::abs(distance - 0.65f)));
    }
  }
  smoke.nodes = nodes;
}

/// 31 x 31 arrows that go around the axis, over a heat map of how fast.
void add_slice(render::Frame& frame) {
  constexpr int n = 31;
  render::Arrows arrows;
  render::HeatMap map;
  map.corner = {-slab_half, 0, -slab_half};
  map.across = {2 * slab_half, 0, 0};
  map.up = {0, 0, 2 * slab_half};
  map.columns = map.rows = n;
  arrows.length_per_value = 0.08f;
  arrows.max_length = 0.06f;
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < n; ++i) {
      const auto place = [&](int k) {
        return slab_half * (2 * (static_cast<float>(k) + 0.5f) / n - 1);
      };
      const Vec3f p{place(i), 0, place(j)}, v{-p.z, 0, p.x};
      arrows.position.edit().push_back(p);
      arrows.vector.edit().push_back(v);
      map.value.edit().push_back(length(v));
    }
  }
  frame.arrows.push_back(arrows);
  frame.heat_maps.push_back(map);
}

}  // namespace

render::Frame particles_frame(double particles) {
  render::Frame frame;
  frame.camera = {{1.6f, 1.0f, 2.0f}, {0, -0.1f, 0}, {0, 1, 0}, 38};
  frame.grounds.push_back({.point = {0, slab_low, 0}});
  add_snow(frame.points, particles);
  return frame;
}

render::Frame all_layers_frame(double particles) {
  render::Frame frame = particles_frame(particles);
  add_smoke(frame.smoke);
  add_slice(frame);
  frame.meshes.push_back(render::shapes::sphere_mesh({0.75f, -0.35f, 0.7f}, 0.15f));
  frame.legends.push_back({"speed", "m/s", render::ColorMap::viridis, 0, 1});
  frame.caption = {"neve bench render", "frame 24   t = 1.000 s", "all layers"};
  return frame;
}

}  // namespace neve::app::bench

/// Shapes that are round about an axis.

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "render/shapes/mesh_shapes.h"

namespace neve::render::shapes {
namespace {

constexpr float pi = std::numbers::pi_v<float>;
constexpr int steps_of_quarter = 16;
constexpr std::uint32_t segments = 96;

/// Part of a circle about (out, along), from an angle to another; 0 points away from the axis.
void add_arc(float out, float along, float radius, float from, float to, int steps,
             Profile& profile) {
  for (int k = 0; k <= steps; ++k) {
    const float angle = from + (to - from) * static_cast<float>(k) / static_cast<float>(steps);
    const float c = std::cos(angle), s = std::sin(angle);
    profile.points.push_back({out + radius * c, along + radius * s, c, s});
  }
}

Vec3f on_circle(const Profile::Point& p, float around) {
  return {p.out * std::cos(around), p.along, p.out * std::sin(around)};
}

}  // namespace

Profile capsule_profile(float half, float radius) {
  Profile profile;
  add_arc(0, -half, radius, -0.5f * pi, 0, steps_of_quarter, profile);
  add_arc(0, half, radius, 0, 0.5f * pi, steps_of_quarter, profile);
  return profile;
}

Profile cylinder_profile(float half, float radius) {
  return {{{0, -half, 0, -1},
           {radius, -half, 0, -1},
           {radius, -half, 1, 0},
           {radius, half, 1, 0},
           {radius, half, 0, 1},
           {0, half, 0, 1}}};
}

Profile cone_profile(float half, float radius) {
  const float slant = std::hypot(2 * half, radius);
  const float out = 2 * half / slant, up = radius / slant;
  return {
      {{0, -half, 0, -1}, {radius, -half, 0, -1}, {radius, -half, out, up}, {0, half, out, up}}};
}

Profile torus_profile(float ring, float radius) {
  Profile profile;
  add_arc(ring, 0, radius, -pi, pi, 4 * steps_of_quarter, profile);
  return profile;
}

TriangleMesh round_mesh(const Profile& profile, Vec3f center, const Rotation& rotation) {
  std::vector<Vec3f> position, normal;
  std::vector<std::uint32_t> index;
  for (const Profile::Point& p : profile.points)
    for (std::uint32_t j = 0; j <= segments; ++j) {
      const float around = 2 * pi * static_cast<float>(j) / segments;
      position.push_back(on_circle(p, around));
      normal.push_back(
          {p.normal_out * std::cos(around), p.normal_along, p.normal_out * std::sin(around)});
    }
  for (std::uint32_t i = 0; i + 1 < profile.points.size(); ++i)
    for (std::uint32_t j = 0; j < segments; ++j) {
      const std::uint32_t a = i * (segments + 1) + j, b = a + segments + 1;
      index.insert(index.end(), {a, b, a + 1, b, b + 1, a + 1});
    }
  return moved_mesh({std::move(position), std::move(normal), std::move(index)}, center, rotation);
}

Lines round_lines(const Profile& profile, Vec3f center, const Rotation& rotation, bool only_edges) {
  constexpr int circle = 72, meridians = 12, circles = 8;
  Lines lines;
  const auto add = [&](Vec3f a, Vec3f b) { lines.ends.insert(lines.ends.end(), {a, b}); };
  for (int m = 0; m < meridians && !only_edges; ++m) {
    const float around = 2 * pi * static_cast<float>(m) / meridians;
    for (std::size_t i = 0; i + 1 < profile.points.size(); ++i)
      add(on_circle(profile.points[i], around), on_circle(profile.points[i + 1], around));
  }
  // Every edge has its circle, of curves some of the points.
  const std::size_t count = profile.points.size();
  const std::size_t every = std::max<std::size_t>(1, count / circles);
  for (std::size_t i = 0; i < count; ++i) {
    const Profile::Point& p = profile.points[i];
    const bool is_edge =
        i > 0 && p.out == profile.points[i - 1].out && p.along == profile.points[i - 1].along;
    const bool is_shown = is_edge || (!only_edges && i % every == 0 && count >= circles);
    if (p.out <= 0 || !is_shown) continue;
    for (int k = 0; k < circle; ++k)
      add(on_circle(p, 2 * pi * static_cast<float>(k) / circle),
          on_circle(p, 2 * pi * static_cast<float>((k + 1) % circle) / circle));
  }
  return moved_lines(std::move(lines), center, rotation);
}

}  // namespace neve::render::shapes

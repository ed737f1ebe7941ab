#include "render/shapes/mesh_shapes.h"

#include <cmath>
#include <numbers>
#include <utility>

namespace neve::render::shapes {
namespace {

Vec3f rotate(const Rotation& r, Vec3f v) {
  return {r[0] * v.x + r[1] * v.y + r[2] * v.z, r[3] * v.x + r[4] * v.y + r[5] * v.z,
          r[6] * v.x + r[7] * v.y + r[8] * v.z};
}

}  // namespace

TriangleMesh moved_mesh(TriangleMesh mesh, Vec3f center, const Rotation& rotation) {
  for (Vec3f& x : mesh.position.edit()) x = center + rotate(rotation, x);
  for (Vec3f& n : mesh.normal.edit()) n = rotate(rotation, n);
  return mesh;
}

Lines moved_lines(Lines lines, Vec3f center, const Rotation& rotation) {
  for (Vec3f& x : lines.ends) x = center + rotate(rotation, x);
  return lines;
}

TriangleMesh sphere_mesh(Vec3f center, float radius) {
  constexpr std::uint32_t rings = 48, segments = 96;
  constexpr float pi = std::numbers::pi_v<float>;
  std::vector<Vec3f> position, normal;
  std::vector<std::uint32_t> index;
  for (std::uint32_t i = 0; i <= rings; ++i) {
    const float polar = pi * static_cast<float>(i) / rings;
    for (std::uint32_t j = 0; j <= segments; ++j) {
      const float around = 2 * pi * static_cast<float>(j) / segments;
      const Vec3f n = {std::sin(polar) * std::cos(around), std::cos(polar),
                       std::sin(polar) * std::sin(around)};
      position.push_back(center + radius * n);
      normal.push_back(n);
    }
  }
  for (std::uint32_t i = 0; i < rings; ++i) {
    for (std::uint32_t j = 0; j < segments; ++j) {
      const std::uint32_t a = i * (segments + 1) + j, b = a + segments + 1;
      index.insert(index.end(), {a, a + 1, b, b, a + 1, b + 1});
    }
  }
  return {std::move(position), std::move(normal), std::move(index)};
}

TriangleMesh box_mesh(Vec3f center, Vec3f size, const Rotation& rotation) {
  std::vector<Vec3f> position, normal;
  std::vector<std::uint32_t> index;
  for (int axis = 0; axis < 3; ++axis) {
    for (const float side : {-1.0f, 1.0f}) {
      Vec3f n, u, v;
      n[axis] = side;
      u[(axis + 1) % 3] = 1;
      v[(axis + 2) % 3] = side;  // keeps the winding outward on both sides
      const auto first = static_cast<std::uint32_t>(position.size());
      for (const auto& [a, b] : {std::array{-1.f, -1.f}, {1.f, -1.f}, {1.f, 1.f}, {-1.f, 1.f}}) {
        position.push_back(center + rotate(rotation, 0.5f * (size * (n + a * u + b * v))));
        normal.push_back(rotate(rotation, n));
      }
      index.insert(index.end(), {first, first + 1, first + 2, first, first + 2, first + 3});
    }
  }
  return {std::move(position), std::move(normal), std::move(index)};
}

Lines sphere_lines(Vec3f center, float radius, const Rotation& rotation) {
  constexpr int segments = 72, meridians = 6, parallels = 5;
  constexpr float pi = std::numbers::pi_v<float>;
  Lines lines;
  const auto circle = [&](Vec3f middle, Vec3f a, Vec3f b) {
    for (int k = 0; k < segments; ++k)
      for (const int end : {k, k + 1}) {
        const float angle = 2 * pi * static_cast<float>(end % segments) / segments;
        const Vec3f unit = middle + std::cos(angle) * a + std::sin(angle) * b;
        lines.ends.push_back(center + radius * rotate(rotation, unit));
      }
  };
  for (int k = 0; k < meridians; ++k) {
    const float around = pi * static_cast<float>(k) / meridians;
    circle({}, {std::cos(around), 0, std::sin(around)}, {0, 1, 0});
  }
  for (int k = 1; k <= parallels; ++k) {
    const float polar = pi * static_cast<float>(k) / (parallels + 1);
    const float r = std::sin(polar);
    circle({0, std::cos(polar), 0}, {r, 0, 0}, {0, 0, r});
  }
  return lines;
}

Lines box_lines(Vec3f center, Vec3f size, const Rotation& rotation) {
  Lines lines;
  const auto corner = [&](int k) {
    const Vec3f unit = {k & 1 ? 0.5f : -0.5f, k & 2 ? 0.5f : -0.5f, k & 4 ? 0.5f : -0.5f};
    return center + rotate(rotation, size * unit);
  };
  for (int k = 0; k < 8; ++k)
    for (const int bit : {1, 2, 4}) {
      if (k & bit) continue;
      lines.ends.push_back(corner(k));
      lines.ends.push_back(corner(k | bit));
    }
  return lines;
}

}  // namespace neve::render::shapes

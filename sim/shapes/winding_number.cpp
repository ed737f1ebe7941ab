#include "sim/shapes/winding_number.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <string>

#include "sim/types/errors.h"

namespace neve::sim::shapes {
namespace {

constexpr std::uint32_t triangles_in_leaf = 8;

/// A node is taken as a whole from this many of its radii away.
constexpr double far = 2.2;

/// Solid angle of a triangle over 4 pi.
/// Source: Van Oosterom and Strackee, The Solid Angle of a Plane Triangle, 1983.
double winding_of(const Vec3d& a, const Vec3d& b, const Vec3d& c) {
  const double la = a.norm(), lb = b.norm(), lc = c.norm();
  const double above = a.dot(b.cross(c));
  const double below = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
  return std::atan2(above, below) / (2 * std::numbers::pi);
}

}  // namespace

WindingNumber::WindingNumber(const std::vector<Vec3d>& vertices,
                             const std::vector<std::array<std::uint32_t, 3>>& triangles)
    : vertices_(vertices), triangles_(triangles), order_(triangles.size()) {
  std::iota(order_.begin(), order_.end(), 0u);
  nodes_.push_back({0, static_cast<std::uint32_t>(order_.size())});
  for (std::uint32_t node = 0; node < nodes_.size(); ++node) build(node);
}

Vec3d WindingNumber::middle_of(std::uint32_t triangle) const {
  const auto& [a, b, c] = triangles_[triangle];
  return (vertices_[a] + vertices_[b] + vertices_[c]) / 3;
}

/// Sums a node up and splits it along the longest side of its middles.
void WindingNumber::build(std::uint32_t node) {
  sum_up(nodes_[node]);
  const auto [first, end] = std::pair(nodes_[node].first, nodes_[node].end);
  if (end - first <= triangles_in_leaf) return;
  Bounds middles;
  for (std::uint32_t k = first; k < end; ++k) middles.add(middle_of(order_[k]));
  Eigen::Index axis = 0;
  (middles.max - middles.min).maxCoeff(&axis);
  const std::uint32_t half = first + (end - first) / 2;
  const auto at = [&](std::uint32_t k) { return order_.begin() + static_cast<std::ptrdiff_t>(k); };
  std::nth_element(at(first), at(half), at(end), [&](std::uint32_t a, std::uint32_t b) {
    const double xa = middle_of(a)[axis], xb = middle_of(b)[axis];
    return xa != xb ? xa < xb : a < b;
  });
  nodes_[node].children = static_cast<std::uint32_t>(nodes_.size());
  nodes_.push_back({first, half});
  nodes_.push_back({half, end});
}

void WindingNumber::sum_up(Node& node) const {
  double area = 0;
  const auto normal_of = [&](std::uint32_t t) {
    const auto& [a, b, c] = triangles_[t];
    return Vec3d(0.5 * (vertices_[b] - vertices_[a]).cross(vertices_[c] - vertices_[a]));
  };
  for (std::uint32_t k = node.first; k < node.end; ++k) {
    const Vec3d normal = normal_of(order_[k]);
    area += normal.norm();
    node.middle += normal.norm() * middle_of(order_[k]);
    node.normals += normal;
  }
  node.middle = area > 0 ? Vec3d(node.middle / area) : middle_of(order_[node.first]);
  for (std::uint32_t k = node.first; k < node.end; ++k) {
    node.moments += (middle_of(order_[k]) - node.middle) * normal_of(order_[k]).transpose();
    for (const std::uint32_t corner : triangles_[order_[k]])
      node.radius = std::max(node.radius, (vertices_[corner] - node.middle).norm());
  }
}

double WindingNumber::at(const Vec3d& p, std::size_t* looked) const {
  double sum = 0;
  std::array<std::uint32_t, 64> open;  // halves of halves: no deeper than the bits of a count
  std::size_t count = 0;
  open[count++] = 0;
  while (count > 0) {
    const Node& node = nodes_[open[--count]];
    const Vec3d r = node.middle - p;
    const double away = r.squaredNorm();
    if (away > far * far * node.radius * node.radius && away > 0) {
      const double length = std::sqrt(away);
      const double second = node.moments.trace() - 3 * r.dot(node.moments * r) / away;
      sum += (r.dot(node.normals) + second) / (4 * std::numbers::pi * away * length);
    } else if (node.children > 0) {
      open[count++] = node.children;
      open[count++] = node.children + 1;
    } else {
      if (looked) *looked += node.end - node.first;
      for (std::uint32_t k = node.first; k < node.end; ++k) {
        const auto& [a, b, c] = triangles_[order_[k]];
        sum += winding_of(vertices_[a] - p, vertices_[b] - p, vertices_[c] - p);
      }
    }
  }
  return sum;
}

/// Samples fill the bounds evenly, by the sequence R3 (see mesh_parts.cpp).
void measure_winding(SolidMesh& mesh, const std::string& name) {
  constexpr int count = 1 << 15;
  // The limit is a second. None is far away where faces all reach across the mesh, and each of the
  // questions that a run asks would look at all of them.
  constexpr std::size_t max_looked = 40'000'000;
  std::size_t looked = 0;
  constexpr double golden = 1.22074408460575947536;
  const WindingNumber winding(mesh.vertices, mesh.triangles);
  const Bounds b = bounds_of(mesh);
  int inside = 0, inside_out = 0, in_doubt = 0, inverse_doubt = 0, twice = 0;
  Moments filled[2];  // of what is wound outward, and of what is wound inward
  for (Moments& moments : filled) moments.from = 0.5 * (b.min + b.max);
  for (int n = 0; n < count; ++n) {
    Vec3d u;
    double step = 1;
    for (double& x : u) x = std::fmod(0.5 + n * (step /= golden), 1);
    const Vec3d p = b.min + u.cwiseProduct(b.max - b.min);
    const double w = winding.at(p, &looked);
    if (looked > max_looked)
      throw ShapeError(name +
                       ": so many faces of the mesh reach across it that it takes too long to say "
                       "where its inside is by winding numbers; " +
                       (mesh.reading.open_edges > 0
                            ? "close its holes"
                            : "fill it by fill = \"closed\", which asks for none") +
                       ", or cut long faces into short ones");
    inside += w > 0.5;
    inside_out += w < -0.5;
    if (std::abs(w) > 0.5) filled[w < 0].add_point(p, (b.max - b.min).prod() / count);
    twice += std::abs(w) > 1.5;
    in_doubt += std::abs(w - 0.5) < 0.25;
    inverse_doubt += std::abs(w + 0.5) < 0.25;
  }
  // The sum over all faces is right where they close and enclose everything once.
  if (mesh.reading.open_edges > 0 || twice > 0 || std::min(inside, inside_out) > 0)
    mesh.moments = filled[inside_out > inside];
  if (inside_out > inside) {
    for (auto& t : mesh.triangles) std::swap(t[1], t[2]);
    mesh.reading.turned_parts = mesh.reading.parts;
    inside = inside_out;
    in_doubt = inverse_doubt;
  }
  mesh.volume = (b.max - b.min).prod() * inside / count;
  mesh.reading.in_doubt = inside > 0 ? static_cast<double>(in_doubt) / inside : 0;
}

}  // namespace neve::sim::shapes

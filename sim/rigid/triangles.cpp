#include "sim/rigid/triangles.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <tuple>
#include <utility>

#include "sim/rigid/mass.h"

namespace neve::sim::rigid {

namespace {

using Neighbours = std::vector<std::array<std::uint32_t, 3>>;

/// Finds neighbours across edges that two triangles share.
Neighbours neighbours_of(const std::vector<std::array<std::uint32_t, 3>>& triangles) {
  struct Edge {
    std::uint32_t low, high, triangle, corner;
  };
  std::vector<Edge> edges;
  for (std::uint32_t t = 0; t < triangles.size(); ++t)
    for (std::uint32_t c = 0; c < 3; ++c) {
      const auto [low, high] = std::minmax(triangles[t][c], triangles[t][(c + 1) % 3]);
      edges.push_back({low, high, t, c});
    }
  std::sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) {
    return std::tie(a.low, a.high, a.triangle) < std::tie(b.low, b.high, b.triangle);
  });
  Neighbours out(triangles.size());
  for (std::uint32_t t = 0; t < out.size(); ++t) out[t] = {t, t, t};
  const auto is_same = [](const Edge& a, const Edge& b) {
    return a.low == b.low && a.high == b.high;
  };
  for (std::size_t k = 0; k + 1 < edges.size(); ++k) {
    const Edge &a = edges[k], &b = edges[k + 1];
    if (!is_same(a, b)) continue;
    out[a.triangle][a.corner] = b.triangle;
    out[b.triangle][b.corner] = a.triangle;
    ++k;
  }
  return out;
}

Face face_of(const std::array<Vec3d, 3>& corners) {
  return {(corners[1] - corners[0]).cross(corners[2] - corners[0]).normalized(),
          (corners[0] + corners[1] + corners[2]) / 3};
}

}  // namespace

Triangles::Triangles(const shapes::SolidMesh& mesh, const shapes::Bounds& all, double unit)
    : unit_(unit), min_(to_bullet(Vec3d(all.min / unit))), max_(to_bullet(Vec3d(all.max / unit))) {
  for (const auto& t : mesh.triangles)
    for (const std::uint32_t v : t) corners_.push_back(static_cast<int>(v));
  neighbours_ = neighbours_of(mesh.triangles);
  vertices_.resize(3 * mesh.vertices.size());
  write(mesh.vertices);
  triangles_ = std::make_unique<btTriangleIndexVertexArray>(
      static_cast<int>(corners_.size() / 3), corners_.data(), static_cast<int>(3 * sizeof(int)),
      static_cast<int>(mesh.vertices.size()), vertices_.data(),
      static_cast<int>(3 * sizeof(double)));
  shape_ = std::make_unique<btBvhTriangleMeshShape>(triangles_.get(), true, min_, max_);
  shape_->setMargin(0);
}

void Triangles::write(const std::vector<Vec3d>& vertices) {
  for (std::size_t v = 0; v < vertices.size(); ++v)
    for (std::size_t x = 0; x < 3; ++x)
      vertices_[3 * v + x] = vertices[v][static_cast<Eigen::Index>(x)] / unit_;
}

std::array<Vec3d, 3> Triangles::corners_of(std::size_t triangle) const {
  std::array<Vec3d, 3> out;
  for (std::size_t c = 0; c < 3; ++c)
    out[c] = Vec3d::Map(&vertices_[3 * static_cast<std::size_t>(corners_[3 * triangle + c])]);
  return out;
}

std::vector<Face> Triangles::faces_at(int triangle, const Vec3d& place, double reach) const {
  const auto t = static_cast<std::size_t>(triangle);
  if (triangle < 0 || t >= neighbours_.size()) return {};
  const std::array<Vec3d, 3> corners = corners_of(t);
  std::vector<Face> faces{face_of(corners)};
  for (std::size_t c = 0; c < 3; ++c) {
    const Vec3d along = corners[(c + 1) % 3] - corners[c];
    const Vec3d inward = faces[0].normal.cross(along).normalized();
    if (inward.dot(place - corners[c]) > reach) continue;
    if (neighbours_[t][c] == t) return {};
    faces.push_back(face_of(corners_of(neighbours_[t][c])));
  }
  return faces;
}

void Triangles::move(const std::vector<Vec3d>& vertices) {
  write(vertices);
  shape_->refitTree(min_, max_);
}

Deforming::Deforming(std::shared_ptr<const shapes::DeformingMesh> mesh, double unit)
    : Triangles(mesh->mesh(0, 0), mesh->bounds(), unit),
      mesh_(std::move(mesh)),
      now_(mesh_->mesh(0, 0)) {}

void Deforming::move_to(double time) {
  const shapes::DeformingMesh::Moment before = moment_;
  moment_ = mesh_->moment(time);
  if (moment_.interval == before.interval && moment_.part == before.part) return;
  now_ = mesh_->mesh(moment_.interval, moment_.part);
  move(now_.vertices);
}

Vec3d Deforming::velocity(int triangle, const Vec3d& place) const {
  const bool is_known = triangle >= 0 && static_cast<std::size_t>(triangle) < now_.triangles.size();
  if (!moment_.moves || !is_known) return Vec3d::Zero();
  return mesh_->velocity(moment_.interval, now_, static_cast<std::uint32_t>(triangle), place);
}

Twist twist_of(const std::vector<Vec3d>& places, const std::vector<Vec3d>& velocities,
               const Vec3d& point) {
  Vec3d middle = Vec3d::Zero(), mean = Vec3d::Zero();
  for (std::size_t k = 0; k < places.size(); ++k) {
    middle += places[k] / static_cast<double>(places.size());
    mean += velocities[k] / static_cast<double>(places.size());
  }
  Mat3d inertia = Mat3d::Zero();
  Vec3d momentum = Vec3d::Zero();
  for (std::size_t k = 0; k < places.size(); ++k) {
    const Vec3d arm = places[k] - middle;
    inertia += inertia_at(arm);
    momentum += arm.cross(velocities[k] - mean);
  }
  // Places on a line say nothing about a spin around it, and one place nothing about any.
  const Eigen::SelfAdjointEigenSolver<Mat3d> axes(inertia);
  Vec3d spin = Vec3d::Zero();
  constexpr double on_a_line = 1e-9;
  for (int x = 0; x < 3; ++x)
    if (axes.eigenvalues()[x] > on_a_line * inertia.trace())
      spin += axes.eigenvectors().col(x) * axes.eigenvectors().col(x).dot(momentum) /
              axes.eigenvalues()[x];
  return {mean + spin.cross(point - middle), spin};
}

}  // namespace neve::sim::rigid

/// Meshes from files: smooth but for their sharp edges.

#include <algorithm>
#include <map>

#include "render/shapes/mesh_shapes.h"

namespace neve::render::shapes {
namespace {

constexpr float cos_crease = 0.766f;  // 40 degrees
/// Meshes of at most so many triangles show all of their edges.
constexpr std::size_t few = 600;
/// A vertex of more triangles is the tip of a fan, or has the same ones again and again: each keeps
/// its own normal there, and the time does not grow with the square of their number.
constexpr std::size_t many = 1024;

/// Returns the normal of a face, as long as twice its area.
Vec3f face_normal(const std::vector<Vec3f>& position, const std::uint32_t* corner) {
  return cross(position[corner[1]] - position[corner[0]],
               position[corner[2]] - position[corner[0]]);
}

/// The triangles around each vertex.
std::vector<std::vector<std::uint32_t>> faces_around(const std::vector<Vec3f>& position,
                                                     const std::vector<std::uint32_t>& index) {
  std::vector<std::vector<std::uint32_t>> faces(position.size());
  for (std::size_t k = 0; k < index.size(); ++k)
    faces[index[k]].push_back(static_cast<std::uint32_t>(k / 3));
  return faces;
}

}  // namespace

TriangleMesh creased_mesh(const std::vector<Vec3f>& position,
                          const std::vector<std::uint32_t>& index) {
  const auto around = faces_around(position, index);
  std::vector<Vec3f> normal(index.size() / 3);
  for (std::size_t t = 0; t < normal.size(); ++t)
    normal[t] = face_normal(position, index.data() + 3 * t);
  TriangleMesh mesh;
  for (std::size_t k = 0; k < index.size(); ++k) {
    const Vec3f own = normalized(normal[k / 3]);
    Vec3f sum;
    const std::vector<std::uint32_t>& neighbours = around[index[k]];
    if (neighbours.size() <= many)
      for (const std::uint32_t t : neighbours)
        if (dot(own, normalized(normal[t])) > cos_crease) sum = sum + normal[t];
    mesh.position.edit().push_back(position[index[k]]);
    mesh.normal.edit().push_back(length(sum) > 0 ? normalized(sum) : own);
    mesh.index.edit().push_back(static_cast<std::uint32_t>(k));
  }
  return mesh;
}

Lines mesh_lines(const std::vector<Vec3f>& position, const std::vector<std::uint32_t>& index) {
  // The first face of each edge; at the second the line is known to be needed or not.
  struct Edge {
    Vec3f normal;
    bool is_open = true;
  };
  std::map<std::pair<std::uint32_t, std::uint32_t>, Edge> edges;
  Lines lines;
  const bool shows_all = index.size() / 3 <= few;
  for (std::size_t t = 0; t + 2 < index.size(); t += 3) {
    const Vec3f normal = normalized(face_normal(position, index.data() + t));
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = index[t + k], b = index[t + (k + 1) % 3];
      const auto [other, is_new] = edges.try_emplace(std::minmax(a, b), Edge{normal});
      if (is_new) continue;
      other->second.is_open = false;
      const float together = dot(normal, other->second.normal);
      // The diagonals of flat polygons are no edges.
      if (together > 0.9999f || (!shows_all && together > cos_crease)) continue;
      lines.ends.insert(lines.ends.end(), {position[a], position[b]});
    }
  }
  // The rims of holes.
  for (const auto& [ends, edge] : edges)
    if (edge.is_open)
      lines.ends.insert(lines.ends.end(), {position[ends.first], position[ends.second]});
  return lines;
}

}  // namespace neve::render::shapes

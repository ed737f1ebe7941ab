
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

#include "app/exports/encode.h"
#include "app/exports/surface_table.h"
#include "app/exports/vdb_file.h"
#include "sim/shapes/mesh_surface.h"

namespace neve::app::exports {

namespace {

using sim::Vec3d;
using sim::Vec3i;
using Corners = std::array<Vec3d, 3>;

/// Voxels on either side of the mesh that have their distance; others have the background.
constexpr int band_voxels = 3;

/// Gives voxels near a triangle their squared distance to it, in voxels, where that is less.
void lower_distances(const Corners& t, VdbLeaves& leaves) {
  const Vec3d low = t[0].cwiseMin(t[1]).cwiseMin(t[2]).array() - band_voxels;
  const Vec3d high = t[0].cwiseMax(t[1]).cwiseMax(t[2]).array() + band_voxels;
  const Vec3i first = low.array().ceil().cast<int>(), last = high.array().floor().cast<int>();
  const Vec3d middle = (t[0] + t[1] + t[2]) / 3;
  double reach = 0;
  for (const Vec3d& corner : t) reach = std::max(reach, (corner - middle).norm());
  for (int x = first.x(); x <= last.x(); ++x)
    for (int y = first.y(); y <= last.y(); ++y)
      for (int z = first.z(); z <= last.z(); ++z) {
        const Vec3i voxel(x, y, z);
        const Vec3d p = voxel.cast<double>();
        float& value = leaves.around(voxel, 1, band_voxels * band_voxels)
                           .value[VdbLeaves::index_in_leaf(voxel)];
        const double far = std::sqrt(static_cast<double>(value)) + reach;
        if ((p - middle).squaredNorm() >= far * far) continue;
        value = std::min(
            value, static_cast<float>(
                       (p - sim::shapes::nearest_on_triangle(t[0], t[1], t[2], p)).squaredNorm()));
      }
}

/// A line of voxels along z, and where it meets the mesh.
struct Crossing {
  int x, y;
  double z;

  bool operator<(const Crossing& other) const {
    return std::tie(x, y, z) < std::tie(other.x, other.y, other.z);
  }
};

/// Lines are that much beside the voxels, in voxels: no vertex of a mesh made on a lattice is
/// there.
constexpr double beside_x = 3.1415926e-7, beside_y = 2.7182818e-7;

/// The side of a line from a to b that a point is on, seen along z; exactly the opposite from b to
/// a, so that a point belongs to one of two triangles at their edge.
double side_of(const Vec3d& a, const Vec3d& b, double x, double y) {
  const bool is_swapped = std::tie(b.x(), b.y()) < std::tie(a.x(), a.y());
  const Vec3d &from = is_swapped ? b : a, &to = is_swapped ? a : b;
  const double side = (to.x() - from.x()) * (y - from.y()) - (to.y() - from.y()) * (x - from.x());
  return is_swapped ? -side : side;
}

void add_crossings(const Corners& t, std::vector<Crossing>& crossings) {
  const Vec3d low = t[0].cwiseMin(t[1]).cwiseMin(t[2]), high = t[0].cwiseMax(t[1]).cwiseMax(t[2]);
  const auto first = [](double c, double beside) {
    return static_cast<int>(std::ceil(c - beside));
  };
  for (int x = first(low.x(), beside_x); x + beside_x <= high.x(); ++x)
    for (int y = first(low.y(), beside_y); y + beside_y <= high.y(); ++y) {
      const double px = x + beside_x, py = y + beside_y;
      const double a = side_of(t[1], t[2], px, py), b = side_of(t[2], t[0], px, py),
                   c = side_of(t[0], t[1], px, py);
      const bool is_left = a > 0 && b > 0 && c > 0, is_right = a < 0 && b < 0 && c < 0;
      if (is_left || is_right)
        crossings.push_back({x, y, (a * t[0].z() + b * t[1].z() + c * t[2].z()) / (a + b + c)});
    }
}

/// Turns the sign of all voxels between the first and the second crossing of a line, and so on.
void turn_inside(std::vector<Crossing> crossings, VdbLeaves& leaves) {
  std::sort(crossings.begin(), crossings.end());
  for (std::size_t k = 0; k + 1 < crossings.size(); k += 2) {
    const Crossing &in = crossings[k], &out = crossings[k + 1];
    for (int z = static_cast<int>(std::ceil(in.z)); z <= out.z; ++z) {
      const Vec3i voxel(in.x, in.y, z);
      float& value =
          leaves.around(voxel, 1, band_voxels * band_voxels).value[VdbLeaves::index_in_leaf(voxel)];
      value = -value;
    }
  }
}

/// Exact distances to the triangles, negative inside, by voxels of this size: a level set.
/// @param mesh  closed, its triangles not much larger than a voxel
VdbGrid distance_grid(const std::vector<double>& places, const MeshRows& mesh, double voxel) {
  VdbLeaves leaves;
  std::vector<Crossing> crossings;
  for (std::size_t k = 0; k < mesh.corners.size(); k += 3) {
    Corners t;
    for (std::size_t c = 0; c < 3; ++c) {
      const double* place = places.data() + 3 * static_cast<std::size_t>(mesh.corners[k + c]);
      t[c] = Vec3d(place[0], place[1], place[2]) / voxel;
    }
    lower_distances(t, leaves);
    add_crossings(t, crossings);
  }
  turn_inside(std::move(crossings), leaves);
  VdbGrid grid{"surface", "level set", 1, voxel, static_cast<float>(band_voxels * voxel), {}};
  for (VdbLeaf& leaf : leaves.all())
    for (std::size_t k = 0; k < leaf_voxels; ++k) {
      float& value = leaf.value[k];
      leaf.active[k] = std::abs(value) < band_voxels * band_voxels;
      value = std::copysign(static_cast<float>(std::sqrt(std::abs(value)) * voxel), value);
      if (!leaf.active[k]) value = std::copysign(grid.background, value);
    }
  grid.leaves = leaves.take();
  return grid;
}

/// Nodes of the file's lattice, which has z up where the file has.
Vec3i turned_node(const Axes& axes, const Vec3i& node) {
  return axes.is_z_up() ? Vec3i(node.x(), -node.z(), node.y()) : node;
}

/// A grid of the nodes that carry mass. @param numbers  writes those of a node of the state
template <class Use>
VdbGrid node_grid(const sim::RasterizedNodes& nodes, const Axes& axes, const std::string& name,
                  int components, const Use& numbers) {
  VdbLeaves leaves;
  for (std::size_t b = 0; b < nodes.block.size(); ++b)
    for (int n = 0; n < 64; ++n) {
      const std::size_t from = 64 * b + static_cast<std::size_t>(n);
      if (!(nodes.mass[from] > 0)) continue;
      const Vec3i node = turned_node(axes, 4 * nodes.block[b] + Vec3i(n / 16, n / 4 % 4, n % 4));
      VdbLeaf& leaf = leaves.around(node, components, 0);
      const std::size_t at = VdbLeaves::index_in_leaf(node);
      leaf.active[at] = true;
      numbers(from, leaf.value.data() + at * static_cast<std::size_t>(components));
    }
  const char* kind = components == 1 ? "fog volume" : "";
  return {name, kind, components, axes.scale() * nodes.spacing, 0, leaves.take()};
}

}  // namespace

std::string encode_vdb(const ExportMoment& moment) {
  const sim::RasterizedNodes& nodes = moment.nodes();
  const Axes axes(moment.spec);
  const double cell = nodes.spacing * nodes.spacing * nodes.spacing;
  std::vector<VdbGrid> grids;
  grids.push_back(node_grid(nodes, axes, "mass", 1, [&](std::size_t n, float* to) {
    *to = static_cast<float>(nodes.mass[n]);
  }));
  grids.push_back(node_grid(nodes, axes, "density", 1, [&](std::size_t n, float* to) {
    *to = static_cast<float>(nodes.mass[n] / cell);
  }));
  grids.push_back(node_grid(nodes, axes, "velocity", 3, [&](std::size_t n, float* to) {
    const Vec3d v = axes.scaled(nodes.velocity[n]);
    for (int a = 0; a < 3; ++a) to[a] = static_cast<float>(v[a]);
  }));
  if (moment.table.mesh) {
    const double voxel = axes.scale() * moment.spec.surface_cell * particle_spacing(moment.scene);
    grids.push_back(distance_grid(moment.table.places(), *moment.table.mesh, voxel));
  }
  return vdb_file(grids,
                  {{"time", moment.state.time},
                   {"frame", moment.frame()},
                   {"fps", moment.scene.fps},
                   {"units_per_metre", moment.spec.scale}},
                  moment.state.hash);
}

}  // namespace neve::app::exports

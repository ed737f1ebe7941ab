
#include "app/exports/encode.h"
#include "app/exports/mesh_distance.h"
#include "app/exports/surface_table.h"
#include "app/exports/vdb_file.h"

namespace neve::app::exports {

namespace {

using sim::Vec3d;
using sim::Vec3i;

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

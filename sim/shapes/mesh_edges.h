#pragma once
/// The edges of a polygon mesh: which vertices are one, whether every edge is closed, and which
/// faces hang together.

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "sim/files/obj_reader.h"

namespace neve::sim::shapes {

struct MeshEdges {
  std::vector<std::uint32_t> vertex;  ///< for each vertex the one whose place it takes
  std::vector<std::uint32_t> part;    ///< of each polygon, from 0
  std::vector<bool> is_turned;        ///< polygons wound against their neighbours
  std::size_t part_count = 0;
  std::size_t near_welds = 0;  ///< vertices that nearly coincided with another, and no longer do
  std::string defect;          ///< with its place and what to do; empty: each part is closed
  std::vector<std::array<std::uint32_t, 2>> open_edges;  ///< vertices
};

/// Returns for every vertex the first one at the same position.
/// @param among  only vertices with the same number here are compared; empty: all
std::vector<std::uint32_t> coinciding(const std::vector<Vec3d>& vertices,
                                      const std::vector<std::uint32_t>& among = {});

/// Vertices at one position are one where that closes the mesh, those of the file where their
/// indices close it, so that parts which touch stay apart; vertices on open edges that nearly
/// coincide are one where neither does. A mesh is closed if as many faces run along each edge one
/// way as the other way, once faces are turned to agree with their neighbours.
/// @param name of the mesh in messages
/// @param together  the vertices at one position, as coinciding() has them
MeshEdges find_edges(const files::PolygonMesh& mesh, const std::string& name,
                     std::vector<std::uint32_t> together);

/// The corners of a polygon, of vertices that are one, without those that repeat their neighbour.
void merged_corners(const files::PolygonMesh& mesh, const std::vector<std::uint32_t>& vertex,
                    std::size_t polygon, std::vector<std::uint32_t>& corners);

}  // namespace neve::sim::shapes

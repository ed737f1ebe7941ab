#pragma once
/// Sparse grids as an OpenVDB file, without the library: it brings 80 MB of others along, and this
/// part of its format is a page. Source: OpenVDB 10, io/Archive.cc, io/Compression.h, tree/*.h.

#include <array>
#include <bitset>
#include <cstdint>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "sim/types/math.h"

namespace neve::app::exports {

inline constexpr int leaf_voxels = 8 * 8 * 8;

/// Voxel (x, y, z) of a leaf is number 64 x + 8 y + z.
struct VdbLeaf {
  sim::Vec3i origin = sim::Vec3i::Zero();  ///< of its first voxel, a multiple of 8
  std::bitset<leaf_voxels> active;
  std::vector<float> value;  ///< of each voxel as many as the grid has components
};

struct VdbGrid {
  std::string name;
  std::string kind;      ///< "fog volume", "level set"; may be empty
  int components = 1;    ///< 1: a float, 3: a vector
  double voxel = 1;      ///< units of the file from one voxel to the next; voxel 0 is at the origin
  float background = 0;  ///< of all that is in no leaf; a voxel that is not active has it, or minus
  std::vector<VdbLeaf> leaves;  ///< in any order, each origin once
};

/// Leaves by their place.
class VdbLeaves {
 public:
  /// The leaf around a voxel, made with this value if there is none.
  /// @param values  of the grid, per voxel
  VdbLeaf& around(const sim::Vec3i& voxel, int values, float fill);
  std::vector<VdbLeaf> take() { return std::move(leaves_); }
  std::vector<VdbLeaf>& all() { return leaves_; }

  /// The place of a voxel in its leaf.
  static std::size_t index_in_leaf(const sim::Vec3i& voxel) {
    return static_cast<std::size_t>((voxel.x() & 7) << 6 | (voxel.y() & 7) << 3 | (voxel.z() & 7));
  }

 private:
  std::unordered_map<std::uint64_t, std::size_t> places_;
  std::vector<VdbLeaf> leaves_;
  std::uint64_t last_key_ = 0;
  std::size_t last_ = 0;  ///< place of the last key
};

using VdbNumbers = std::vector<std::pair<std::string, double>>;

/// @param numbers   metadata of the file
/// @param identity  of the contents: the same for the same file
std::string vdb_file(const std::vector<VdbGrid>& grids, const VdbNumbers& numbers,
                     std::uint64_t identity);

}  // namespace neve::app::exports

#include "app/exports/vdb_file.h"

#include <fmt/core.h>

#include <map>

#include "app/exports/bytes.h"
#include "app/support/version.h"

namespace neve::app::exports {

namespace {

using sim::Vec3d;
using sim::Vec3i;

constexpr std::uint64_t vdb_magic = 0x56444220;  // "VDB "
constexpr std::uint32_t vdb_version = 224, library_major = 10, library_minor = 0;
constexpr std::uint32_t only_active_values = 2;

/// Bytes that tell which values of a node follow its masks.
constexpr char active_values = 0, all_values = 6;

/// Voxels along the sides of the nodes above a leaf: 16 leaves, and 32 of these.
constexpr int middle_bits = 7, upper_bits = 12;

void append_vdb_string(const std::string& text, std::string& bytes) {
  append_little(static_cast<std::uint32_t>(text.size()), bytes);
  bytes += text;
}

void append_text_entry(const std::string& name, const std::string& text, std::string& bytes) {
  append_vdb_string(name, bytes);
  append_vdb_string("string", bytes);
  append_vdb_string(text, bytes);
}

void append_place(const Vec3i& place, std::string& bytes) {
  for (int a = 0; a < 3; ++a) append_little(static_cast<std::int32_t>(place[a]), bytes);
}

void append_mask(const std::vector<bool>& mask, std::string& bytes) {
  for (std::size_t k = 0; k < mask.size(); k += 8) {
    unsigned byte = 0;
    for (std::size_t b = 0; b < 8; ++b) byte |= static_cast<unsigned>(mask[k + b]) << b;
    bytes.push_back(static_cast<char>(byte));
  }
}

void append_leaf_mask(const VdbLeaf& leaf, std::string& bytes) {
  std::vector<bool> mask(leaf_voxels);
  for (std::size_t k = 0; k < leaf_voxels; ++k) mask[k] = leaf.active[k];
  append_mask(mask, bytes);
}

/// The place of a child in a node of side 2^side children that are 2^child voxels wide.
std::size_t child_index(const Vec3i& origin, int child, int side) {
  const int mask = (1 << side) - 1;
  std::size_t index = 0;
  for (int a = 0; a < 3; ++a)
    index = index << side | static_cast<std::size_t>(origin[a] >> child & mask);
  return index;
}

/// Nodes in the order in which a file has them.
using Place = std::array<int, 3>;
using MiddleNode = std::map<std::size_t, const VdbLeaf*>;
using UpperNode = std::map<std::size_t, MiddleNode>;
using Root = std::map<Place, UpperNode>;

Root tree_of(const VdbGrid& grid) {
  Root root;
  for (const VdbLeaf& leaf : grid.leaves) {
    Place place{};
    for (int a = 0; a < 3; ++a)
      place[static_cast<std::size_t>(a)] = leaf.origin[a] >> upper_bits << upper_bits;
    root[place][child_index(leaf.origin, middle_bits, 5)][child_index(leaf.origin, 3, 4)] = &leaf;
  }
  return root;
}

/// A node without tiles: which children it has, and no values.
template <class Children>
void append_node(const Children& children, std::size_t size, std::string& bytes) {
  std::vector<bool> mask(size);
  for (const auto& [index, child] : children) mask[index] = true;
  append_mask(mask, bytes);
  append_mask(std::vector<bool>(size), bytes);
  bytes.push_back(active_values);
}

void append_background(const VdbGrid& grid, std::string& bytes) {
  for (int c = 0; c < grid.components; ++c) append_little(grid.background, bytes);
}

void append_topology(const VdbGrid& grid, const Root& root, std::string& bytes) {
  append_little(std::uint32_t{1}, bytes);  // one buffer of values
  append_background(grid, bytes);
  append_little(std::uint32_t{0}, bytes);  // tiles
  append_little(static_cast<std::uint32_t>(root.size()), bytes);
  for (const auto& [place, upper] : root) {
    append_place({place[0], place[1], place[2]}, bytes);
    append_node(upper, 32768, bytes);
    for (const auto& [k, middle] : upper) {
      append_node(middle, 4096, bytes);
      for (const auto& [n, leaf] : middle) append_leaf_mask(*leaf, bytes);
    }
  }
}

void append_values(const VdbGrid& grid, const VdbLeaf& leaf, std::string& bytes) {
  const auto width = static_cast<std::size_t>(grid.components);
  bool is_inside = false;
  for (std::size_t k = 0; k < leaf_voxels && !is_inside; ++k)
    is_inside = !leaf.active[k] && leaf.value[k * width] != grid.background;
  bytes.push_back(is_inside ? all_values : active_values);
  for (std::size_t k = 0; k < leaf_voxels; ++k)
    if (is_inside || leaf.active[k])
      for (std::size_t c = 0; c < width; ++c) append_little(leaf.value[k * width + c], bytes);
}

void append_buffers(const VdbGrid& grid, const Root& root, std::string& bytes) {
  for (const auto& [place, upper] : root)
    for (const auto& [k, middle] : upper)
      for (const auto& [n, leaf] : middle) {
        append_leaf_mask(*leaf, bytes);
        append_values(grid, *leaf, bytes);
      }
}

void append_transform(double voxel, std::string& bytes) {
  append_vdb_string("UniformScaleMap", bytes);
  for (const double number : {voxel, voxel, 1 / voxel, 1 / (voxel * voxel), 0.5 / voxel})
    for (int a = 0; a < 3; ++a) append_little(number, bytes);
}

/// The name and type of a grid, and where in the file its parts are.
void append_grid(const VdbGrid& grid, std::string& bytes) {
  append_vdb_string(grid.name, bytes);
  append_vdb_string(grid.components == 3 ? "Tree_vec3s_5_4_3" : "Tree_float_5_4_3", bytes);
  append_vdb_string("", bytes);  // shares the tree of no other grid
  const std::size_t positions = bytes.size();
  const auto put = [&](std::size_t k) {
    std::string place;
    append_little(static_cast<std::int64_t>(bytes.size()), place);
    bytes.replace(positions + 8 * k, 8, place);
  };
  bytes.append(24, '\0');
  put(0);
  append_little(only_active_values, bytes);
  append_little(std::uint32_t{grid.kind.empty() ? 1u : 2u}, bytes);
  if (!grid.kind.empty()) append_text_entry("class", grid.kind, bytes);
  append_text_entry("name", grid.name, bytes);
  append_transform(grid.voxel, bytes);
  const Root root = tree_of(grid);
  append_topology(grid, root, bytes);
  put(1);
  append_buffers(grid, root, bytes);
  put(2);
}

}  // namespace

VdbLeaf& VdbLeaves::around(const Vec3i& voxel, int values, float fill) {
  const auto bits = [](int c) { return static_cast<std::uint64_t>((c >> 3) + (1 << 20)); };
  const std::uint64_t key = bits(voxel.x()) << 42 | bits(voxel.y()) << 21 | bits(voxel.z());
  if (leaves_.empty() || key != last_key_) {
    const auto [place, is_new] = places_.try_emplace(key, leaves_.size());
    if (is_new) {
      VdbLeaf& made = leaves_.emplace_back();
      for (int a = 0; a < 3; ++a) made.origin[a] = voxel[a] & ~7;
      made.value.assign(static_cast<std::size_t>(leaf_voxels * values), fill);
    }
    last_key_ = key;
    last_ = place->second;
  }
  return leaves_[last_];
}

std::string vdb_file(const std::vector<VdbGrid>& grids, const VdbNumbers& numbers,
                     std::uint64_t identity) {
  std::string bytes;
  append_little(vdb_magic, bytes);
  for (const std::uint32_t number : {vdb_version, library_major, library_minor})
    append_little(number, bytes);
  bytes.push_back(1);  // grids say where they end
  bytes += fmt::format("{:08x}-{:04x}-{:04x}-6e65-000000007665", identity >> 32,
                       identity >> 16 & 0xffff, identity & 0xffff);
  append_little(static_cast<std::uint32_t>(numbers.size() + 1), bytes);
  append_text_entry("creator", "neve " + std::string(version), bytes);
  for (const auto& [name, value] : numbers) {
    append_vdb_string(name, bytes);
    append_vdb_string("double", bytes);
    append_little(std::uint32_t{8}, bytes);
    append_little(value, bytes);
  }
  append_little(static_cast<std::uint32_t>(grids.size()), bytes);
  for (const VdbGrid& grid : grids) append_grid(grid, bytes);
  return bytes;
}

}  // namespace neve::app::exports

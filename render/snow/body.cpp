#include "render/snow/body.h"

#include <algorithm>
#include <array>
#include <bit>
#include <utility>

#include "render/snow/grains.h"
#include "render/surface/loops.h"

namespace neve::render::snow {

namespace {

using surface::block_nodes;
using surface::block_side;
using surface::Field;
using surface::for_ranges;
using surface::no_block;

// Sizes in particle spacings. A wide kernel loses thin sheets, a narrow one shows every particle.
constexpr float cell_share = 0.8f, kernel_share = 0.8f;

/// Copies one row of nodes -1 to 9.
void pad_row(const Field& field, std::size_t b, int j, int k, float* to) {
  const auto side = static_cast<std::size_t>(((k + 8) >> 3) * 9 + ((j + 8) >> 3) * 3 + 1);
  const std::uint32_t other = field.near[b][side];
  if (other == no_block) {
    std::fill_n(to + 1, block_side, 0.0f);
  } else {
    const int row = (k & 7) << 6 | (j & 7) << 3;
    std::copy_n(field.value.data() + std::size_t{block_nodes} * other + row, block_side, to + 1);
  }
  to[0] = field.at(b, -1, j, k);
  to[block_side + 1] = field.at(b, block_side, j, k);
  to[block_side + 2] = field.at(b, block_side + 1, j, k);
}

/// Returns the nodes inside in a row of a padded block: bit i is that of node i, 0 to 8.
unsigned inside_bits(const float* row) {
  unsigned bits = 0;
  for (int i = 0; i <= block_side; ++i) bits |= (row[i + 1] >= surface_share ? 1u : 0u) << i;
  return bits;
}

/// Cells with corners on both sides of the surface.
/// @param padded  of a block
CellBox find_surface_cells(const float* padded) {
  constexpr int side = block_side + 1;
  std::array<unsigned, side * side> inside;
  for (int k = 0; k < side; ++k)
    for (int j = 0; j < side; ++j)
      inside[static_cast<std::size_t>(k * side + j)] =
          inside_bits(padded + ((k + 1) * padded_side + j + 1) * padded_side);
  CellBox box;
  for (int k = 0; k < block_side; ++k)
    for (int j = 0; j < block_side; ++j) {
      const unsigned* at = inside.data() + k * side + j;
      const unsigned any = at[0] | at[1] | at[side] | at[side + 1],
                     all = at[0] & at[1] & at[side] & at[side + 1];
      const unsigned cut = (any | any >> 1) & ~(all & all >> 1) & 0xff;
      if (cut == 0) continue;
      box.low = {std::min(box.low.x, std::countr_zero(cut)), std::min(box.low.y, j),
                 std::min(box.low.z, k)};
      box.high = {std::max(box.high.x, static_cast<int>(std::bit_width(cut)) - 1),
                  std::max(box.high.y, j), std::max(box.high.z, k)};
    }
  return box;
}

/// True if a block may have such cells: quick, and sure where it says no.
bool may_have_surface(const Field& field, std::size_t b) {
  const float* value = field.value.data() + b * block_nodes;
  int inside = 0;
  for (int n = 0; n < block_nodes; ++n) inside += value[n] >= surface_share ? 1 : 0;
  if (inside != 0 && inside != block_nodes) return true;
  // The last cells end at nodes of other blocks.
  const bool is_inside = inside != 0;
  for (int k = 0; k <= block_side; ++k)
    for (int j = 0; j <= block_side; ++j)
      for (int i = (k == block_side || j == block_side) ? 0 : block_side; i <= block_side; ++i)
        if ((field.at(b, i, j, k) >= surface_share) != is_inside) return true;
  return false;
}

void pad_blocks(ThreadPool* pool, Body& body) {
  const Field& field = body.field;
  std::vector<char> has(field.block.size());
  for_ranges(pool, has.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b) has[b] = may_have_surface(field, b) ? 1 : 0;
  });
  body.padded_of.assign(field.block.size(), no_block);
  for (std::size_t b = 0; b < has.size(); ++b) {
    if (!has[b]) continue;
    body.padded_of[b] = static_cast<std::uint32_t>(body.padded_block.size());
    body.padded_block.push_back(static_cast<std::uint32_t>(b));
  }
  body.padded.resize(body.padded_block.size() * padded_nodes);
  body.surface_box.resize(body.padded_block.size());
  for_ranges(pool, body.padded_block.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n) {
      float* to = body.padded.data() + n * padded_nodes;
      for (int k = -1; k < padded_side - 1; ++k)
        for (int j = -1; j < padded_side - 1; ++j, to += padded_side)
          pad_row(field, body.padded_block[n], j, k, to);
      body.surface_box[n] = find_surface_cells(body.padded.data() + n * padded_nodes);
    }
  });
}

/// All snow that the surface is made of.
Points with_cut_away(const Points& points) {
  Points all = points;
  const auto append = [](auto& to, const auto& from) {
    to.edit().insert(to.edit().end(), from.begin(), from.end());
  };
  append(all.position, points.cut->position);
  append(all.id, points.cut->id);
  append(all.value, points.cut->value);
  append(all.volume, points.cut->volume);
  append(all.blur, points.cut->blur);
  append(all.turn, points.cut->turn);
  append(all.to_solid, points.cut->to_solid);
  return all;
}

/// Snow near a ground or a solid continues behind its surface as its mirror image, so that its
/// field does not thin out there and its sides meet what it lies on.
void add_mirror_images(std::span<const GroundPlane> grounds, float spacing,
                       const std::vector<Vec3f>& to_solid, std::vector<Vec3f>& position,
                       std::vector<float>& volume) {
  const std::size_t count = position.size();
  for (std::size_t p = 0; p < to_solid.size(); ++p) {
    if (to_solid[p] == Vec3f{}) continue;
    position.push_back(position[p] + to_solid[p] * 2.0f);
    volume.push_back(volume[p]);
  }
  for (const GroundPlane& ground : grounds) {
    const Vec3f normal = normalized(ground.normal);
    for (std::size_t p = 0; p < count; ++p) {
      const float height = dot(position[p] - ground.point, normal);
      if (!(height > 0 && height < mirror_reach * spacing)) continue;
      position.push_back(position[p] - normal * (2 * height));
      volume.push_back(volume[p]);
    }
  }
}

/// Lets the field fall through the level at a plane.
/// @param normal  unit, towards where nothing is left
void end_at_plane(Vec3f point, Vec3f normal, Field& field, ThreadPool* pool) {
  constexpr float fall = 0.4f;    // per cell: snow next to the plane keeps its own share
  constexpr float untouched = 2;  // cells before the plane, from where all shares remain
  const double cell = static_cast<double>(field.cell);
  for_ranges(pool, field.block.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b) {
      float* value = field.value.data() + b * block_nodes;
      Vec3f corner;
      for (int axis = 0; axis < 3; ++axis)
        corner[axis] = static_cast<float>(block_side * field.block[b][axis] -
                                          static_cast<double>(point[axis]) / cell);
      const auto farthest = [&](int axis) {
        return std::max(normal[axis], 0.0f) * (block_side - 1);
      };
      if (dot(corner, normal) + farthest(0) + farthest(1) + farthest(2) < -untouched) continue;
      for (int n = 0; n < block_nodes; ++n) {
        const Vec3f node{static_cast<float>(n & 7), static_cast<float>(n >> 3 & 7),
                         static_cast<float>(n >> 6)};
        const float beyond = dot(corner + node, normal);
        value[n] = std::min(value[n], std::max(surface_share - fall * beyond, 0.0f));
      }
    }
  });
}

}  // namespace

FieldPlace find_place(const Body& body, Vec3f world) {
  surface::NodePlace place;
  if (!surface::find_node(world, body.field.cell, place)) return {};
  const Vec3i n = place.node;
  return {body.map.find(surface::block_key({n.x >> 3, n.y >> 3, n.z >> 3})), node_in_block(place)};
}

float share_at(const Field& field, std::uint32_t b, Vec3f place) {
  const int i = floor_to_int(place.x), j = floor_to_int(place.y), k = floor_to_int(place.z);
  const float x = place.x - static_cast<float>(i), y = place.y - static_cast<float>(j),
              z = place.z - static_cast<float>(k);
  std::array<float, 8> v;
  if ((static_cast<unsigned>(i) < 7) & (static_cast<unsigned>(j) < 7) &
      (static_cast<unsigned>(k) < 7)) {
    const float* at = field.value.data() + std::size_t{b} * block_nodes + 64 * k + 8 * j + i;
    v = {at[0], at[1], at[8], at[9], at[64], at[65], at[72], at[73]};
  } else {
    for (int n = 0; n < 8; ++n)
      v[static_cast<std::size_t>(n)] = field.at(b, i + (n & 1), j + (n >> 1 & 1), k + (n >> 2));
  }
  const auto mix = [](float a, float c, float t) { return a + (c - a) * t; };
  return mix(mix(mix(v[0], v[1], x), mix(v[2], v[3], x), y),
             mix(mix(v[4], v[5], x), mix(v[6], v[7], x), y), z);
}

Body make_body(const Points& shown, std::span<const GroundPlane> grounds, ThreadPool* pool) {
  std::optional<Points> with_cut;
  if (shown.cut) with_cut = with_cut_away(shown);
  const Points& points = with_cut ? *with_cut : shown;
  Body body;
  body.spacing = points.spacing;
  std::vector<Vec3f> position = points.position;
  std::vector<float> volume = points.volume;
  volume.resize(position.size(), points.spacing * points.spacing * points.spacing);
  add_mirror_images(grounds, points.spacing, points.to_solid, position, volume);
  const surface::Kernel kernel{cell_share * points.spacing, kernel_share * points.spacing};
  surface::GrainField made = surface::make_field({position, volume}, kernel, 0, pool);
  body.field = std::move(made.field);
  // A cell deeper than the ground, which hides it: above, the mirrored field is as it is.
  for (const GroundPlane& ground : grounds) {
    const Vec3f down = -normalized(ground.normal);
    end_at_plane(ground.point + down * (1.5f * body.field.cell), down, body.field, pool);
  }
  if (points.cut) end_at_plane(points.cut->point, points.cut->normal, body.field, pool);
  pad_blocks(pool, body);

  for (const Vec3i& block : body.field.block) body.map.insert(surface::block_key(block));
  const GrainPlaces places = place_grains(points, made, body, pool);
  list_grains(points, places, pool, body);
  take_spray(points, shown.position.size(), places, body);
  return body;
}

}  // namespace neve::render::snow

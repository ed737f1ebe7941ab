#include "render/snow/body.h"

#include <algorithm>
#include <utility>

#include "render/frame/point_list.h"
#include "render/surface/loops.h"
#include "sim/base/hash.h"

namespace neve::render::snow {

namespace {

using surface::block_nodes;
using surface::block_side;
using surface::Field;
using surface::for_ranges;
using surface::no_block;

// In particle spacings. A wider kernel loses thin sheets, a narrower one shows every particle.
constexpr float cell_share = 0.8f, kernel_share = 0.8f;

/// Share at its own place below which a particle is drawn as a grain of its own: the surface may
/// miss it. Inside flat packed snow the outermost particles have 0.73, along edges 0.54.
constexpr float covered_share = 0.46f;

/// Share above which a particle lies so deep that no place of the surface has it for the nearest.
constexpr float buried_share = 0.97f;

/// Spray is drawn as crumbs of small balls, in particle spacings: their radius, and how far from
/// the particle they lie at most along each axis. Few and large ones look like beads.
constexpr float ball_radius = 0.18f, ball_offset = 0.42f;
constexpr std::uint32_t balls_per_grain = 9;

/// How far the middle of a grain lies from its particle at most along each axis, in spacings.
constexpr float grain_offset = 0.3f;

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

/// Cells with corners on both sides of the surface.
/// @param padded  of a block
/// @return whether there is one
bool find_surface_cells(const float* padded, CellBox& box) {
  constexpr int row = padded_side, slice = padded_side * padded_side;
  bool has_any = false;
  for (int k = 0; k < block_side; ++k)
    for (int j = 0; j < block_side; ++j) {
      const float* at = padded + (k + 1) * slice + (j + 1) * row + 1;
      for (int i = 0; i < block_side; ++i, ++at) {
        const float low = std::min({at[0], at[1], at[row], at[row + 1], at[slice], at[slice + 1],
                                    at[slice + row], at[slice + row + 1]});
        const float high = std::max({at[0], at[1], at[row], at[row + 1], at[slice], at[slice + 1],
                                     at[slice + row], at[slice + row + 1]});
        if (low >= surface_share || high < surface_share) continue;
        has_any = true;
        box.low = {std::min(box.low.x, i), std::min(box.low.y, j), std::min(box.low.z, k)};
        box.high = {std::max(box.high.x, i), std::max(box.high.y, j), std::max(box.high.z, k)};
      }
    }
  return has_any;
}

/// Whether a block may have such cells: quick, and sure where it says no.
bool may_have_surface(const Field& field, std::size_t b) {
  const float* value = field.value.data() + b * block_nodes;
  const auto [low, high] = std::minmax_element(value, value + block_nodes);
  if (*low < surface_share && *high >= surface_share) return true;
  // The last cells end at nodes of other blocks.
  const bool is_inside = *high >= surface_share;
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
      find_surface_cells(body.padded.data() + n * padded_nodes, body.surface_box[n]);
    }
  });
}

struct GrainPlace {
  std::uint32_t cube = no_block;  ///< of the grain; no_block: off the field
  float share = 0;                ///< of the field at the particle
};

GrainPlace grain_place(const Body& body, Vec3f particle, Vec3f grain) {
  GrainPlace out;
  if (const FieldPlace at = find_place(body, particle); at.block != no_block)
    out.share = share_at(body.field, at.block, at.node);
  const FieldPlace place = find_place(body, grain);
  if (place.block == no_block) return out;
  const auto cube = [](float node) { return static_cast<std::uint32_t>(node) >> 1; };
  out.cube = place.block * cubes_per_block +
             (cube(place.node.z) << 4 | cube(place.node.y) << 2 | cube(place.node.x));
  return out;
}

std::uint32_t id_of(const Points& points, std::size_t p) {
  return points.id.empty() ? static_cast<std::uint32_t>(p) : points.id[p];
}

/// Three numbers between -1 and 1.
Vec3f random_offset(std::uint64_t key) {
  const std::uint64_t random = mix64(key);
  const auto along = [&](int bits) {
    return static_cast<float>(random >> bits & 0xffff) * (2.0f / 65535) - 1;
  };
  return {along(0), along(16), along(32)};
}

/// From the particle, in the frame of the snow.
Vec3f turned(const Points& points, std::size_t p, Vec3f offset) {
  return points.turn.empty() ? offset : Turn(points.turn[p]).forth(offset);
}

/// Middle of the grain that a particle brings.
Vec3f grain_position(const Points& points, std::size_t p) {
  const Vec3f offset =
      random_offset(std::uint64_t{id_of(points, p)} + 1) * (grain_offset * points.spacing);
  return points.position[p] + turned(points, p, offset);
}

/// @param bins  one for each cube
void list_grains(const Points& points, const surface::Bins& bins, Body& body) {
  const PointColors color(points);
  GrainList& grains = body.grains;
  grains.first = bins.first;
  grains.position.reserve(bins.grain.size());
  grains.color.reserve(bins.grain.size());
  grains.seed.reserve(bins.grain.size());
  for (const std::uint32_t p : bins.grain) {
    grains.position.push_back(grain_position(points, p));
    grains.color.push_back(color.root_albedo(p));
    grains.seed.push_back(static_cast<std::uint32_t>(mix64(id_of(points, p) + 1)));
    if (!points.turn.empty()) grains.turn.push_back(points.turn[p]);
  }
}

/// The lump of a particle looks the same wherever it flies, and turns with it.
void add_lump(const Points& points, std::size_t p, Points& spray) {
  const std::uint32_t id = id_of(points, p);
  for (std::uint32_t ball = 0; ball < balls_per_grain; ++ball) {
    const Vec3f random = random_offset(std::uint64_t{id} * balls_per_grain + ball + 1);
    // Denser in the middle.
    const Vec3f offset = random * (ball_offset * points.spacing * length(random));
    spray.position.push_back(points.position[p] + turned(points, p, offset));
    spray.id.push_back(id);
    if (!points.value.empty()) spray.value.push_back(points.value[p]);
  }
}

/// @param count  points that are not cut away
void take_spray(const Points& points, std::size_t count, const std::vector<GrainPlace>& places,
                Points& spray) {
  for (std::size_t p = 0; p < count; ++p)
    if (!(places[p].share >= covered_share)) add_lump(points, p, spray);
  spray.spacing = points.spacing;
  spray.radius = ball_radius * points.spacing;
  spray.colormap = points.colormap;
  spray.range_min = points.range_min;
  spray.range_max = points.range_max;
}

/// All snow that the surface is made of.
Points with_cut_away(const Points& points) {
  Points all = points;
  const auto append = [](auto& to, const auto& from) {
    to.insert(to.end(), from.begin(), from.end());
  };
  append(all.position, points.cut->position);
  append(all.id, points.cut->id);
  append(all.value, points.cut->value);
  append(all.volume, points.cut->volume);
  append(all.turn, points.cut->turn);
  return all;
}

/// Snow near a ground goes on below it as its mirror image, so that its field does not thin out
/// there and its sides meet the ground.
void mirror_in_grounds(std::span<const GroundPlane> grounds, float spacing,
                       std::vector<Vec3f>& position, std::vector<float>& volume) {
  constexpr float reach = 2.2f;  // spacings: beyond, the kernel has no weight to speak of
  const std::size_t count = position.size();
  for (const GroundPlane& ground : grounds) {
    const Vec3f normal = normalized(ground.normal);
    for (std::size_t p = 0; p < count; ++p) {
      const float height = dot(position[p] - ground.point, normal);
      if (!(height > 0 && height < reach * spacing)) continue;
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
  const auto in_block = [](int node, float rest) {
    return static_cast<float>(node & 7) + std::min(rest, 0.9999f);
  };
  return {body.map.find(surface::block_key({n.x >> 3, n.y >> 3, n.z >> 3})),
          {in_block(n.x, place.rest.x), in_block(n.y, place.rest.y), in_block(n.z, place.rest.z)}};
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
  mirror_in_grounds(grounds, points.spacing, position, volume);
  const surface::Kernel kernel{cell_share * points.spacing, kernel_share * points.spacing};
  body.field = surface::make_field({position, volume}, kernel, 0, pool).field;
  // A cell deeper than the ground, which hides it: above, the mirrored field is as it is.
  for (const GroundPlane& ground : grounds) {
    const Vec3f down = -normalized(ground.normal);
    end_at_plane(ground.point + down * (1.5f * body.field.cell), down, body.field, pool);
  }
  if (points.cut) end_at_plane(points.cut->point, points.cut->normal, body.field, pool);
  pad_blocks(pool, body);

  for (const Vec3i& block : body.field.block) body.map.insert(surface::block_key(block));
  std::vector<GrainPlace> places(points.position.size());
  for_ranges(pool, places.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p)
      places[p] = grain_place(body, points.position[p], grain_position(points, p));
  });
  std::vector<std::uint32_t> cube_of(places.size(), no_block);
  for (std::size_t p = 0; p < places.size(); ++p)
    if (!(places[p].share > buried_share)) cube_of[p] = places[p].cube;
  list_grains(points, surface::sorted_into_bins(cube_of, body.field.block.size() * cubes_per_block),
              body);
  take_spray(points, shown.position.size(), places, body.spray);
  return body;
}

}  // namespace neve::render::snow

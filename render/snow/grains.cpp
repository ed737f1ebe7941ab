#include "render/snow/grains.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "render/frame/point_list.h"
#include "render/snow/shading.h"
#include "render/surface/loops.h"
#include "sim/base/hash.h"

namespace neve::render::snow {

namespace {

using surface::Field;
using surface::for_ranges;
using surface::no_block;

/// Share at its own place below which a particle is drawn as a grain of its own: the surface may
/// miss it. Inside flat packed snow the outermost particles have 0.73, along edges 0.54.
constexpr float covered_share = 0.46f;

/// Share above which a particle lies so deep that no place of the surface has it for the nearest.
constexpr float buried_share = 0.97f;

/// Spray is drawn as crumbs of small balls, in particle spacings: their radius, and how far from
/// the particle they lie at most along each axis in a crumb of size 1. Few and large ones look like
/// beads, crumbs of one size like popcorn: sizes differ by a factor of five, small ones are as many
/// as large ones on a logarithmic scale, and balls of a crumb as many as its area asks for.
constexpr float ball_radius = 0.17f, ball_offset = 0.42f;
constexpr float smallest_crumb = 0.32f, largest_crumb = 1.6f, balls_of_crumb = 9;
/// The most that a crumb has; ids of its balls.
constexpr std::uint32_t max_balls = 32;

/// Largest distance of the middle of a grain from its particle along each axis, in spacings.
constexpr float grain_offset = 0.3f;

std::uint32_t id_of(const Points& points, std::size_t p) {
  return points.id.empty() ? static_cast<std::uint32_t>(p) : points.id[p];
}

/// Three numbers between -1 and 1.
NEVE_INLINE Vec3f random_offset(std::uint64_t key) {
  const std::uint64_t random = mix64(key);
  const auto along = [&](int bits) {
    return static_cast<float>(random >> bits & 0xffff) * (2.0f / 65535) - 1;
  };
  return {along(0), along(16), along(32)};
}

/// Turns an offset from a particle as its snow has turned.
NEVE_INLINE Vec3f turned(const Points& points, std::size_t p, Vec3f offset) {
  return points.turn.empty() ? offset : Turn(points.turn[p]).forth(offset);
}

/// Middle of the grain that a particle brings.
NEVE_INLINE Vec3f grain_position(const Points& points, std::size_t p, Vec3f particle) {
  const Vec3f offset =
      random_offset(std::uint64_t{id_of(points, p)} + 1) * (grain_offset * points.spacing);
  return particle + turned(points, p, offset);
}

/// The same as find_place, quicker near a block.
NEVE_INLINE FieldPlace place_near(const Body& body, std::size_t b, Vec3f world) {
  const Field& field = body.field;
  surface::NodePlace place;
  if (!surface::find_node(world, field.cell, place)) return {};
  const Vec3i n = place.node,
              side = {(n.x >> 3) - field.block[b].x + 1, (n.y >> 3) - field.block[b].y + 1,
                      (n.z >> 3) - field.block[b].z + 1};
  const auto is_near = [](int s) { return s >= 0 && s <= 2; };
  if (!is_near(side.x) || !is_near(side.y) || !is_near(side.z)) return find_place(body, world);
  return {field.near[b][static_cast<std::size_t>(9 * side.z + 3 * side.y + side.x)],
          node_in_block(place)};
}

/// Factor of the grain of snow that moves while the shutter is open. Each place of the picture then
/// shows the mean of all grains that pass it, which varies less by the root of their number: fast
/// snow looked like cotton wool. Streaks of stronger grain remain.
/// @param blur  m
NEVE_INLINE float relief_in_motion(float blur, float spacing) {
  constexpr float grain_length = 1.0f;  // spacings
  constexpr float largest = 3;          // steeper relief darkens snow
  return std::min(std::sqrt(1 + blur / (grain_length * spacing)), largest);
}

/// Each grain is a little darker or lighter than the next: a second scale of grain, above that of
/// its relief. Colours of values stay what their legend says.
NEVE_INLINE std::uint32_t toned(std::uint32_t root_albedo, std::uint32_t seed, float relief) {
  constexpr float darkest = 0.06f;  // of the root of the albedo
  const float chance = static_cast<float>(seed >> 8) * 0x1p-24f;
  // Snow is as light on average, however much grains differ.
  const float tone = 1 - darkest * (relief * chance * chance + (1 - relief) / 3);
  std::uint32_t word = root_albedo & 0xff000000u;
  for (int shift = 0; shift < 24; shift += 8)
    word |= static_cast<std::uint32_t>(
                std::min(static_cast<float>(root_albedo >> shift & 0xff) * tone + 0.5f, 255.0f))
            << shift;
  return word;
}

/// @param find  FieldPlace of a place in the world
NEVE_INLINE void place_grain(const Points& points, std::size_t p, Vec3f position,
                             const Field& field, const auto& find, GrainPlaces& places) {
  const FieldPlace at = find(position);
  places.share[p] = at.block == no_block ? 0 : share_at(field, at.block, at.node);
  if (places.share[p] > buried_share) return;
  const FieldPlace place = find(grain_position(points, p, position));
  if (place.block == no_block) return;
  const auto cube = [](float node) { return static_cast<std::uint32_t>(node) >> 1; };
  places.cube[p] = place.block * cubes_per_block +
                   (cube(place.node.z) << 4 | cube(place.node.y) << 2 | cube(place.node.x));
}

/// The middle of a lump, and the part of it that has sunk into a surface.
struct LumpPlace {
  Vec3f middle;
  float sunk = 0;
};

/// The outermost particles along the edges of a body lie on its surface: beside it they look like
/// fur. Loose ones remain where they are.
/// @param share  at the particle
LumpPlace lump_place(const Body& body, Vec3f particle, float share) {
  const FieldPlace at = find_place(body, particle);
  if (at.block == no_block || !(share > 0)) return {particle};
  constexpr float farthest = 1.0f;            // nodes
  constexpr float none = 0.38f, all = 0.46f;  // share to which it can sink
  const Vec3f outward = normal_at(body.field, at.block, at.node);
  const auto share_below = [&](float nodes) {
    return share_at(body.field, at.block, at.node - outward * nodes);
  };
  const float rise = std::max(share_below(farthest) - share, 1e-3f);
  const float way = std::min((surface_share - share) / rise, 1.0f) * farthest;
  const float t = std::clamp((share_below(way) - none) / (all - none), 0.0f, 1.0f);
  const float sunk = t * t * (3 - 2 * t);
  return {particle - outward * (way * sunk * body.field.cell), sunk};
}

/// The lump of a particle looks the same wherever it flies, and turns with it. Those along edges
/// are all of size 1: they make the surface.
void add_lump(const Points& points, std::size_t p, const LumpPlace& place, Points& spray) {
  const std::uint32_t id = id_of(points, p);
  const float chance = static_cast<float>(mix64(~std::uint64_t{id}) >> 40) * 0x1p-24f;
  const float loose = smallest_crumb * std::pow(largest_crumb / smallest_crumb, chance);
  const float size = loose + (1 - loose) * place.sunk;
  const float reach = ball_offset * (1 - 0.5f * place.sunk) * std::pow(size, 0.8f) * points.spacing;
  const auto balls = static_cast<std::uint32_t>(
      std::clamp(balls_of_crumb * size * size, 1.0f, static_cast<float>(max_balls)));
  for (std::uint32_t ball = 0; ball < balls; ++ball) {
    const Vec3f random = random_offset(std::uint64_t{id} * max_balls + ball + 1);
    // Offsets are denser in the middle.
    const Vec3f offset = random * (reach * length(random));
    spray.position.edit().push_back(place.middle + turned(points, p, offset));
    spray.id.edit().push_back(id);
    if (!points.value.empty()) spray.value.edit().push_back(points.value[p]);
  }
}

}  // namespace

GrainPlaces place_grains(const Points& points, const surface::GrainField& made, const Body& body,
                         ThreadPool* pool) {
  const surface::Bins& blocks = made.grains;
  const std::size_t count = points.position.size();
  constexpr float not_placed = -1;
  GrainPlaces places{std::vector<float>(count, not_placed),
                     std::vector<std::uint32_t>(count, no_block)};
  for_ranges(pool, body.field.block.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b) {
      const auto find = [&](Vec3f world) NEVE_INLINE_BODY { return place_near(body, b, world); };
      for (std::uint32_t k = blocks.first[b]; k < blocks.first[b + 1]; ++k)
        if (blocks.grain[k] < count)
          place_grain(points, blocks.grain[k], made.placed[k].position, body.field, find, places);
    }
  });
  // Those that give the field nothing may still lie in it.
  const auto find = [&](Vec3f world) { return find_place(body, world); };
  for (std::size_t p = 0; p < count; ++p)
    if (places.share[p] == not_placed)
      place_grain(points, p, points.position[p], body.field, find, places);
  return places;
}

void list_grains(const Points& points, const GrainPlaces& places, ThreadPool* pool, Body& body) {
  const std::size_t cubes = body.field.block.size() * cubes_per_block;
  surface::Bins bins = surface::sorted_into_bins(places.cube, cubes, pool);
  const PointColors color(points);
  GrainList& grains = body.grains;
  const std::size_t count = bins.grain.size();
  grains.first = std::move(bins.first);
  grains.grain.resize(count);
  for (std::vector<float>& along : grains.along) along.resize(count + grain_margin);
  for_ranges(pool, count, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      const std::uint32_t p = bins.grain[k];
      const Vec3f place = grain_position(points, p, points.position[p]);
      for (int axis = 0; axis < 3; ++axis)
        grains.along[static_cast<std::size_t>(axis)][k] = place[axis];
      const PackedTurn turn = points.turn.empty() ? no_turn : points.turn[p];
      const auto seed = static_cast<std::uint32_t>(mix64(id_of(points, p) + 1));
      const std::uint32_t albedo = color.root_albedo(p);
      const float relief =
          points.blur.empty() ? 1 : relief_in_motion(points.blur[p], points.spacing);
      grains.grain[k] = {place,
                         points.value.empty() ? toned(albedo, seed, relief) : albedo,
                         seed,
                         {turn[0], turn[1], turn[2], turn[3]},
                         relief};
    }
  });
}

void take_spray(const Points& points, std::size_t count, const GrainPlaces& places, Body& body) {
  Points& spray = body.spray;
  for (std::size_t p = 0; p < count; ++p)
    if (!(places.share[p] >= covered_share))
      add_lump(points, p, lump_place(body, points.position[p], places.share[p]), spray);
  spray.spacing = points.spacing;
  spray.radius = ball_radius * points.spacing;
  spray.colormap = points.colormap;
  spray.range_min = points.range_min;
  spray.range_max = points.range_max;
}

}  // namespace neve::render::snow

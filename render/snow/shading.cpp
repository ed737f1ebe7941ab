#include "render/snow/shading.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "render/light/shading_constants.h"
#include "render/snow/grain_noise.h"
#include "sim/base/hash.h"

namespace neve::render::snow {

namespace {

using light::LightVolume;
using surface::no_block;

float unit(float x) {
  return std::clamp(x, 0.0f, 1.0f);
}

float smooth_step(float low, float high, float x) {
  const float t = unit((x - low) / (high - low));
  return t * t * (3 - 2 * t);
}

struct Arriving {
  float key = 1, sky = 1;
};

/// Linear between cells; all light outside of the volume.
Arriving arriving_at(const LightVolume& volume, Vec3f world) {
  const light::LightGrid& grid = volume.grid;
  const Vec3f p = (world - grid.origin) * (1 / grid.cell);
  for (int axis = 0; axis < 3; ++axis)
    if (!(p[axis] > 0 && p[axis] < static_cast<float>(grid.size[axis]))) return {};
  std::array<int, 3> low{};
  std::array<float, 3> part{};
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    const float x = std::clamp(p[axis] - 0.5f, 0.0f, static_cast<float>(grid.size[axis] - 1));
    low[a] = std::min(static_cast<int>(x), std::max(grid.size[axis] - 2, 0));
    part[a] = x - static_cast<float>(low[a]);
  }
  float key = 0, sky = 0;
  for (int n = 0; n < 8; ++n) {
    const int i = std::min(low[0] + (n & 1), grid.size.x - 1),
              j = std::min(low[1] + (n >> 1 & 1), grid.size.y - 1),
              k = std::min(low[2] + (n >> 2), grid.size.z - 1);
    const float w = ((n & 1) ? part[0] : 1 - part[0]) * ((n >> 1 & 1) ? part[1] : 1 - part[1]) *
                    ((n >> 2) ? part[2] : 1 - part[2]);
    const std::size_t at = 2 * static_cast<std::size_t>((k * grid.size.y + j) * grid.size.x + i);
    key += w * static_cast<float>(volume.light[at]);
    sky += w * static_cast<float>(volume.light[at + 1]);
  }
  return {key / 65535, sky / 65535};
}

/// Reach of near shadows from a block: its neighbours.
Vec3f within_reach(Vec3f node) {
  const auto keep = [](float x) { return std::clamp(x, -6.5f, 13.5f); };
  return {keep(node.x), keep(node.y), keep(node.z)};
}

/// Part of the sun that near snow leaves: what the cells of the light volume are too coarse for.
/// Starts where flat snow does not shade itself, however low the sun.
/// @param share  of a place in nodes, within reach
NEVE_INLINE float near_sun(const auto& share, const SnowPlace& place, Vec3f normal, Vec3f toward) {
  const Vec3f start = place.node + normal * 1.4f;
  float thickness = 0;
  for (int n = 0; n < 4; ++n) {
    const Vec3f at = start + toward * (0.7f + 1.15f * static_cast<float>(n));
    thickness += std::max(0.0f, share(within_reach(at)) - 0.12f);
  }
  return std::exp(-1.5f * thickness);
}

/// Part of the sun that comes through snow a few spacings thick.
NEVE_INLINE float near_through(const auto& share, const SnowPlace& place, Vec3f toward) {
  const auto at = [&](float nodes)
                      NEVE_INLINE_BODY { return share(within_reach(place.node + toward * nodes)); };
  const float thickness = at(0.7f) + 1.3f * at(1.9f) + 1.7f * at(3.4f) + 2.2f * at(5.4f);
  return std::exp(-0.5f * thickness);
}

/// Part of the sky that near snow leaves.
NEVE_INLINE float near_sky(const auto& share, const SnowPlace& place, Vec3f normal) {
  // The bumps of flat snow are no crevices.
  const auto over = [&](float nodes) NEVE_INLINE_BODY {
    return std::max(0.0f, share(within_reach(place.node + normal * nodes)) - 0.04f);
  };
  return 1 / (1 + 2.2f * over(2.0f) + 1.4f * over(4.0f));
}

/// Well within the faces that no sun shines through to; see snow_light_kernel.h.
bool faces_sun(Vec3f normal, const SnowLight& light) {
  return dot(normal, light.toward) > 0.45f;
}

/// Light that far snow and solids leave.
Exposure expose_to_far(const LightVolume& volume, const SnowLight& light, const SnowPlace& place,
                       Vec3f normal) {
  const float cell = volume.grid.cell;
  const Vec3f above = place.world + normal * (1.2f * cell);
  Exposure out;
  out.normal = normal;
  out.sun = arriving_at(volume, above + light.toward * cell).key;
  out.sky = arriving_at(volume, above).sky;
  // Nothing is before a face that the sun shines on. Behind, more arrives than goes straight on:
  // most light that snow scatters goes ahead.
  out.through =
      faces_sun(normal, light) ? out.sun : std::sqrt(arriving_at(volume, place.world).key);
  return out;
}

/// The facet in the tiny cell of a grain that a place is in; one in a hundred mirrors the sun.
NEVE_INLINE Vec3f facet_of(std::uint32_t seed, Vec3f offset) {
  constexpr float cells = 6;
  const auto cell = [](float x) {
    return static_cast<std::uint64_t>(floor_to_int(x * cells) + 64);
  };
  const std::uint64_t random = mix64(std::uint64_t{seed} << 24 ^ cell(offset.x) << 16 ^
                                     cell(offset.y) << 8 ^ cell(offset.z));
  const auto along = [&](int bits) {
    return static_cast<float>(random >> bits & 0xffff) * (2.0f / 65535) - 1;
  };
  return normalized(Vec3f{along(0), along(16), along(32)});
}

/// Distance over which one grain goes over into the next, in spacings.
constexpr float blend = 0.35f;

}  // namespace

GrainLook look_of_grain(const Body& body, Vec3f world, float pixels, bool wants_facet,
                        std::uint32_t p) {
  const GrainList& grains = body.grains;
  const int detail = pixels > 7 ? 0 : pixels > 3.5f ? 1 : 2;
  constexpr float units_per_spacing = 1.4f;
  GrainLook out;
  const std::uint32_t color = grains.color[p];
  const auto channel = [&](int shift) {
    const float root = static_cast<float>(color >> shift & 0xff) * (1.0f / 255);
    return root * root;
  };
  out.albedo = {channel(0), channel(8), channel(16)};
  const std::uint32_t seed = grains.seed[p];
  const auto shift = [&](int bits) {
    return static_cast<float>(seed >> bits & 0xff) * (4.0f / 256);
  };
  const Turn turn(grains.turn.empty() ? no_turn : grains.turn[p]);
  const Vec3f offset = turn.back((world - grains.position[p]) * (1 / body.spacing));
  if (wants_facet) out.facet = facet_of(seed, offset);
  const Relief relief =
      grain_noise().at(offset * units_per_spacing + Vec3f{shift(0), shift(8), shift(16)}, detail);
  out.height = relief.height;
  out.slope = turn.forth(relief.slope) * units_per_spacing;
  return out;
}

float part_of_second(float first_squared, float second_squared, float spacing) {
  const float between = (std::sqrt(second_squared) - std::sqrt(first_squared)) / spacing;
  return 0.5f * (1 - smooth_step(0, blend, between));
}

Vec3f normal_at(const surface::Field& field, std::uint32_t b, Vec3f q) {
  const auto share = [&](float x, float y, float z) {
    return share_at(field, b, q + Vec3f{x, y, z});
  };
  // Wide enough to leave out the bumps of single particles: grain is finer, broken faces are
  // rougher.
  constexpr float d = 1.4f;
  return normalized(Vec3f{share(-d, 0, 0) - share(d, 0, 0), share(0, -d, 0) - share(0, d, 0),
                          share(0, 0, -d) - share(0, 0, d)});
}

void NearField::take(const surface::Field& field, std::uint32_t block) {
  constexpr int block_side = surface::block_side;
  float* to = value_.data();
  for (int k = -margin; k < block_side + margin; ++k)
    for (int j = -margin; j < block_side + margin; ++j) {
      const auto row = static_cast<std::size_t>(((k + 8) >> 3) * 9 + ((j + 8) >> 3) * 3);
      const int first = (k & 7) << 6 | (j & 7) << 3;
      const auto copy = [&](std::size_t side, int from, int count) {
        const std::uint32_t other = field.near[block][row + side];
        if (other == no_block)
          std::fill_n(to, count, 0.0f);
        else
          std::copy_n(field.value.data() + std::size_t{surface::block_nodes} * other + first + from,
                      count, to);
        to += count;
      };
      copy(0, block_side - margin, margin);
      copy(1, 0, block_side);
      copy(2, 0, margin);
    }
}

float NearField::share(Vec3f node) const {
  const int i = floor_to_int(node.x), j = floor_to_int(node.y), k = floor_to_int(node.z);
  const float x = node.x - static_cast<float>(i), y = node.y - static_cast<float>(j),
              z = node.z - static_cast<float>(k);
  const float* at = value_.data() + ((k + margin) * side + j + margin) * side + i + margin;
  const auto mix_along = [](float a, float c, float t) NEVE_INLINE_BODY { return a + (c - a) * t; };
  const auto slice = [&](const float* v) NEVE_INLINE_BODY {
    return mix_along(mix_along(v[0], v[1], x), mix_along(v[side], v[side + 1], x), y);
  };
  return mix_along(slice(at), slice(at + side * side), z);
}

Vec3f NearField::even_fall(Vec3i node) const {
  constexpr int apart = 2, step[3] = {1, side, side * side};
  const float* middle =
      value_.data() + ((node.z + margin) * side + node.y + margin) * side + node.x + margin;
  Vec3f fall;
  for (int axis = 0; axis < 3; ++axis) {
    const int ahead = apart * step[axis], across = apart * step[(axis + 1) % 3],
              up = apart * step[(axis + 2) % 3];
    for (int line = 0; line < 9; ++line) {
      const float* at = middle + (line % 3 - 1) * across + (line / 3 - 1) * up;
      fall[axis] += at[-ahead] - at[ahead];
    }
  }
  return fall;
}

Exposure expose(const Body& body, const LightVolume& volume, const SnowLight& light,
                const SnowPlace& place, Vec3f normal) {
  Exposure out = expose_to_far(volume, light, place, normal);
  if (place.block == no_block) return out;
  const auto share = [&](Vec3f node) { return share_at(body.field, place.block, node); };
  out.sun *= near_sun(share, place, normal, light.toward);
  if (!faces_sun(normal, light)) out.through *= near_through(share, place, light.toward);
  out.crevice = near_sky(share, place, normal);
  return out;
}

Exposure expose(const NearField& near, const LightVolume& volume, const SnowLight& light,
                const SnowPlace& place, Vec3f normal) {
  Exposure out = expose_to_far(volume, light, place, normal);
  const auto share = [&](Vec3f node) NEVE_INLINE_BODY { return near.share(node); };
  out.sun *= near_sun(share, place, normal, light.toward);
  if (!faces_sun(normal, light)) out.through *= near_through(share, place, light.toward);
  out.crevice = near_sky(share, place, normal);
  return out;
}

}  // namespace neve::render::snow

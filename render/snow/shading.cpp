#include "render/snow/shading.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "render/cpu/near_light_kernel.h"
#include "render/light/shading_constants.h"

namespace neve::render::snow {

namespace {

using light::LightVolume;
using surface::no_block;

/// Numbers of a cell of the light volume.
constexpr int key_light = 0, sky_light = 1;

/// Linear between cells; all light outside of the volume.
float arriving_at(const LightVolume& volume, Vec3f world, int light) {
  const light::LightGrid& grid = volume.grid;
  const Vec3f p = (world - grid.origin) * (1 / grid.cell);
  for (int axis = 0; axis < 3; ++axis)
    if (!(p[axis] > 0 && p[axis] < static_cast<float>(grid.size[axis]))) return 1;
  std::array<int, 3> low{};
  std::array<float, 3> part{};
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    const float x = std::clamp(p[axis] - 0.5f, 0.0f, static_cast<float>(grid.size[axis] - 1));
    low[a] = std::min(static_cast<int>(x), std::max(grid.size[axis] - 2, 0));
    part[a] = x - static_cast<float>(low[a]);
  }
  float sum = 0;
  for (int n = 0; n < 8; ++n) {
    const int i = std::min(low[0] + (n & 1), grid.size.x - 1),
              j = std::min(low[1] + (n >> 1 & 1), grid.size.y - 1),
              k = std::min(low[2] + (n >> 2), grid.size.z - 1);
    const float w = ((n & 1) ? part[0] : 1 - part[0]) * ((n >> 1 & 1) ? part[1] : 1 - part[1]) *
                    ((n >> 2) ? part[2] : 1 - part[2]);
    const int cell = (k * grid.size.y + j) * grid.size.x + i;
    sum += w * static_cast<float>(volume.light[static_cast<std::size_t>(2 * cell + light)]);
  }
  return sum / 65535;
}

/// True well within the faces that no sun shines through to; see snow_light_kernel.h.
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
  out.sun = arriving_at(volume, above + light.toward * cell, key_light);
  out.sky = arriving_at(volume, above, sky_light);
  // Nothing is before a face that the sun shines on. Behind, more arrives than goes straight on:
  // most light that snow scatters goes ahead.
  out.through =
      faces_sun(normal, light) ? out.sun : std::sqrt(arriving_at(volume, place.world, key_light));
  return out;
}

}  // namespace

Vec3f normal_at(const surface::Field& field, std::uint32_t b, Vec3f q) {
  const auto share = [&](float x, float y, float z) {
    return share_at(field, b, q + Vec3f{x, y, z});
  };
  // The step is wide enough to leave out the bumps of single particles: grain is finer, broken
  // faces are rougher.
  constexpr float d = 1.4f;
  return normalized(Vec3f{share(-d, 0, 0) - share(d, 0, 0), share(0, -d, 0) - share(0, d, 0),
                          share(0, 0, -d) - share(0, 0, d)});
}

void NearField::take(const surface::Field& field, std::uint32_t block) {
  constexpr int block_side = surface::block_side, margin = cpu::near_margin;
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

Vec3f NearField::even_fall(Vec3i node) const {
  constexpr int margin = cpu::near_margin, side = cpu::near_side;
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

Exposure expose(const LightVolume& volume, const SnowLight& light, const SnowPlace& place,
                Vec3f normal, const NearLight& near) {
  Exposure out = expose_to_far(volume, light, place, normal);
  out.sun *= std::exp(-1.5f * near.before_sun);
  if (!faces_sun(normal, light)) out.through *= std::exp(-0.5f * near.within);
  out.crevice = near.open_sky;
  return out;
}

Exposure expose(const Body& body, const LightVolume& volume, const SnowLight& light,
                const SnowPlace& place, Vec3f normal) {
  if (place.block == no_block) return expose_to_far(volume, light, place, normal);
  using One = Lanes<float, 1>;
  const auto share = [&](const cpu::Points3<One>& node) {
    return One{share_at(body.field, place.block, {node.x[0], node.y[0], node.z[0]})};
  };
  const auto node = cpu::all_points<One>(place.node), outward = cpu::all_points<One>(normal);
  return expose(volume, light, place, normal,
                {cpu::snow_before_sun(share, node, outward, light.toward)[0],
                 faces_sun(normal, light) ? 0 : cpu::snow_within(share, node, light.toward)[0],
                 cpu::open_sky(share, node, outward)[0]});
}

}  // namespace neve::render::snow

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

Vec3f mix(Vec3f a, Vec3f b, float t) {
  return a + (b - a) * t;
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
float near_sun(const Body& body, const SnowPlace& place, Vec3f normal, Vec3f toward) {
  const Vec3f start = place.node + normal * 0.8f;
  float thickness = 0;
  for (int n = 0; n < 4; ++n) {
    const Vec3f at = start + toward * (0.7f + 1.15f * static_cast<float>(n));
    const float share = share_at(body.field, place.block, within_reach(at));
    thickness += std::max(0.0f, share - 0.12f);
  }
  return std::exp(-1.5f * thickness);
}

/// Part of the sky that near snow leaves.
float near_sky(const Body& body, const SnowPlace& place, Vec3f normal) {
  const auto share = [&](float away) {
    return share_at(body.field, place.block, within_reach(place.node + normal * away));
  };
  return 1 / (1 + 2.2f * share(2.0f) + 1.4f * share(4.0f));
}

/// Henyey and Greenstein, 1 on average.
float forward_phase(float cosine, float g) {
  const float apart = 1 + g * g - 2 * g * cosine;
  return (1 - g * g) / (apart * std::sqrt(apart));
}

/// Sky light of a place from which only a part of the sky is open: what hides the rest is snow too,
/// and returns light, over and over.
/// @param open  part of the sky @param kept  part of the light that a bounce leaves
float filled(float open, float kept) {
  return open / (1 - kept * (1 - open));
}

/// Bounces between snow and snow: red is lost first, so that deep places are blue. Less than the
/// albedo, since not all that hides the sky is white.
constexpr Vec3f returned{0.70f, 0.78f, 0.86f};
constexpr float ambient_share = 0.82f;
/// Snow scatters ahead: shade behind thin snow is lighter than what it absorbs and throws back.
constexpr float scattered_ahead = 0.85f;

/// Crystals that mirror the sun: one in a hundred of tiny cells of a grain.
float glint(const GrainLook& grain, Vec3f toward_eye, Vec3f toward_light) {
  constexpr float cells = 6, least = 0.98f;
  const auto cell = [&](float x) {
    return static_cast<std::uint64_t>(floor_to_int(x * cells) + 64);
  };
  const std::uint64_t random = mix64(std::uint64_t{grain.seed} << 24 ^ cell(grain.offset.x) << 16 ^
                                     cell(grain.offset.y) << 8 ^ cell(grain.offset.z));
  const auto along = [&](int bits) {
    return static_cast<float>(random >> bits & 0xffff) * (2.0f / 65535) - 1;
  };
  const Vec3f facet = normalized(Vec3f{along(0), along(16), along(32)});
  const float mirrored = dot(facet, normalized(toward_eye + toward_light));
  return std::max(0.0f, mirrored - least) / (1 - least);
}

/// The two grains that are nearest to a place: squared distance (m2) as bits, which are in the
/// order of the numbers, then the grain. Comparing both at once costs no branches.
class Nearest {
 public:
  void take(std::uint32_t grain, float squared) {
    const std::uint64_t key = std::uint64_t{std::bit_cast<std::uint32_t>(squared)} << 32 | grain;
    second_ = std::min(second_, std::max(first_, key));
    first_ = std::min(first_, key);
  }
  std::uint32_t first() const { return grain_of(first_); }
  std::uint32_t second() const { return grain_of(second_); }
  float first_squared() const { return squared_of(first_); }
  float second_squared() const { return squared_of(second_); }

 private:
  static std::uint32_t grain_of(std::uint64_t key) { return static_cast<std::uint32_t>(key); }
  static float squared_of(std::uint64_t key) {
    return std::bit_cast<float>(static_cast<std::uint32_t>(key >> 32));
  }
  static constexpr std::uint64_t none =
      std::uint64_t{std::bit_cast<std::uint32_t>(1e30f)} << 32 | no_block;
  std::uint64_t first_ = none, second_ = none;
};

/// Distance over which one grain goes over into the next, in spacings.
constexpr float blend = 0.35f;

/// Along one axis: the cube of a place, the next one on the nearer side, and the way there.
struct NearCubes {
  int own, next;
  float away;  ///< nodes
};

NearCubes near_cubes(float node) {
  const int own = floor_to_int(0.5f * node);
  const float inside = node - 2.0f * static_cast<float>(own);
  return inside < 1 ? NearCubes{own, own - 1, inside} : NearCubes{own, own + 1, 2 - inside};
}

Nearest nearest_grains(const Body& body, const SnowPlace& place) {
  const GrainList& grains = body.grains;
  const NearCubes x = near_cubes(place.node.x), y = near_cubes(place.node.y),
                  z = near_cubes(place.node.z);
  const float cell = body.field.cell;
  Nearest nearest;
  for (int n = 0; n < 8; ++n) {
    const auto squared_away = [&](int bit, const NearCubes& c) {
      return n & bit ? c.away * c.away : 0.0f;
    };
    // Grains of this cube would be too far away to be seen here.
    const float least =
        (squared_away(1, x) + squared_away(2, y) + squared_away(4, z)) * cell * cell;
    const float first = nearest.first_squared(), room = blend * body.spacing;
    if (least > nearest.second_squared() || least > 2 * (first + room * room)) continue;
    const int i = n & 1 ? x.next : x.own, j = n & 2 ? y.next : y.own, k = n & 4 ? z.next : z.own;
    const int side = ((k + 4) >> 2) * 9 + ((j + 4) >> 2) * 3 + ((i + 4) >> 2);
    const std::uint32_t block = body.field.near[place.block][static_cast<std::size_t>(side)];
    if (block == no_block) continue;
    const std::uint32_t cube =
        block * cubes_per_block + static_cast<std::uint32_t>((k & 3) << 4 | (j & 3) << 2 | (i & 3));
    for (std::uint32_t p = grains.first[cube]; p < grains.first[cube + 1]; ++p) {
      const Vec3f away = place.world - grains.position[p];
      nearest.take(p, dot(away, away));
    }
  }
  return nearest;
}

GrainLook look_of(const Body& body, const SnowPlace& place, std::uint32_t p) {
  const GrainList& grains = body.grains;
  const float pixels = body.spacing / place.sample_size;
  const int detail = pixels > 7 ? 0 : pixels > 3.5f ? 1 : 2;
  constexpr float units_per_spacing = 1.4f;
  GrainLook out;
  const std::uint32_t color = grains.color[p];
  const auto channel = [&](int shift) {
    const float root = static_cast<float>(color >> shift & 0xff) * (1.0f / 255);
    return root * root;
  };
  out.albedo = {channel(0), channel(8), channel(16)};
  out.seed = grains.seed[p];
  out.offset = (place.world - grains.position[p]) * (1 / body.spacing);
  const auto shift = [&](int bits) {
    return static_cast<float>(out.seed >> bits & 0xff) * (4.0f / 256);
  };
  const Turn turn(grains.turn.empty() ? no_turn : grains.turn[p]);
  out.offset = turn.back(out.offset);
  const Relief relief = grain_noise().at(
      out.offset * units_per_spacing + Vec3f{shift(0), shift(8), shift(16)}, detail);
  out.height = relief.height;
  out.slope = turn.forth(relief.slope) * units_per_spacing;
  return out;
}

}  // namespace

GrainLook grain_look(const Body& body, const SnowPlace& place) {
  const Nearest nearest = nearest_grains(body, place);
  if (nearest.first() == no_block) return {};
  GrainLook look = look_of(body, place, nearest.first());
  if (nearest.second() == no_block) return look;
  // Where two grains are equally near, half of each.
  const float between =
      (std::sqrt(nearest.second_squared()) - std::sqrt(nearest.first_squared())) / body.spacing;
  const float other = 0.5f * (1 - smooth_step(0, blend, between));
  if (other <= 0) return look;
  const GrainLook next = look_of(body, place, nearest.second());
  look.albedo = mix(look.albedo, next.albedo, other);
  look.slope = mix(look.slope, next.slope, other);
  look.height += (next.height - look.height) * other;
  return look;
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

Exposure expose(const Body& body, const LightVolume& volume, const SnowLight& light,
                const SnowPlace& place, Vec3f normal) {
  const float cell = volume.grid.cell;
  const Vec3f above = place.world + normal * (1.2f * cell);
  Exposure out;
  out.normal = normal;
  out.sun = arriving_at(volume, above + light.toward * cell).key;
  out.sky = arriving_at(volume, above).sky;
  out.through = arriving_at(volume, place.world).key;
  if (place.block == no_block) return out;
  out.sun *= near_sun(body, place, normal, light.toward);
  out.crevice = near_sky(body, place, normal);
  return out;
}

SnowLightParts snow_light(const Body& body, const SnowLight& light, const SnowPlace& place,
                          const Exposure& exposure, const GrainLook& grain) {
  const float pixels = body.spacing / place.sample_size;
  const float strength = 0.55f * smooth_step(0.6f, 3.0f, pixels);
  const Vec3f even = exposure.normal;
  const Vec3f along = grain.slope - even * dot(grain.slope, even);
  const Vec3f n = normalized(even - along * (0.35f * strength));
  const float facing = dot(n, light.toward), even_facing = dot(even, light.toward);
  const float contrast = light.is_value ? light::value_contrast : 1.0f;
  // Light enters snow and leaves it somewhere near: the terminator is soft, and its rim is blue.
  const auto wrapped = [&](float wrap) {
    const float rough = std::max(0.0f, (facing + wrap) / (1 + wrap));
    const float smooth = std::max(0.0f, (even_facing + wrap) / (1 + wrap));
    return 1 + contrast * (0.65f * rough + 0.35f * smooth - 1);
  };
  const float glow = even_facing < 0.25f
                         ? exposure.through * smooth_step(0.25f, -0.6f, even_facing) *
                               forward_phase(-dot(place.toward_eye, light.toward), 0.55f)
                         : 0.0f;
  const float spark = light.is_value || facing <= 0
                          ? 0.0f
                          : 1.2f * smooth_step(2, 6, pixels) * facing *
                                glint(grain, place.toward_eye, light.toward);
  const float log_sun = std::log(std::max(exposure.sun, 1e-6f)) * contrast;
  const float up = 0.5f + 0.5f * n.y;
  const float crevice = exposure.crevice * (1 + 0.25f * strength * std::min(grain.height, 0.0f));
  const float open = exposure.sky * crevice;
  const float inside = light.ambient * (0.9f * exposure.sky * (1 - exposure.sun) + 0.2f);
  SnowLightParts parts;
  const auto fill = [&](float Vec3f::*c, float wrap) {
    const float sun = 1.06f * light.key * (light::sun_color.*c) * (grain.albedo.*c);
    const float facing_sun = wrapped(wrap);
    const float arriving = std::exp(scattered_ahead * log_sun * (light::absorption.*c));
    parts.sun.*c = sun * (facing_sun * arriving + 0.22f * glow + spark * exposure.sun);
    parts.open_sun.*c = sun * (facing_sun + 0.22f * glow + spark);
    const float around = ambient_share * light.ambient *
                         (light::ambient_least +
                          light::ambient_gain * (1 + contrast * (filled(open, returned.*c) - 1)));
    const float ambient = around * ((light::bounce_color.*c) +
                                    ((light::sky_color.*c) - (light::bounce_color.*c)) * up);
    parts.around.*c = grain.albedo.*c * (ambient + inside * (light::scatter_color.*c));
  };
  fill(&Vec3f::x, 0.18f);
  fill(&Vec3f::y, 0.24f);
  fill(&Vec3f::z, 0.32f);
  return parts;
}

}  // namespace neve::render::snow

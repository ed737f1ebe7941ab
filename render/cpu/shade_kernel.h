#pragma once
/// Lights a tile of the G-buffer in lanes: shaders/shade.frag, step by step. Values that are
/// equal along a row are computed once, and samples without a surface cost only the
/// background.

#include "render/cpu/lane_math.h"
#include "render/cpu/light_lanes.h"
#include "render/cpu/surface_job.h"
#include "render/light/shading_constants.h"

namespace neve::render::cpu {
namespace {

/// Some samples side by side in a row.
template <class V>
struct RowPart {
  int at;     ///< index of the first in the tile
  float y;    ///< of the picture, middle of the samples
  V x;        ///< likewise
  V share_x;  ///< of the picture's width
  float share_y;
  Points3<V> ray;  ///< length 1 along the view
};

template <class V>
NEVE_INLINE V tone_map(V c) {
  c = c * light::exposure;
  c = c * (1 + c * (1 / light::white_point)) / (1 + light::shoulder * c);
  return rough_power(unit_lanes(c), all<V>(1 / light::display_gamma));
}

/// Inverse of tone_map: the value that becomes the linear light y.
template <class V>
NEVE_INLINE V before_tone_map(V y) {
  const V b = 1 - light::shoulder * y;
  return (square_root_lanes(b * b + y * (4 / light::white_point)) - b) *
         (0.5f * light::white_point / light::exposure);
}

/// shaders/noise.glsl
template <class V>
NEVE_INLINE V noise_lanes(V x, float y) {
  using U = Lanes<unsigned, lane_count<V>>;
  const U column = reinterpret_cast<U>(__builtin_convertvector(x, MaskOf<V>));
  U h = column * light::noise_column ^
        (static_cast<unsigned>(static_cast<int>(y)) * light::noise_row);
  h = (h ^ (h >> 15)) * light::noise_mix_1;
  h = (h ^ (h >> 12)) * light::noise_mix_2;
  h = (h ^ (h >> 15)) >> 8;
  return __builtin_convertvector(reinterpret_cast<MaskOf<V>>(h), V) * (1.0f / 16777216);
}

template <class V>
NEVE_INLINE Points3<V> root_squared(MaskOf<V> albedo) {
  const V r = byte_share<V>(albedo, 0), g = byte_share<V>(albedo, 1), b = byte_share<V>(albedo, 2);
  return {r * r, g * g, b * b};
}

/// Light that leaves a matte surface. Contrast below 1 lifts the shadows.
template <class V>
NEVE_INLINE Points3<V> lit(const ShadeJob& job, const Points3<V>& albedo, const Points3<V>& n,
                           V key, V open_sky, V contrast) {
  const float wrap = light::facing_wrap;
  const V raw = larger_lanes((along(n, job.toward_light) + wrap) * (1 / (1 + wrap)), V{});
  const V facing =
      mix_lanes(all<V>(1), raw, contrast) * (light::facing_min + light::facing_gain * raw);
  const V log_key = rough_log2(larger_lanes(key, all<V>(1e-30f))) * contrast;
  const V direct = facing * job.key_intensity;
  const V open = mix_lanes(all<V>(1), open_sky, contrast);
  const V up = 0.5f + 0.5f * n.y;
  const V around = (light::ambient_min + light::ambient_gain * open) *
                   (light::ambient_share * job.ambient_intensity);
  const V inside =
      (light::inside_gain * open * (1 - key) + light::inside_min) * job.ambient_intensity;
  const auto channel = [&](float Vec3f::*c) NEVE_INLINE_BODY {
    return direct * rough_exp2(log_key * (light::absorption.*c)) * (light::sun_color.*c) +
           around * mix_lanes(all<V>(light::bounce_color.*c), all<V>(light::sky_color.*c), up) +
           inside * (light::scatter_color.*c);
  };
  return albedo * Points3<V>{channel(&Vec3f::x), channel(&Vec3f::y), channel(&Vec3f::z)};
}

/// @param is_there lanes with a surface that light falls on
template <class V>
NEVE_INLINE Points3<V> surface_light(const ShadeJob& job, const RowPart<V>& part,
                                     MaskOf<V> is_there, MaskOf<V> kind, const Points3<V>& albedo) {
  using I = MaskOf<V>;
  const light::GBufferTile& tile = *job.tile;
  const light::LightCells& cells = job.light;
  const V z = 1 / (is_there ? load_lanes<V>(tile.inverse + part.at) : all<V>(1));
  const Points3<V> p = part.ray * z;
  Points3<V> n = {load_lanes<V>(tile.normal_x + part.at), load_lanes<V>(tile.normal_y + part.at),
                  load_lanes<V>(tile.normal_z + part.at)};
  const I is_holdout = kind == light::kind_holdout;
  const I is_solid = (kind == light::kind_solid) | is_holdout;
  const I is_hard = is_solid | (kind == light::kind_ground);
  const I is_soft = is_there & ~is_hard;
  Points3<V> out =
      n * (cells.cell * (is_solid ? all<V>(light::solid_offset) : all<V>(light::ground_offset)));
  if (any_lane(is_soft)) {
    // A stray particle has no body.
    const Points3<V> body = body_lanes(cells, p, is_soft & is_in_box(cells, p));
    const V certainty = smaller_lanes(square_root_lanes(square_of(body)), all<V>(1));
    const V weight = light::body_share * certainty;
    const Points3<V> mixed =
        n * (1 - weight) + body * (weight / larger_lanes(certainty, all<V>(1e-3f)));
    const V size = larger_lanes(square_of(mixed), all<V>(1e-30f));
    n = choose(is_soft, mixed * (1 / square_root_lanes(size)), n);
    out = choose(is_soft, body * all<V>(light::snow_offset * cells.cell), out);
  }
  const Points3<V> above = p + out;
  const V toward = is_soft ? all<V>(cells.cell) : V{};
  const V key = key_lanes(cells, job.toward_light, above + job.toward_light * toward, is_there);
  const V open = sky_lanes(cells, above, is_there);
  const I is_plain = is_hard | (kind == light::kind_snow);
  Points3<V> color =
      lit(job, albedo, n, key, open, is_plain ? all<V>(1) : all<V>(light::value_contrast));
  if (any_lane(is_solid)) {
    const V back = 1 / square_root_lanes(square_of(p));
    const V facing = (n.x * p.x + n.y * p.y + n.z * p.z) * back;
    const V rim = 1 - absolute_lanes(facing), rim2 = rim * rim;
    color = color + light::sky_color * (is_solid ? light::rim_light * rim2 * rim2 : V{});
  }
  if (any_lane(is_holdout)) {
    // The share of the light that shadows leave.
    const V one = all<V>(1), least = all<V>(1e-6f);
    const Points3<V> white{one, one, one};
    ShadeJob whole = job;
    whole.key_intensity = job.holdout_key_intensity;
    whole.ambient_intensity = job.holdout_ambient_intensity;
    const Points3<V> left = lit(whole, white, n, key, open, one),
                     full = lit(whole, white, n, one, one, one);
    const auto share = [&](V a, V b) NEVE_INLINE_BODY {
      return smaller_lanes(a / larger_lanes(b, least), one);
    };
    color = choose(is_holdout,
                   {share(left.x, full.x), share(left.y, full.y), share(left.z, full.z)}, color);
  }
  return color;
}

/// Light of samples that are lit already, from its parts.
template <class V>
NEVE_INLINE Points3<V> lit_in_parts(const ShadeJob& job, int at) {
  const auto channel = [&](int c) NEVE_INLINE_BODY {
    return load_lanes<V>(job.lit->sun[c] + at) * job.lit_sun +
           load_lanes<V>(job.lit->open_sun[c] + at) * job.lit_open_sun +
           load_lanes<V>(job.lit->around[c] + at) * job.lit_around;
  };
  return {channel(0), channel(1), channel(2)};
}

/// Colour and cover of the surface behind the smoke.
template <class V>
struct Covered {
  Points3<V> color;
  V cover;
};

template <class V>
NEVE_INLINE Covered<V> behind_smoke(const ShadeJob& job, const RowPart<V>& part) {
  using I = MaskOf<V>;
  const float cover = job.is_transparent ? 0.0f : 1.0f;
  const auto background = [&](float Vec3f::*c) NEVE_INLINE_BODY {
    return all<V>(cover * (light::background_bottom.*c * (1 - part.share_y) +
                           light::background_top.*c * part.share_y));
  };
  Covered<V> out{{background(&Vec3f::x), background(&Vec3f::y), background(&Vec3f::z)},
                 all<V>(cover)};
  const float dy = part.share_y - 0.5f;
  const V dx = part.share_x - 0.5f;
  V vignette = job.is_transparent ? all<V>(1) : 1 - light::vignette_strength * (dx * dx + dy * dy);
  I kind;
  __builtin_memcpy(&kind, job.tile->kind + part.at, sizeof kind);
  const I is_there = kind != light::kind_nothing;
  if (any_lane(is_there)) {
    I word;
    __builtin_memcpy(&word, job.tile->albedo + part.at, sizeof word);
    const Points3<V> albedo = root_squared<V>(word);
    const V alpha = is_there ? byte_share<V>(word >> 24 & 0xff, 0) : V{};
    const I is_flat = kind == light::kind_flat, is_done = is_flat | (kind == light::kind_lit);
    const I is_unlit = is_there & ~is_done;
    Points3<V> color{};
    if (any_lane(is_unlit)) color = surface_light(job, part, is_unlit, kind, albedo);
    if (any_lane(is_done)) {
      color = choose(
          is_done,
          {before_tone_map(albedo.x), before_tone_map(albedo.y), before_tone_map(albedo.z)}, color);
      vignette = is_flat ? all<V>(1) : vignette;
    }
    if (job.lit) color = choose(kind == light::kind_lit, lit_in_parts<V>(job, part.at), color);
    color = choose(is_there, color, Points3<V>{});
    const I is_holdout = kind == light::kind_holdout;
    const Points3<V> over = out.color * (1 - alpha) + color * alpha;
    if (any_lane(is_holdout)) {
      const auto shaded = [&](V behind, V share)
                              NEVE_INLINE_BODY { return behind * (1 - alpha * (1 - share)); };
      out.color = choose(is_holdout,
                         {shaded(out.color.x, color.x), shaded(out.color.y, color.y),
                          shaded(out.color.z, color.z)},
                         over);
      out.cover = mix_lanes(out.cover, all<V>(1), is_holdout ? alpha * (1 - color.y) : alpha);
    } else {
      out.color = over;
      out.cover = mix_lanes(out.cover, all<V>(1), alpha);
    }
  }
  out.color = out.color * vignette;
  return out;
}

// ---- smoke --------------------------------------------------------------------------------------

template <class V>
struct SmokeSums {
  V r, g, b, a;
};

/// Smoke before a surface: of the four rays around the sample, those that ended at its depth or in
/// smoke before it, so that nothing leaks over the edge of solids in the smoke.
template <class V>
NEVE_INLINE SmokeSums<V> smoke_before(const light::SmokeCover& smoke, const RowPart<V>& part,
                                      V inverse) {
  using I = MaskOf<V>;
  const V z = clamp_lanes(1 / larger_lanes(inverse, all<V>(1e-30f)), smoke.nearest, smoke.farthest);
  const float per_ray = 1 / smoke.samples_per_ray;
  const V at_x = part.x * per_ray - 0.5f;
  const float at_y = part.y * per_ray - 0.5f;
  const I left = floor_lanes(at_x);
  const int below = floor_to_int(at_y);
  const V part_x = at_x - __builtin_convertvector(left, V);
  const float part_y = at_y - static_cast<float>(below);
  MaskOf<V> ray[4];
  V a[4], most{};
  for (int n = 0; n < 4; ++n) {
    const int row = smaller(larger(below + (n >> 1), 0), smoke.height - 1);
    I column = left + (n & 1);
    column = column < 0 ? I{} : column;
    column = column > smoke.width - 1 ? all<I>(smoke.width - 1) : column;
    ray[n] = column + row * smoke.width;
    a[n] = gather_lanes<V>(smoke.sums[3], ray[n]);
    most = larger_lanes(most, a[n]);
  }
  SmokeSums<V> sum{};
  if (!any_lane(most > V{})) return sum;
  V total{};
  for (int n = 0; n < 4; ++n) {
    V apart = (gather_lanes<V>(smoke.depth, ray[n]) - z) * (1 / smoke.spacing);
    // Samples that smoke already hides may be anywhere behind it.
    apart = a[n] > all<V>(light::smoke_hides) ? larger_lanes(apart, V{}) : apart;
    apart = light::smoke_falloff * apart * apart;
    const V near = ((n & 1) ? part_x : 1 - part_x) * ((n >> 1) ? part_y : 1 - part_y);
    const V weight = near / (1 + apart * apart);
    sum.r += weight * gather_lanes<V>(smoke.sums[0], ray[n]);
    sum.g += weight * gather_lanes<V>(smoke.sums[1], ray[n]);
    sum.b += weight * gather_lanes<V>(smoke.sums[2], ray[n]);
    sum.a += weight * a[n];
    total += weight;
  }
  const V scale = 1 / total;
  return {sum.r * scale, sum.g * scale, sum.b * scale, sum.a * scale};
}

/// Linear light of smoke, from the scattered light of each kind.
template <class V>
NEVE_INLINE Points3<V> smoke_light(const ShadeJob& job, const RowPart<V>& part,
                                   const SmokeSums<V>& sums) {
  if (job.smoke->is_colored) return {sums.r, sums.g, sums.b};
  // Henyey and Greenstein, 1 on average: dust is brighter towards the light.
  const float g = light::smoke_forward;
  const V cosine = along(part.ray, job.toward_light) / square_root_lanes(square_of(part.ray));
  const V apart = 1 + g * g - 2 * g * cosine;
  const V ahead = (1 - g * g) / (apart * square_root_lanes(apart)) - 1;
  const V direct =
      light::smoke_direct * (1 + light::smoke_direct_phase * ahead) * sums.r * job.key_intensity;
  const V inside =
      light::smoke_inside * (1 + light::smoke_inside_phase * ahead) * sums.b * job.key_intensity;
  const V sky = light::smoke_sky * sums.g * job.ambient_intensity;
  const V ground = light::smoke_bounce * sums.a * job.ambient_intensity;
  const float of_sky = light::smoke_inside_sky;
  const auto channel = [&](float Vec3f::*c) NEVE_INLINE_BODY {
    return direct * (light::sun_color.*c) +
           inside * ((1 - of_sky) * (light::sun_color.*c) + of_sky * (light::sky_color.*c)) +
           sky * (light::sky_color.*c) + ground * (light::bounce_color.*c);
  };
  return {channel(&Vec3f::x), channel(&Vec3f::y), channel(&Vec3f::z)};
}

template <class V>
NEVE_INLINE void lay_smoke_over(const ShadeJob& job, const RowPart<V>& part, Covered<V>& out) {
  const V inverse = load_lanes<V>(job.tile->inverse + part.at);
  const SmokeSums<V> smoke = smoke_before(*job.smoke, part, inverse);
  if (!any_lane(smoke.a > V{})) return;
  const float dy = part.share_y - 0.5f;
  const V dx = part.share_x - 0.5f;
  const V vignette =
      job.is_transparent ? all<V>(1) : 1 - light::vignette_strength * (dx * dx + dy * dy);
  out.color = out.color * (1 - smoke.a) + smoke_light(job, part, smoke) * vignette;
  out.cover = out.cover * (1 - smoke.a) + smoke.a;
}

// ---- the tile -----------------------------------------------------------------------------------

template <class V>
NEVE_INLINE MaskOf<V> finished(const ShadeJob& job, const RowPart<V>& part, const Covered<V>& c) {
  const V grain = (noise_lanes(part.x - 0.5f, part.y - 0.5f) - 0.5f) * (1.0f / 255);
  const auto join = [](V r, V g, V b, MaskOf<V> a) NEVE_INLINE_BODY {
    return to_byte(r) | to_byte(g) << 8 | to_byte(b) << 16 | a << 24;
  };
  if (!job.is_transparent)
    return join(tone_map(c.color.x) + grain, tone_map(c.color.y) + grain,
                tone_map(c.color.z) + grain, all<MaskOf<V>>(255));
  const V scale = 1 / larger_lanes(c.cover, all<V>(1e-4f));
  const auto premultiplied = [&](V light) NEVE_INLINE_BODY {
    return unit_lanes(tone_map(light * scale) + grain) * c.cover;
  };
  return join(premultiplied(c.color.x), premultiplied(c.color.y), premultiplied(c.color.z),
              to_byte(c.cover));
}

/// @param to of the samples, from the corner of the tile
template <class V>
NEVE_INLINE void store_linear(const ShadeJob& job, const Covered<V>& c, long to) {
  store_lanes(c.color.x, job.linear[0] + to);
  store_lanes(c.color.y, job.linear[1] + to);
  store_lanes(c.color.z, job.linear[2] + to);
  store_lanes(c.cover, job.cover + to);
}

template <class V>
NEVE_INLINE void shade_tile_lanes(const ShadeJob& job) {
  const light::LaneView& view = job.view;
  const float half_width = 0.5f * static_cast<float>(view.width),
              half_height = 0.5f * static_cast<float>(view.height);
  const float per_sample = 1 / view.pixels_per_slope;
  for (int y = 0; y < light::tile_height; ++y) {
    RowPart<V> part;
    part.y = static_cast<float>(job.y + y) + 0.5f;
    part.share_y = part.y / static_cast<float>(view.height);
    const Vec3f base = view.forward + ((part.y - half_height) * per_sample) * view.up;
    for (int x = 0; x < light::tile_width; x += lane_count<V>) {
      part.at = y * light::tile_width + x;
      part.x = sample_centers<V>() + static_cast<float>(job.x + x);
      part.share_x = part.x * (1 / static_cast<float>(view.width));
      part.ray = all_points<V>(base) + view.right * ((part.x - half_width) * per_sample);
      Covered<V> c = behind_smoke(job, part);
      if (job.smoke) lay_smoke_over(job, part, c);
      const long to = static_cast<long>(y) * job.pitch + x;
      if (job.cover) {
        store_linear(job, c, to);
        continue;
      }
      const MaskOf<V> words = finished(job, part, c);
      __builtin_memcpy(job.out + to, &words, sizeof words);
    }
  }
}

}  // namespace
}  // namespace neve::render::cpu

#pragma once
/// Light of snow towards the eye, in lanes of samples.

#include "render/cpu/lane_math.h"
#include "render/cpu/snow_light_job.h"
#include "render/light/shading_constants.h"

namespace neve::render::cpu {
namespace {

template <class V>
NEVE_INLINE V smooth_step_lanes(float low, float high, V x) {
  const V t = unit_lanes((x - low) / (high - low));
  return t * t * (3 - 2 * t);
}

/// Henyey and Greenstein, 1 on average.
template <class V>
NEVE_INLINE V forward_phase(V cosine, float g) {
  const V apart = 1 + g * g - 2 * g * cosine;
  return (1 - g * g) / (apart * square_root_lanes(apart));
}

/// Turns light into the finished bytes of the G-buffer: square roots of linear display light.
template <class V>
NEVE_INLINE MaskOf<V> finished_byte(V c) {
  c = c * light::exposure;
  c = c * (1 + c / light::white_point) / (1 + light::shoulder * c);
  return to_byte(square_root_lanes(unit_lanes(c)));
}

/// Sky light of a place from which only a part of the sky is open: what hides the rest is snow too,
/// and returns light, over and over.
/// @param open  part of the sky @param kept  part of the light that a bounce leaves
template <class V>
NEVE_INLINE V filled(V open, float kept) {
  return open / (1 - kept * (1 - open));
}

/// Bounces between snow and snow: red is lost first, so that deep places are blue. Less than the
/// albedo, since not all that hides the sky is white.
constexpr Vec3f returned{0.50f, 0.60f, 0.72f};
constexpr float sun_share = 1.2f, ambient_share = 0.66f;
/// Snow scatters ahead: shade behind thin snow is lighter than what it absorbs and throws back.
constexpr float scattered_ahead = 0.85f;

/// The sun that shines through thin snow has lost some of its red there.
constexpr Vec3f shine_color{0.90f, 1.00f, 1.16f};

/// Linear light towards the eye.
template <class V>
struct SnowLightParts {
  Points3<V> sun;       ///< of the key light, on the surface and through the snow
  Points3<V> open_sun;  ///< as if nothing were in its way to the surface
  Points3<V> around;    ///< of the sky, and from inside the snow
};

/// @param at    of the first sample @param even  unit, without relief
template <class V>
NEVE_INLINE SnowLightParts<V> snow_light_lanes(const SnowLightJob& job, int at,
                                               const Points3<V>& even) {
  const Points3<V> toward_eye = normalized_lanes(load_points<V>(job.ray, at) * all<V>(-1));
  const Points3<V> slope = load_points<V>(job.slope, at);
  const V sun = load_lanes<V>(job.sun + at), sky = load_lanes<V>(job.sky + at);
  const V pixels = job.spacing / load_lanes<V>(job.sample_size + at);
  const V strength = 0.55f * smooth_step_lanes(0.6f, 3.0f, pixels);
  const Points3<V> in_surface = slope + even * -inner(slope, even);
  const Points3<V> n = normalized_lanes(even + in_surface * (-0.31f * strength));
  const V facing = along(n, job.toward), even_facing = along(even, job.toward);
  const float contrast = job.is_value ? light::value_contrast : 1.0f;
  // Light enters snow and leaves it somewhere near: the terminator is soft, and its rim is blue.
  const auto wrapped = [&](float wrap) NEVE_INLINE_BODY {
    const V rough = larger_lanes(V{}, (facing + wrap) / (1 + wrap));
    const V smooth = larger_lanes(V{}, (even_facing + wrap) / (1 + wrap));
    return 1 + contrast * (0.65f * rough + 0.35f * smooth - 1);
  };
  // Thin snow against the sun: most light leaves it nearly straight on, the rest to all sides.
  const V ahead = 0.5f + 0.5f * forward_phase(-along(toward_eye, job.toward), 0.55f);
  const V glow =
      0.6f * ahead * load_lanes<V>(job.through + at) * smooth_step_lanes(0.3f, -0.5f, even_facing);
  // Crystals that mirror the sun.
  constexpr float least = 0.98f;
  const V mirrored = inner(load_points<V>(job.facet, at),
                           normalized_lanes(toward_eye + all_points<V>(job.toward)));
  const V glint = larger_lanes(V{}, mirrored - least) / (1 - least);
  const V spark = 1.2f * smooth_step_lanes(2, 6, pixels) * larger_lanes(V{}, facing) * glint;
  const V log_sun = rough_log2(larger_lanes(sun, all<V>(1e-6f))) * contrast;
  const V up = 0.5f + 0.5f * n.y;
  // A place deeper between grains sees less of the sky: without a sun, nothing else shows
  // grain.
  const V relief = 1 + 0.7f * strength * load_lanes<V>(job.height + at);
  const V open = sky * load_lanes<V>(job.crevice + at) * relief;
  const V inside = job.ambient * (0.4f * sky * (1 - sun) + 0.15f);
  const Points3<V> albedo = load_points<V>(job.albedo, at);
  SnowLightParts<V> parts;
  const auto fill = [&](auto part, float Vec3f::*c, float wrap) NEVE_INLINE_BODY {
    const V key = sun_share * job.key * (light::sun_color.*c) * albedo.*part;
    const V facing_sun = wrapped(wrap), shining = glow * (shine_color.*c);
    const V arriving = rough_exp2(log_sun * (scattered_ahead * (light::absorption.*c)));
    parts.sun.*part = key * (facing_sun * arriving + shining + spark * sun);
    parts.open_sun.*part = key * (facing_sun + shining + spark);
    const V around = ambient_share * job.ambient *
                     (light::ambient_min +
                      light::ambient_gain * (1 + contrast * (filled(open, returned.*c) - 1)));
    const V ambient = around * ((light::bounce_color.*c) +
                                ((light::sky_color.*c) - (light::bounce_color.*c)) * up);
    parts.around.*part = albedo.*part * (ambient + inside * (light::scatter_color.*c));
  };
  fill(&Points3<V>::x, &Vec3f::x, 0.08f);
  fill(&Points3<V>::y, &Vec3f::y, 0.13f);
  fill(&Points3<V>::z, &Vec3f::z, 0.20f);
  return parts;
}

template <class V>
NEVE_INLINE void light_snow(const SnowLightJob& job) {
  for (int at = 0; at < job.count; at += lane_count<V>) {
    const Points3<V> even = normalized_lanes(load_points<V>(job.normal, at));
    const SnowLightParts<V> parts = snow_light_lanes(job, at, even);
    const Points3<V> color = parts.sun + parts.around;
    const MaskOf<V> word = finished_byte(color.x) | finished_byte(color.y) << 8 |
                           finished_byte(color.z) << 16 | static_cast<int>(0xff000000u);
    __builtin_memcpy(job.word + at, &word, sizeof word);
    store_points(even, job.unit_normal, at);
    if (!job.wants_parts) continue;
    store_points(parts.sun, job.lit_sun, at);
    store_points(parts.open_sun, job.open_sun, at);
    store_points(parts.around, job.lit_around, at);
  }
}

}  // namespace
}  // namespace neve::render::cpu

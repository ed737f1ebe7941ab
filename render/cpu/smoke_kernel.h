#pragma once
/// Marches from the eye through smoke up to the surface in the G-buffer: shaders/smoke.frag. Rays
/// go one after another; lanes are the four channels of two texels side by side.

#include "render/cpu/lane_math.h"
#include "render/light/shading_constants.h"
#include "render/light/smoke_job.h"

namespace neve::render::cpu {
namespace {

using Channels = Lanes<float, 4>;

/// Two texels side by side: one register where there are eight lanes.
template <class V>
struct TexelPair {
  V both{};
  NEVE_INLINE void add(const float* texels, float weight) {
    both += load_lanes<V>(texels) * weight;
  }
  NEVE_INLINE Channels mixed(float part) const {
    return half_of<0>(both) * (1 - part) + half_of<1>(both) * part;
  }
};
template <>
struct TexelPair<Channels> {
  Channels low{}, high{};
  NEVE_INLINE void add(const float* texels, float weight) {
    low += load_lanes<Channels>(texels) * weight;
    high += load_lanes<Channels>(texels + 4) * weight;
  }
  NEVE_INLINE Channels mixed(float part) const { return low * (1 - part) + high * part; }
};

NEVE_INLINE float clamped(float x, float low, float high) {
  return smaller(x > low ? x : low, high);
}
NEVE_INLINE float fraction_of(float x) {
  return x - static_cast<float>(floor_to_int(x));
}
/// Returns 1 / x, and a large number instead of infinity at 0.
NEVE_INLINE float inverse_of(float x) {
  return 1 / (x == 0 ? 1e-7f : x);
}

NEVE_INLINE Channels color_at(const light::SmokeJob& job, float place) {
  const float x = clamped(place * light::colormap_width - 0.5f, 0, light::colormap_width - 1);
  const int i = smaller(static_cast<int>(x), light::colormap_width - 2);
  const float part = x - static_cast<float>(i);
  const float* at = job.colormap + 4 * i;
  return load_lanes<Channels>(at) * (1 - part) + load_lanes<Channels>(at + 4) * part;
}

/// End of the ray, m along the view, from the samples that it represents: in their middle, or at an
/// edge in turn before the nearest and the farthest, so that shading finds both sides.
NEVE_INLINE float surface_distance(const light::SmokeJob& job, int ray_x, int ray_y) {
  const int n = job.samples_per_ray;
  float most = 0, least = 1e30f;
  for (int y = ray_y * n; y < ray_y * n + n; ++y) {
    for (int x = ray_x * n; x < ray_x * n + n; ++x) {
      const int qx = smaller(x, job.view.width - 1), qy = smaller(y, job.view.height - 1);
      const light::GBufferTile& tile =
          job.tiles[qy / light::tile_height * job.tile_columns + qx / light::tile_width];
      const float inverse =
          tile.inverse[qy % light::tile_height * light::tile_width + qx % light::tile_width];
      most = larger(most, inverse);
      least = smaller(least, inverse);
    }
  }
  const float farthest = 1e-9f / job.view.near_distance;
  const float a = 1 / larger(most, farthest), b = 1 / larger(least, farthest);
  if (b - a < job.texel) return 0.5f * (a + b);
  return ((ray_x + ray_y) & 1) == 0 ? a : b;
}

/// Narrows z and z_end, distances along the view, to the part of a ray that is in the box.
NEVE_INLINE void clip_to_box(const light::SmokeJob& job, Vec3f ray, float& z, float& z_end) {
  for (int axis = 0; axis < 3; ++axis) {
    const float inverse = inverse_of(ray[axis]), origin = job.grid_origin[axis];
    const float size = job.texel * static_cast<float>(job.grid_size[axis] - 1);
    const float a = origin * inverse, b = (origin + size) * inverse;
    z = larger(z, smaller(a, b));
    z_end = smaller(z_end, larger(a, b));
  }
}

/// A ray on its way; u and derived values in texels.
struct March {
  Vec3f origin, ray;   ///< of texel 0, and per m along the view
  Vec3f per_texel;     ///< m along the view
  float z, dz, z_end;  ///< m along the view: where the first step begins, of a step, of the end
  float jitter;        ///< where in its step a sample lies
  float extinction;    ///< of opacity 1, per m along the view
  NEVE_INLINE float start_of(int step) const { return z + static_cast<float>(step) * dz; }
};

/// Number of steps until the ray leaves the brick of a step's sample; 0 if the brick is not empty.
NEVE_INLINE int empty_steps(const light::SmokeJob& job, const March& march, int step) {
  const float z = march.start_of(step);
  const float at = z + march.jitter * smaller(march.dz, march.z_end - z);
  int brick[3];
  float exit = 1e30f;
  for (int axis = 0; axis < 3; ++axis) {
    const float u = march.ray[axis] * at - march.origin[axis];
    const int b = floor_to_int(u * (1.0f / light::brick_side));
    const float low = light::brick_side * static_cast<float>(b) - u;
    exit = smaller(exit, larger(low * march.per_texel[axis],
                                (low + light::brick_side) * march.per_texel[axis]));
    brick[axis] = smaller(larger(b, 0), job.brick_count[axis] - 1);
  }
  const long index =
      (static_cast<long>(brick[2]) * job.brick_count.y + brick[1]) * job.brick_count.x + brick[0];
  if (job.bricks[index] != 0) return 0;
  return static_cast<int>(clamped(exit / march.dz, 0, light::max_march_steps)) + 1;
}

/// Some steps, as many for every instruction set.
constexpr int steps_at_once = 8;
struct Steps {
  int corner[steps_at_once];                ///< lowest of the eight texels around
  alignas(32) float x[steps_at_once];       ///< part of the way to the next
  alignas(32) float row[4][steps_at_once];  ///< weights of the four rows of two texels
  alignas(32) float length[steps_at_once];  ///< m along the view
  alignas(32) float opacity[steps_at_once], inverse[steps_at_once];
  alignas(32) float decay[steps_at_once];  ///< of the light on its way through
  Channels texel[steps_at_once];
};

/// Positions of the samples of the steps from `first` on.
template <class V>
NEVE_INLINE void place_steps(const light::SmokeJob& job, const March& march, int first,
                             Steps& steps) {
  using I = MaskOf<V>;
  for (int l = 0; l < steps_at_once; l += lane_count<V>) {
    const V number = sample_centers<V>() + (static_cast<float>(first + l) - 0.5f);
    const V z = march.z + number * march.dz;
    const V length = smaller_lanes(all<V>(march.dz), march.z_end - z);
    const V at = z + march.jitter * length;
    I low[3];
    V part[3];
    for (int axis = 0; axis < 3; ++axis) {
      const V u = larger_lanes(march.ray[axis] * at - march.origin[axis], V{});
      const I last = all<I>(job.grid_size[axis] - 2);
      low[axis] = __builtin_convertvector(smaller_lanes(u, all<V>(1e6f)), I);
      low[axis] = low[axis] > last ? last : low[axis];
      part[axis] = smaller_lanes(u - __builtin_convertvector(low[axis], V), all<V>(1));
    }
    const I corner = (low[2] * job.grid_size.y + low[1]) * job.grid_size.x + low[0];
    __builtin_memcpy(steps.corner + l, &corner, sizeof corner);
    store_lanes(part[0], steps.x + l);
    store_lanes((1 - part[1]) * (1 - part[2]), steps.row[0] + l);
    store_lanes(part[1] * (1 - part[2]), steps.row[1] + l);
    store_lanes((1 - part[1]) * part[2], steps.row[2] + l);
    store_lanes(part[1] * part[2], steps.row[3] + l);
    store_lanes(length, steps.length + l);
  }
}

/// Values of the texels around each step.
template <class V>
NEVE_INLINE void read_texels(const light::SmokeJob& job, int count, Steps& steps) {
  const long row = 4 * static_cast<long>(job.grid_size.x), slice = row * job.grid_size.y;
  for (int k = 0; k < count; ++k) {
    const float* at = job.texels + 4 * static_cast<long>(steps.corner[k]);
    TexelPair<V> pair;
    pair.add(at, steps.row[0][k]);
    pair.add(at + row, steps.row[1][k]);
    pair.add(at + slice, steps.row[2][k]);
    pair.add(at + slice + row, steps.row[3][k]);
    steps.texel[k] = pair.mixed(steps.x[k]);
    steps.opacity[k] = steps.texel[k][0];
  }
}

/// Share of light that passes each step.
template <class V>
NEVE_INLINE void find_decay(const March& march, Steps& steps) {
  for (int l = 0; l < steps_at_once; l += lane_count<V>) {
    const V opacity = load_lanes<V>(steps.opacity + l);
    const MaskOf<V> is_seen = opacity > V{};
    const V thickness = opacity * (march.extinction * load_lanes<V>(steps.length + l));
    store_lanes(is_seen ? rough_decay(thickness) : all<V>(1), steps.decay + l);
    store_lanes(is_seen ? 1 / opacity : V{}, steps.inverse + l);
  }
}

struct MarchResult {
  Channels sums{};
  float left = 1, z = 0;
};

template <class V>
NEVE_INLINE MarchResult march_through(const light::SmokeJob& job, const March& march) {
  MarchResult r;
  Steps steps{};
  // Far fewer than lanes can count in floats: dz is at least a max_march_steps-th of the way.
  const int last = static_cast<int>((march.z_end - march.z) / march.dz) + 1;
  int step = 0;
  while (step < last && r.left > light::march_opaque) {
    if (const int empty = empty_steps(job, march, step); empty > 0) {
      step += empty;
      continue;
    }
    int count = smaller(last - step, steps_at_once);
    while (count > 0 && !(march.start_of(step + count - 1) < march.z_end)) --count;
    if (count == 0) break;
    place_steps<V>(job, march, step, steps);
    read_texels<V>(job, count, steps);
    find_decay<V>(march, steps);
    for (int k = 0; k < count && r.left > light::march_opaque; ++k, ++step) {
      const float rest = r.left * steps.decay[k];
      const float share = (r.left - rest) * steps.inverse[k];
      r.left = rest;
      const Channels s = steps.texel[k];
      if (!job.colormap)
        r.sums += s * share;
      else if (share > 0)
        r.sums += color_at(job, s[3] * steps.inverse[k]) *
                  (share * (job.key_light * s[1] + job.sky_light * s[2]));
    }
  }
  r.z = smaller(march.start_of(step), march.z_end);
  return r;
}

template <class V>
NEVE_INLINE void march_ray(const light::SmokeJob& job, int x, int y) {
  const long at = static_cast<long>(y) * job.pitch + x;
  const float n = static_cast<float>(job.samples_per_ray),
              per_slope = 1 / job.view.pixels_per_slope;
  const float fx = static_cast<float>(x) + 0.5f, fy = static_cast<float>(y) + 0.5f;
  const Vec3f ray =
      job.view.forward +
      ((fx * n - 0.5f * static_cast<float>(job.view.width)) * per_slope) * job.view.right +
      ((fy * n - 0.5f * static_cast<float>(job.view.height)) * per_slope) * job.view.up;
  const float surface = surface_distance(job, x, y);
  float depth = clamped(surface, job.nearest, job.farthest);
  float z = larger(job.near, job.view.near_distance), z_end = smaller(job.far, surface);
  clip_to_box(job, ray, z, z_end);
  Channels sums{};
  if (z < z_end) {
    const float per_z = length(ray);  // m along the ray per m along the view
    const float per_texel = 1 / job.texel;
    March march;
    march.origin = job.grid_origin * per_texel;
    march.ray = ray * per_texel;
    march.per_texel = {inverse_of(march.ray.x), inverse_of(march.ray.y), inverse_of(march.ray.z)};
    march.z = z;
    march.dz = larger(light::march_step * job.texel / per_z, (z_end - z) / light::max_march_steps);
    march.z_end = z_end;
    march.jitter = fraction_of(light::even_noise_scale * fraction_of(fx * light::even_noise_column +
                                                                     fy * light::even_noise_row));
    march.extinction = job.extinction * per_z;
    const MarchResult result = march_through<V>(job, march);
    sums = result.sums;
    if (!job.colormap) sums = Channels{sums[1], sums[2], sums[3], 0};  // the first is the opacity
    float alpha = 1 - result.left;
    if (result.left <= light::march_opaque) {
      sums = sums * (1 / alpha);  // the rest of a march cut short
      alpha = 1;
      depth = smaller(depth, result.z);
    }
    sums[3] = alpha;
  }
  for (int c = 0; c < 4; ++c) job.sums[c][at] = sums[c];
  job.depth[at] = depth;
}

template <class V>
NEVE_INLINE void march_rays(const light::SmokeJob& job) {
  for (int y = job.y_low; y < job.y_high; ++y)
    for (int x = job.x_low; x < job.x_high; ++x) march_ray<V>(job, x, y);
}

}  // namespace
}  // namespace neve::render::cpu

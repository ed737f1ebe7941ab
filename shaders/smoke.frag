// Marches from the eye through smoke up to what the depth map shows. In: per texel of a box of
// nodes opacity, and times that the key light, the sky, and light that was scattered many times, or
// with VALUE the place in the colour map (render/smoke_volume.h). Out: linear light premultiplied by
// opacity, and the depth (m along the view) where the ray ended. Writes no depth.

#include "view.glsl"
#include "light.glsl"
#include "noise.glsl"

uniform sampler2D depth_map;
uniform sampler3D smoke_volume;
uniform sampler3D brick_map;   // 0 where 4x4x4 texels are empty
uniform sampler2D span_map;    // nearest and farthest smoke of a tile, m along the view
uniform sampler2D colormap;    // linear
uniform float tile;            // samples
uniform int samples_per_ray;
uniform vec3 grid_origin;      // of texel (0, 0, 0), relative to the eye, m
uniform vec3 grid_size;        // texels
uniform float texel;           // m
uniform float step_length;     // m
uniform float full_extinction; // 1/m, where the volume holds 1
uniform vec2 smoke_range;      // m along the view
uniform vec3 toward_light;     // unit
uniform float key_intensity, ambient_intensity;

layout(location = 0) out vec4 out_radiance;
layout(location = 1) out float out_depth;

const int max_steps = 1024;
const float opaque = 0.004;  // what is left of the light where a march ends

float distance_of(float depth) { return near_distance / max(1.0 - depth, 1e-9); }

// Where the ray ends, m along the view, given the samples that it stands for: in their middle, or at
// an edge in turn before the nearest and the farthest, so that the shading pass finds both sides.
float surface_distance(ivec2 at) {
  float nearest = 1.0, farthest = 0.0;
  ivec2 last = textureSize(depth_map, 0) - 1;
  for (int n = 0; n < samples_per_ray * samples_per_ray; ++n) {
    ivec2 q = min(at * samples_per_ray + ivec2(n % samples_per_ray, n / samples_per_ray), last);
    float depth = texelFetch(depth_map, q, 0).r;
    nearest = min(nearest, depth);
    farthest = max(farthest, depth);
  }
  float a = distance_of(nearest), b = distance_of(farthest);
  if (b - a < texel) return 0.5 * (a + b);
  return ((at.x + at.y) & 1) == 0 ? a : b;
}

// Where the ray is in the box, along the view; near > far where it misses.
vec2 box_span(vec3 ray) {
  vec3 inverse = 1.0 / (ray + vec3(equal(ray, vec3(0.0))) * 1e-7);
  vec3 a = grid_origin * inverse, b = (grid_origin + texel * (grid_size - 1.0)) * inverse;
  vec3 low = min(a, b), high = max(a, b);
  return vec2(max(max(low.x, low.y), low.z), min(min(high.x, high.y), high.z));
}

// Henyey and Greenstein, 1 on average: dust is brighter towards the light.
float phase(float cosine) {
  const float g = 0.5;
  return (1.0 - g * g) / pow(1.0 + g * g - 2.0 * g * cosine, 1.5);
}

void main() {
  ivec2 at = ivec2(gl_FragCoord.xy);
  vec2 pixel = gl_FragCoord.xy * float(samples_per_ray);
  float z_surface = surface_distance(at);
  out_depth = clamp(z_surface, smoke_range.x, smoke_range.y);
  out_radiance = vec4(0.0);

  vec3 ray = view_ray(pixel);
  vec2 span = texelFetch(span_map, ivec2(pixel / tile), 0).rg;
  vec2 box = box_span(ray);
  float z = max(max(span.x, box.x), near_distance);
  float z_end = min(min(span.y, box.y), z_surface);
  if (!(z < z_end)) return;

  float per_z = length(ray);  // m along the ray per m along the view
  float dz = max(step_length / per_z, (z_end - z) / float(max_steps));
  float jitter = even_noise(gl_FragCoord.xy);
  vec3 per_texel = 1.0 / (ray / texel + vec3(equal(ray, vec3(0.0))) * 1e-7);
  float toward = phase(dot(ray, toward_light) / per_z);
  float left = 1.0;
  vec4 sums = vec4(0.0);
  vec3 color = vec3(0.0);
  for (int i = 0; i < max_steps && z < z_end && left > opaque; ++i) {
    float part = min(dz, z_end - z);
    vec3 u = (ray * (z + jitter * part) - grid_origin) / texel;
    vec3 brick = floor(u * 0.25);
    if (texelFetch(brick_map, ivec3(brick), 0).r == 0.0) {
      // On to the first step that begins beyond the brick.
      vec3 exits = max((4.0 * brick - u) * per_texel, (4.0 * brick + 4.0 - u) * per_texel);
      float steps = floor(min(min(exits.x, exits.y), exits.z) / dz) + 1.0;
      z += max(steps, 1.0) * dz;
      continue;
    }
    z += part;
    vec4 s = texture(smoke_volume, (u + 0.5) / grid_size);
    if (s.r <= 0.0) continue;
    float taken = left * (1.0 - exp(-full_extinction * per_z * part * s.r));
    left -= taken;
    s *= taken / s.r;
    sums += s;
#ifdef VALUE
    vec3 own = texture(colormap, vec2(taken > 0.0 ? s.a / taken : 0.5, 0.5)).rgb;
    color += own * (s.g * sun * key_intensity + s.b * sky * ambient_intensity);
#endif
  }
  float opacity = 1.0 - left;
  if (opacity <= 0.0) return;
#ifndef VALUE
  // Light that has gone through snow is bluer: red is absorbed first.
  vec3 direct = sun * (1.9 * mix(1.0, toward, 0.35) * sums.g);
  vec3 inside = mix(sun, sky, 0.75) * (0.34 * mix(1.0, toward, 0.2) * sums.a);
  vec3 ambient = sky * (0.52 * sums.b) + scatter * (0.15 * sums.r);
  color = (direct + inside) * key_intensity + ambient * ambient_intensity;
#endif
  float rest = left > opaque ? 1.0 : 1.0 / opacity;  // what a march cut short left out
  out_radiance = vec4(color * rest, opacity * rest);
}

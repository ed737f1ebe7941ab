// Marches from the eye through smoke up to the surface in the depth map. In: per texel of a box of nodes opacity, and times that the key light, the sky,
// and light that was scattered many times, or with VALUE the place in the colour map
// (render/light/smoke_volume.h). Out: sums along the ray, premultiplied, and the depth (m along the view)
// where it ended. Writes no depth.

#include "view.glsl"
#include "constants.glsl"
#include "noise.glsl"

uniform sampler2D depth_map;
uniform sampler3D smoke_volume;
uniform sampler3D brick_map;   // 0 where brick_side^3 texels are empty
uniform sampler2D span_map;    // nearest and farthest smoke of a tile, m along the view
uniform sampler2D colormap;    // linear
uniform float tile;            // samples
uniform int samples_per_ray;
uniform vec3 grid_origin;      // of texel (0, 0, 0), relative to the eye, m
uniform vec3 grid_size;        // texels
uniform float texel;           // m
uniform float step_length;     // m
uniform float extinction;      // 1/m, of opacity 1
uniform vec2 smoke_range;      // m along the view
uniform float key_light, sky_light;  // on colours

// Key light, sky, light from inside, opacity; with VALUE linear light and opacity.
layout(location = 0) out vec4 out_sums;
layout(location = 1) out float out_depth;

float distance_of(float depth) { return near_distance / max(1.0 - depth, 1e-9); }

// End of the ray, m along the view, from the samples that it represents: in their middle, or at an
// edge in turn before the nearest and the farthest, so that the shading pass finds both sides.
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

// Part of the ray in the box, along the view; near > far if it misses.
vec2 box_span(vec3 ray) {
  vec3 inverse = 1.0 / (ray + vec3(equal(ray, vec3(0.0))) * 1e-7);
  vec3 a = grid_origin * inverse, b = (grid_origin + texel * (grid_size - 1.0)) * inverse;
  vec3 low = min(a, b), high = max(a, b);
  return vec2(max(max(low.x, low.y), low.z), min(min(high.x, high.y), high.z));
}

void main() {
  ivec2 at = ivec2(gl_FragCoord.xy);
  vec2 pixel = gl_FragCoord.xy * float(samples_per_ray);
  float z_surface = surface_distance(at);
  out_depth = clamp(z_surface, smoke_range.x, smoke_range.y);
  out_sums = vec4(0.0);

  vec3 ray = view_ray(pixel);
  vec2 span = texelFetch(span_map, ivec2(pixel / tile), 0).rg;
  vec2 box = box_span(ray);
  float z = max(max(span.x, box.x), near_distance);
  float z_end = min(min(span.y, box.y), z_surface);
  if (!(z < z_end)) return;

  float per_z = length(ray);  // m along the ray per m along the view
  float dz = max(step_length / per_z, (z_end - z) / float(max_march_steps));
  float jitter = even_noise(gl_FragCoord.xy);
  vec3 per_texel = 1.0 / (ray / texel + vec3(equal(ray, vec3(0.0))) * 1e-7);
  float left = 1.0;
  vec4 sums = vec4(0.0);
  for (int i = 0; i < max_march_steps && z < z_end && left > march_opaque; ++i) {
    float part = min(dz, z_end - z);
    vec3 u = (ray * (z + jitter * part) - grid_origin) / texel;
    const float side = float(brick_side);
    vec3 brick = floor(u / side);
    if (texelFetch(brick_map, ivec3(brick), 0).r == 0.0) {
      // On to the first step that begins beyond the brick.
      vec3 from_corner = side * brick - u;
      vec3 exits = max(from_corner * per_texel, (from_corner + side) * per_texel);
      float steps = floor(min(min(exits.x, exits.y), exits.z) / dz) + 1.0;
      z += max(steps, 1.0) * dz;
      continue;
    }
    z += part;
    vec4 s = texture(smoke_volume, (u + 0.5) / grid_size);
    if (s.r <= 0.0) continue;
    float taken = left * (1.0 - exp(-extinction * per_z * part * s.r));
    left -= taken;
    s *= taken / s.r;
#ifdef VALUE
    // s.r is the opacity: the value that the place was multiplied by.
    vec3 own = taken > 0.0 ? texture(colormap, vec2(s.a / taken, 0.5)).rgb : vec3(0.0);
    sums.rgb += own * (key_light * s.g + sky_light * s.b);
#else
    sums.rgb += s.gba;
#endif
  }
  sums.a = 1.0 - left;
  if (left <= march_opaque) {
    sums /= sums.a;  // the rest of a march cut short
    out_depth = min(out_depth, z);
  }
  out_sums = sums;
}

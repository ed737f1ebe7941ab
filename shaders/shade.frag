// Lights everything. In: the G-buffer (gbuffer.glsl) and its depth, the light volumes as 3D textures
// over a box relative to the eye (m). Out: sRGB, tone mapped and dithered. Writes no depth.

#include "view.glsl"

uniform sampler2D depth_map;
uniform sampler2D normal_kind_map;
uniform sampler2D albedo_map;
uniform sampler3D body_volume;   // outward normal times certainty, density
uniform sampler3D light_volume;  // key light, sky

uniform vec3 box_origin, box_size;
uniform float cell;
uniform vec3 toward_light;  // unit
uniform float key_intensity, ambient_intensity;

out vec4 out_color;

const float kind_ground = 1.0;
const float kind_solid = 2.0;
const float kind_snow = 3.0;

const vec3 sun = vec3(1.30, 1.22, 1.08);
const vec3 sky = vec3(0.42, 0.56, 0.80);
const vec3 bounce = vec3(0.23, 0.29, 0.38);
const vec3 scatter = vec3(0.10, 0.16, 0.24);
const vec3 background_top = vec3(0.060, 0.072, 0.098);
const vec3 background_bottom = vec3(0.190, 0.215, 0.260);

bool is_in_box(vec3 p) {
  return all(greaterThan(p, box_origin)) && all(lessThan(p, box_origin + box_size));
}

vec3 texture_position(vec3 p) { return (p - box_origin) / box_size; }

// Key light at p. Outside the box the ray towards the light is followed to where it enters.
float key_light(vec3 p) {
  if (!is_in_box(p)) {
    vec3 inverse = 1.0 / (toward_light + vec3(equal(toward_light, vec3(0.0))) * 1e-7);
    vec3 a = (box_origin - p) * inverse, b = (box_origin + box_size - p) * inverse;
    vec3 low = min(a, b), high = max(a, b);
    float enter = max(max(low.x, low.y), low.z), leave = min(min(high.x, high.y), high.z);
    if (enter < 0.0 || enter > leave) return 1.0;
    p += toward_light * (enter + 0.5 * cell);
  }
  return texture(light_volume, texture_position(p)).r;
}

// Sky at p, fading to all of it over the outermost cells of the box.
float sky_light(vec3 p) {
  vec3 inside = min(p - box_origin, box_origin + box_size - p) / cell;
  float weight = clamp(min(min(inside.x, inside.y), inside.z) / 3.5, 0.0, 1.0);
  return mix(1.0, texture(light_volume, texture_position(p)).g, weight);
}

// Light that leaves a matte surface. Contrast below 1 lifts the shadows, so that colours that stand
// for values stay readable.
vec3 lit(vec3 albedo, vec3 n, float key, float open_sky, float contrast) {
  const float wrap = 0.3;
  float facing = max(0.0, (dot(n, toward_light) + wrap) / (1.0 + wrap));
  facing = mix(1.0, facing, contrast) * (0.65 + 0.35 * facing);
  // Light that has gone through snow is bluer: red is absorbed first.
  vec3 shade = pow(vec3(key), vec3(0.90, 0.78, 0.66) * contrast);
  float open = mix(1.0, open_sky, contrast);
  vec3 ambient = mix(bounce, sky, 0.5 + 0.5 * n.y) * (0.08 + 0.92 * open) * 0.75;
  vec3 inside = scatter * (0.6 * open * (1.0 - key) + 0.15);
  return albedo * (sun * facing * shade * key_intensity + (ambient + inside) * ambient_intensity);
}

vec3 tone_map(vec3 c) {
  c *= 0.8;
  c = c * (1.0 + c / 4.84) / (1.0 + 0.55 * c);
  return pow(min(c, vec3(1.0)), vec3(1.0 / 2.2));
}

// Same for the same sample of every picture: breaks up the bands of dark gradients.
float noise(uvec2 at) {
  uint h = at.x * 0x9E3779B1u ^ at.y * 0x85EBCA77u;
  h = (h ^ (h >> 15)) * 0x2C1B3C6Du;
  h = (h ^ (h >> 12)) * 0x297A2D39u;
  return float((h ^ (h >> 15)) >> 8) / 16777216.0;
}

vec3 surface(vec3 p, vec4 normal_kind, vec3 albedo) {
  vec3 n = normal_kind.xyz;
  float kind = normal_kind.w;
  if (kind == kind_ground || kind == kind_solid) {
    vec3 above = p + n * cell * (kind == kind_solid ? 2.5 : 0.5);
    vec3 color = lit(albedo, n, key_light(above), sky_light(above), 1.0);
    if (kind == kind_solid) {
      float rim = 1.0 - abs(dot(n, normalize(p)));
      color += 0.35 * rim * rim * rim * rim * sky;
    }
    return color;
  }
  // Snow: the body decides the shape, the sphere gives the grain. A stray particle has no body.
  vec3 body = is_in_box(p) ? texture(body_volume, texture_position(p)).xyz : vec3(0.0);
  float certainty = min(length(body), 1.0);
  n = normalize(mix(n, body / max(certainty, 1e-3), 0.72 * certainty));
  vec3 above = p + body * (1.2 * cell);
  float key = key_light(above + toward_light * cell);
  return lit(albedo, n, key, sky_light(above), kind == kind_snow ? 1.0 : 0.6);
}

void main() {
  ivec2 at = ivec2(gl_FragCoord.xy);
  vec2 across = gl_FragCoord.xy / view_size;
  vec3 color = mix(background_bottom, background_top, across.y);
  vec4 normal_kind = texelFetch(normal_kind_map, at, 0);
  if (normal_kind.w > 0.0) {
    vec4 albedo = texelFetch(albedo_map, at, 0);
    vec3 p = position_at(gl_FragCoord.xy, texelFetch(depth_map, at, 0).r);
    color = mix(color, surface(p, normal_kind, albedo.rgb * albedo.rgb), albedo.a);
  }
  color *= 1.0 - 0.35 * dot(across - 0.5, across - 0.5);
  out_color = vec4(tone_map(color) + (noise(uvec2(at)) - 0.5) / 255.0, 1.0);
}

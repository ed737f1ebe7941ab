// Lights everything. In: the G-buffer (gbuffer.glsl) and its depth, the light volumes as 3D textures
// over a box relative to the eye (m); with SMOKE also smoke, laid over the rest in linear light. Out: sRGB, tone mapped and
// dithered, premultiplied by alpha. Writes no depth.

#include "view.glsl"
#include "constants.glsl"
#include "noise.glsl"

uniform sampler2D depth_map;
uniform sampler2D normal_kind_map;
uniform sampler2D albedo_map;
uniform sampler3D body_volume;   // outward normal times certainty, density
uniform sampler3D light_volume;  // key light, sky

uniform vec3 box_origin, box_size;
uniform float cell;
uniform vec3 toward_light;  // unit
uniform float key_intensity, ambient_intensity;
uniform int is_transparent;

out vec4 out_color;

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
    p += toward_light * (enter + entry_offset * cell);
  }
  return texture(light_volume, texture_position(p)).r;
}

// Sky at p, fading to all of it over the outermost cells of the box.
float sky_light(vec3 p) {
  vec3 inside = min(p - box_origin, box_origin + box_size - p) / cell;
  float weight = clamp(min(min(inside.x, inside.y), inside.z) / sky_fade_cells, 0.0, 1.0);
  return mix(1.0, texture(light_volume, texture_position(p)).g, weight);
}

// Light that leaves a matte surface. Contrast below 1 lifts the shadows, so that colours that show
// values stay readable.
vec3 lit(vec3 albedo, vec3 n, float key, float open_sky, float contrast) {
  float facing = max(0.0, (dot(n, toward_light) + facing_wrap) / (1.0 + facing_wrap));
  facing = mix(1.0, facing, contrast) * (facing_min + facing_gain * facing);
  vec3 shade = pow(vec3(key), absorption * contrast);
  float open = mix(1.0, open_sky, contrast);
  vec3 ambient = mix(bounce_color, sky_color, 0.5 + 0.5 * n.y) *
                 (ambient_min + ambient_gain * open) * ambient_share;
  vec3 inside = scatter_color * (inside_gain * open * (1.0 - key) + inside_min);
  return albedo * (sun_color * facing * shade * key_intensity + (ambient + inside) * ambient_intensity);
}

vec3 tone_map(vec3 c) {
  c *= exposure;
  c = c * (1.0 + c / white_point) / (1.0 + shoulder * c);
  return pow(min(c, vec3(1.0)), vec3(1.0 / display_gamma));
}

// Inverse of tone_map: the value that becomes the linear light y.
vec3 before_tone_map(vec3 y) {
  vec3 b = 1.0 - shoulder * y;
  return 0.5 * white_point * (sqrt(b * b + y * (4.0 / white_point)) - b) / exposure;
}

// Software rasterisers run both sides of a branch: so all kinds share the samples of the volumes.
vec3 surface(vec3 p, vec4 normal_kind, vec3 albedo) {
  vec3 n = normal_kind.xyz;
  float kind = normal_kind.w;
  if (kind == kind_flat || kind == kind_lit) return before_tone_map(albedo);
  bool is_holdout = kind == kind_holdout;
  bool is_hard = kind == kind_ground || kind == kind_solid || is_holdout;
  // A stray particle has no body.
  vec3 body = is_in_box(p) ? texture(body_volume, texture_position(p)).xyz : vec3(0.0);
  float certainty = min(length(body), 1.0);
  if (!is_hard) n = normalize(mix(n, body / max(certainty, 1e-3), body_share * certainty));
  vec3 above =
      p + (is_hard ? n * cell * (kind == kind_ground ? ground_offset : solid_offset)
                   : body * (snow_offset * cell));
  float key = key_light(is_hard ? above : above + toward_light * cell);
  float contrast = is_hard || kind == kind_snow ? 1.0 : value_contrast;
  vec3 color = lit(albedo, n, key, sky_light(above), contrast);
  // The share of the light that shadows leave.
  if (is_holdout) return min(color / max(lit(albedo, n, 1.0, 1.0, contrast), 1e-6), 1.0);
  if (kind == kind_solid) {
    float rim = 1.0 - abs(dot(n, normalize(p)));
    color += rim_light * rim * rim * rim * rim * sky_color;
  }
  return color;
}

#ifdef SMOKE
uniform sampler2D smoke_map;        // key light, sky, inside, opacity; or colour and opacity
uniform sampler2D smoke_depth_map;  // m along the view, within smoke_range
uniform float samples_per_ray;
uniform vec2 smoke_range;
uniform float smoke_spacing;
uniform bool is_smoke_colored;

// Smoke before a surface: of the four rays around the sample, those that ended at its depth or in
// smoke before it, so that nothing leaks over the edges of objects in it.
vec4 smoke_before(float depth) {
  float z = clamp(near_distance / max(1.0 - depth, 1e-9), smoke_range.x, smoke_range.y);
  vec2 at = gl_FragCoord.xy / samples_per_ray - 0.5;
  ivec2 corner = ivec2(floor(at)), last = textureSize(smoke_map, 0) - 1;
  vec2 part = at - vec2(corner);
  vec4 sum = vec4(0.0);
  float total = 0.0;
  for (int n = 0; n < 4; ++n) {
    ivec2 q = ivec2(n & 1, n >> 1);
    vec2 near = mix(1.0 - part, part, vec2(q));
    q = clamp(corner + q, ivec2(0), last);
    vec4 smoke = texelFetch(smoke_map, q, 0);
    float apart = (texelFetch(smoke_depth_map, q, 0).r - z) / smoke_spacing;
    // Samples that smoke already hides may be anywhere behind it.
    if (smoke.a > smoke_hides) apart = max(apart, 0.0);
    apart = smoke_falloff * apart * apart;
    float weight = near.x * near.y / (1.0 + apart * apart);
    sum += weight * smoke;
    total += weight;
  }
  return sum / total;
}

// Henyey and Greenstein, 1 on average: dust is brighter towards the light.
float phase(float cosine) {
  const float g = smoke_forward;
  return (1.0 - g * g) / pow(1.0 + g * g - 2.0 * g * cosine, 1.5);
}

// Linear light of smoke, given the scattered light of each kind.
vec3 smoke_light(vec4 sums) {
  if (is_smoke_colored) return sums.rgb;
  float ahead = phase(dot(normalize(view_ray(gl_FragCoord.xy)), toward_light)) - 1.0;
  vec3 direct = sun_color * (smoke_direct * (1.0 + smoke_direct_phase * ahead) * sums.r);
  vec3 inside = mix(sun_color, sky_color, smoke_inside_sky) *
                (smoke_inside * (1.0 + smoke_inside_phase * ahead) * sums.b);
  vec3 ambient = sky_color * (smoke_sky * sums.g) + bounce_color * (smoke_bounce * sums.a);
  return (direct + inside) * key_intensity + ambient * ambient_intensity;
}
#endif

void main() {
  ivec2 at = ivec2(gl_FragCoord.xy);
  vec2 across = gl_FragCoord.xy / view_size;
  // Premultiplied by how much of the sample is covered: all of it where there is a background.
  float cover = is_transparent == 1 ? 0.0 : 1.0;
  vec3 color = cover * mix(background_bottom, background_top, across.y);
  vec4 normal_kind = texelFetch(normal_kind_map, at, 0);
  float depth = texelFetch(depth_map, at, 0).r;
  if (normal_kind.w > 0.0) {
    vec4 albedo = texelFetch(albedo_map, at, 0);
    vec3 p = position_at(gl_FragCoord.xy, depth);
    vec3 light = surface(p, normal_kind, albedo.rgb * albedo.rgb);
    if (normal_kind.w == kind_holdout) {
      color *= mix(vec3(1.0), light, albedo.a);
      cover = mix(cover, 1.0, albedo.a * (1.0 - light.g));
    } else {
      color = mix(color, light, albedo.a);
      cover = mix(cover, 1.0, albedo.a);
    }
  }
  // Darker corners; but a colour that shows a value is the one of the legend, and the background
  // behind a transparent picture would not have them.
  float corner = dot(across - 0.5, across - 0.5);
  float vignette = is_transparent == 1 ? 1.0 : 1.0 - vignette_strength * corner;
  if (normal_kind.w != kind_flat) color *= vignette;
#ifdef SMOKE
  vec4 smoke = smoke_before(depth);
  color = color * (1.0 - smoke.a) + smoke_light(smoke) * vignette;
  cover = cover * (1.0 - smoke.a) + smoke.a;
#endif
  float grain = (noise(uvec2(at)) - 0.5) / 255.0;
  if (is_transparent == 0) {
    out_color = vec4(tone_map(color) + grain, 1.0);
  } else {
    vec3 straight = clamp(tone_map(color / max(cover, 1e-4)) + grain, 0.0, 1.0);
    out_color = vec4(straight * cover, cover);
  }
}

// An infinite plane with grid lines, by intersecting the ray of the sample. In: the plane relative to
// the eye (m). Writes the G-buffer with the share that is left over the background; depth is that of
// the plane. With GHOST: sRGB, to be blended over the shaded picture by alpha.

#include "view.glsl"
#include "constants.glsl"
#ifdef GHOST
uniform float fill;  // opacity between the lines
out vec4 out_color;
#else
#include "gbuffer.glsl"
#endif

uniform vec3 plane_point, plane_normal;
uniform vec3 tangent, bitangent;  // along the grid lines
uniform vec2 eye_on_grid;         // where the eye is between lines, in units of their spacing
uniform float line_spacing;
uniform vec3 fade_center;
uniform float fade_distance;
uniform vec3 color;  // linear
uniform float line_width;  // samples
#ifndef GHOST
uniform float kind;
#endif

// Share of a sample that the lines of one direction cover, from the number of lines that it spans.
float line_cover(float at, float span) {
  float pixels = abs(fract(at - 0.5) - 0.5) / span;
  float cover = clamp(0.5 * line_width + 0.5 - pixels, 0.0, 1.0);
  return cover * (1.0 - smoothstep(line_veil_first, line_veil_last, span));
}

void main() {
  vec3 ray = view_ray(gl_FragCoord.xy);
  float z = dot(plane_point, plane_normal) / dot(ray, plane_normal);
  vec3 p = ray * z;
  vec2 on_grid = vec2(dot(p, tangent), dot(p, bitangent)) / line_spacing + eye_on_grid;
  vec2 span = max(fwidth(on_grid), 1e-6);
  if (!(z > near_distance)) discard;

  vec3 from_center = p - fade_center;
  float left = exp(-dot(from_center, from_center) / (fade_distance * fade_distance));
  if (left < ground_min) discard;

  float line = max(line_cover(on_grid.x, span.x), line_cover(on_grid.y, span.y));
#ifdef GHOST
  const float line_opacity = 0.55;
  out_color = vec4(vec3(0.62, 0.68, 0.76), left * mix(fill, line_opacity, line));
#else
  out_normal_kind = vec4(plane_normal, kind);
  out_albedo = vec4(sqrt(color * (1.0 + line_brightness * line)), left);
#endif
  gl_FragDepth = depth_of(z);
}

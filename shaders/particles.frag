// Intersects the ray of the sample with the sphere: exact in perspective. In: sphere relative to the
// eye (m). Writes the G-buffer; depth is that of the point that was hit.

#ifdef GL_ARB_conservative_depth
#extension GL_ARB_conservative_depth : enable
#endif

#include "view.glsl"
#include "gbuffer.glsl"

#ifdef GL_ARB_conservative_depth
// The vertex lies before the whole sphere, so a fragment behind what is drawn already need not run.
layout(depth_greater) out float gl_FragDepth;
#endif

flat in vec3 center;
flat in vec3 root_color;
flat in float sphere_radius;

uniform float kind;

void main() {
  vec3 ray = view_ray(gl_FragCoord.xy);  // not normalised: 1 along the view, so lengths are depths
  float per_length = 1.0 / dot(ray, ray);
  // From the centre to the nearest point of the ray: small numbers, where |center|^2 - r^2 would
  // lose the sphere in rounding.
  float along = dot(ray, center) * per_length;
  vec3 offset = ray * along - center;
  float inside = sphere_radius * sphere_radius - dot(offset, offset);
  if (inside < 0.0) discard;
  float half_chord = sqrt(inside * per_length);
  gl_FragDepth = depth_of(along - half_chord);
  out_normal_kind = vec4((offset - ray * half_chord) / sphere_radius, kind);
  out_albedo = vec4(root_color, 1.0);
}

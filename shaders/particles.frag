// Intersects the ray of the sample with the sphere: exact in perspective. In: sphere relative to the
// eye (m). Writes the G-buffer; depth is that of the point that was hit.

#include "view.glsl"
#include "gbuffer.glsl"

flat in vec3 center;
flat in vec3 color;
flat in float sphere_radius;

uniform float kind;

void main() {
  vec3 ray = normalize(view_ray(gl_FragCoord.xy));
  // From the centre to the nearest point of the ray: small numbers, where |center|^2 - r^2 would
  // lose the sphere in rounding.
  float along = dot(ray, center);
  vec3 offset = ray * along - center;
  float inside = sphere_radius * sphere_radius - dot(offset, offset);
  if (inside < 0.0) discard;
  float depth_in_sphere = sqrt(inside);
  vec3 hit = ray * (along - depth_in_sphere);
  gl_FragDepth = depth_of(dot(hit, view_forward));
  out_normal_kind = vec4((offset - ray * depth_in_sphere) / sphere_radius, kind);
  out_albedo = vec4(pow(color, vec3(1.1)), 1.0);  // sRGB to the square root of linear light
}

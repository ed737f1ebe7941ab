// In: position relative to the eye (m) and normal in world axes, turned towards the eye here so that
// open meshes show both sides. Writes the G-buffer; depth by the raster.

#include "constants.glsl"
#include "gbuffer.glsl"

in vec3 position;
in vec3 normal;

uniform vec3 color;  // linear
uniform float kind;

void main() {
  vec3 n = dot(normal, normal) > 0.0 ? normalize(normal)
                                     : normalize(cross(dFdx(position), dFdy(position)));
  if (dot(n, position) > 0.0) n = -n;
  out_normal_kind = vec4(n, kind);
  out_albedo = vec4(sqrt(color), 1.0);
}

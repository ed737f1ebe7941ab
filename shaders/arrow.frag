// In: as arrow.vert has it. Writes the G-buffer: a colour that shows a value is not shaded,
// a little darker where the surface turns away, so that arrows look round. Depth by the raster.

#include "constants.glsl"
#include "gbuffer.glsl"

in vec3 position;
in vec3 normal;
in vec3 root_color;

void main() {
  vec3 n = normalize(normal);
  float facing = abs(dot(n, normalize(position)));
  out_normal_kind = vec4(n, kind_flat);
  out_albedo = vec4(root_color * (0.72 + 0.28 * facing), 1.0);
}

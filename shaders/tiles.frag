// Puts samples that the processor has drawn into the G-buffer: those of finished light, which the
// shading pass leaves as they are. In: the textures of TilePass.

#include "view.glsl"
#include "constants.glsl"
#include "gbuffer.glsl"

uniform sampler2D normal_inverse_map;  // unit normal, and 1/m along the view; 0: nothing there
uniform sampler2D color_map;

void main() {
  ivec2 at = ivec2(gl_FragCoord.xy);
  vec4 normal_inverse = texelFetch(normal_inverse_map, at, 0);
  if (normal_inverse.w <= 0.0) discard;
  gl_FragDepth = 1.0 - near_distance * normal_inverse.w;
  out_normal_kind = vec4(normal_inverse.xyz, kind_lit);
  out_albedo = texelFetch(color_map, at, 0);
}

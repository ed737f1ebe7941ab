// A rectangle in space. In: nothing but the corner's number; its places are uniforms relative to the
// eye (m). Depth by the raster.

#include "view.glsl"

uniform vec3 corner, across, up;

out vec2 on_map;

void main() {
  on_map = vec2(gl_VertexID & 1, gl_VertexID >> 1);
  gl_Position = clip_position(corner + on_map.x * across + on_map.y * up);
}

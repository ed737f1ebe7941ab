// Solid triangles. In: position relative to the eye (m), normal in world axes. Depth by the raster.

#include "view.glsl"

layout(location = 0) in vec3 in_position;
layout(location = 1) in vec3 in_normal;

out vec3 position;
out vec3 normal;

void main() {
  position = in_position;
  normal = in_normal;
  gl_Position = clip_position(in_position);
}

// Arrows as triangles. In: position relative to the eye (m), normal in world axes, sRGB colour. Depth
// by the raster.

#include "view.glsl"

layout(location = 0) in vec3 in_position;
layout(location = 1) in vec3 in_normal;
layout(location = 2) in vec4 in_color;

out vec3 position;
out vec3 normal;
out vec3 root_color;

void main() {
  position = in_position;
  normal = in_normal;
  root_color = pow(in_color.rgb, vec3(1.1));  // sRGB to the square root of linear light
  gl_Position = clip_position(in_position);
}

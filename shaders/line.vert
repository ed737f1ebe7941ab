// A straight line as a square strip that faces the eye, one instance each. In: both ends relative to
// the eye (m). Depth by the raster, drawn a little nearer than it is so that it wins over the surface
// that it lies on.

#include "view.glsl"

layout(location = 0) in vec3 in_first;
layout(location = 1) in vec3 in_second;
layout(location = 2) in vec3 in_color;  // sRGB

uniform float width;  // samples

noperspective out float from_middle;  // samples
flat out vec3 color;

const float nearer = 0.998;

vec2 on_picture(vec3 p) {
  float z = dot(p, view_forward);
  return vec2(dot(p, view_right), dot(p, view_up)) * (pixels_per_slope / z);
}

void main() {
  color = in_color;
  vec3 first = in_first, second = in_second;
  float z_first = dot(first, view_forward), z_second = dot(second, view_forward);
  float least = 1.5 * near_distance;
  // The part behind the eye is cut off; a line that is all behind it has no size.
  if (z_first < least && z_second < least) {
    gl_Position = vec4(0.0, 0.0, 2.0, 1.0);
    from_middle = 0.0;
    return;
  }
  if (z_first < least) first = mix(first, second, (least - z_first) / (z_second - z_first));
  if (z_second < least) second = mix(second, first, (least - z_second) / (z_first - z_second));
  vec2 along = on_picture(second) - on_picture(first);
  float pixels = length(along);
  along = pixels > 1e-4 ? along / pixels : vec2(1.0, 0.0);
  float side = (gl_VertexID & 1) == 0 ? -1.0 : 1.0;
  bool is_second = gl_VertexID >= 2;
  from_middle = side * (0.5 * width + 1.0);
  vec4 position = clip_position(nearer * (is_second ? second : first));
  vec2 offset = vec2(-along.y, along.x) * from_middle + along * (is_second ? 0.5 : -0.5);
  position.xy += offset * 2.0 / view_size * position.w;
  gl_Position = position;
}

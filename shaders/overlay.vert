// Triangles of Dear ImGui. In: position in pixels from the upper left corner, texture position,
// sRGB colour. Writes no depth.

layout(location = 0) in vec2 in_position;
layout(location = 1) in vec2 in_texture;
layout(location = 2) in vec4 in_color;

uniform vec2 picture_size;

out vec2 texture_position;
out vec4 color;

void main() {
  texture_position = in_texture;
  color = in_color;
  vec2 clip = 2.0 * in_position / picture_size - 1.0;
  gl_Position = vec4(clip.x, -clip.y, 0.0, 1.0);
}

// In: as line.vert has it, and the depth of the G-buffer. Out: an sRGB colour to be blended. Writes no
// depth.

noperspective in float from_middle;
flat in vec3 color;  // sRGB

uniform sampler2D depth_map;
uniform float opacity;
uniform float width;  // samples

out vec4 out_color;

void main() {
  if (gl_FragCoord.z > texelFetch(depth_map, ivec2(gl_FragCoord.xy), 0).r) discard;
  float cover = clamp(0.5 * width + 0.5 - abs(from_middle), 0.0, 1.0) * min(width, 1.0);
  out_color = vec4(color, opacity * cover);
}

// Values on a rectangle through a colour map, with lines where they pass multiples of a step. In: the
// values times whether there is one, and whether there is one. Writes the G-buffer: colours that show
// values are not shaded. Depth by the raster.

#include "constants.glsl"
#include "gbuffer.glsl"

in vec2 on_map;

uniform sampler2D values;
uniform sampler2D colors;  // sRGB, 256 wide
uniform float range_min, range_max;
uniform float isoline_step;   // 0: none
uniform float isoline_width;  // samples
uniform vec3 normal;

void main() {
  vec2 at = texture(values, on_map).rg;
  float value = at.r / max(at.g, 1e-6);
  // One value all over has the colour in the middle, where the legend has its number.
  float width = range_max - range_min;
  float t = width > 0.0 ? clamp((value - range_min) / width, 0.0, 1.0) : 0.5;
  vec3 root_color = pow(texture(colors, vec2((t * 255.0 + 0.5) / 256.0, 0.5)).rgb, vec3(1.1));
  if (isoline_step > 0.0) {
    float steps = (value - range_min) / isoline_step;
    float span = max(fwidth(steps), 1e-6);
    float pixels = abs(fract(steps - 0.5) - 0.5) / span;
    float cover = clamp(0.5 * isoline_width + 0.5 - pixels, 0.0, 1.0);
    cover *= 1.0 - smoothstep(0.15, 0.4, span);  // closer than that they are a veil
    // Where a field is constant it has no lines, but it may be the value of one all over.
    cover *= smoothstep(1e-5, 5e-5, span);
    // Beyond the range colours do not change, and no line has its value on the legend.
    float last = (range_max - range_min) / isoline_step;
    cover *= step(-0.5, steps) * step(steps, last + 0.5);
    float luminance = dot(root_color * root_color, vec3(0.21, 0.72, 0.07));
    root_color = mix(root_color, vec3(luminance > 0.2 ? 0.0 : 1.0), 0.55 * cover);
  }
  if (at.g < 0.5) discard;  // after the derivatives, which want all of their neighbours
  out_normal_kind = vec4(normal, kind_flat);
  out_albedo = vec4(root_color, 1.0);
}

// A see-through surface, laid over the shaded picture: faint where it is seen face on, bright at the
// rim. In: position relative to the eye (m) and normal in world axes, outward. Out: sRGB, to be
// blended by alpha. Depth by the raster, tested and not written.

in vec3 position;
in vec3 normal;

uniform vec3 color;         // linear
uniform vec3 toward_light;  // unit
uniform int is_far_side;    // draws only the side away from the eye, otherwise only the other

out vec4 out_color;

void main() {
  vec3 toward_eye = -normalize(position);
  bool has_normal = dot(normal, normal) > 0.0;
  vec3 n = has_normal ? normalize(normal) : normalize(cross(dFdx(position), dFdy(position)));
  float facing = dot(n, toward_eye);
  if (has_normal && (facing < 0.0) != (is_far_side == 1)) discard;
  if (!has_normal && is_far_side == 1) discard;
  float rim = pow(1.0 - abs(facing), 3.0);
  float light = 0.62 + 0.38 * max(dot(n, toward_light), 0.0);
  vec3 tint = pow(min(color * 1.9, vec3(1.0)), vec3(1.0 / 2.2)) * vec3(0.92, 0.99, 1.08) * light;
  float alpha = is_far_side == 1 ? 0.05 + 0.25 * rim : 0.13 + 0.60 * rim;
  out_color = vec4(mix(tint, vec3(0.86, 0.92, 0.98), 0.7 * rim), alpha);
}

// The camera, shared by every pass. Positions are in metres relative to the eye, with the axes of the
// world. Depth is 1 - near_distance / z, z being the distance along view_forward: nothing is too far
// to be drawn, and 1 is infinitely far.

uniform vec3 view_right, view_up, view_forward;
uniform vec2 view_size;
uniform float pixels_per_slope;
uniform float near_distance;

// Through a pixel (gl_FragCoord.xy), with length 1 along view_forward.
vec3 view_ray(vec2 pixel) {
  vec2 slope = (pixel - 0.5 * view_size) / pixels_per_slope;
  return view_forward + slope.x * view_right + slope.y * view_up;
}

float depth_of(float z) { return 1.0 - near_distance / z; }

vec3 position_at(vec2 pixel, float depth) {
  return view_ray(pixel) * (near_distance / (1.0 - depth));
}

vec4 clip_position(vec3 p) {
  float z = dot(p, view_forward);
  vec2 xy = vec2(dot(p, view_right), dot(p, view_up)) * (2.0 * pixels_per_slope) / view_size;
  return vec4(xy, z - 2.0 * near_distance, z);
}

// Spheres as points, or with QUADS as squares that face the eye: for those larger than a point may
// be, or whose centre lies outside the picture. In: centre relative to the eye (m), albedo in sRGB.
// Out: the same with the radius, for the fragment shader to intersect. Depth is written there.

#include "view.glsl"

// Before the surface of the sphere, by a little more than rounding.
float front_depth(float z, float radius) {
  return depth_of(max(z - 1.0001 * radius, near_distance));
}

layout(location = 0) in vec3 in_center;
layout(location = 1) in vec4 in_color;

uniform float radius;
uniform float min_radius_pixels;

flat out vec3 center;
flat out vec3 root_color;
flat out float sphere_radius;

void main() {
  float z = dot(in_center, view_forward);
  center = in_center;
  root_color = pow(in_color.rgb, vec3(1.1));  // sRGB to the square root of linear light
  // Never so small that a sphere falls between samples and flickers.
  sphere_radius = max(radius, min_radius_pixels * z / pixels_per_slope);
#ifdef QUADS
  // The square touches the cone of rays that graze the sphere, in the plane of its centre.
  float distance_squared = dot(in_center, in_center);
  float half_side = sphere_radius * sqrt(distance_squared /
                    max(distance_squared - sphere_radius * sphere_radius, 1e-4 * distance_squared));
  vec3 toward = in_center / sqrt(distance_squared);
  vec3 side = normalize(cross(toward, view_up));
  vec3 top = cross(side, toward);
  vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 2.0 - 1.0;
  gl_Position = clip_position(in_center + half_side * (corner.x * side + corner.y * top));
#else
  gl_Position = clip_position(in_center);
  vec2 slope = vec2(dot(in_center, view_right), dot(in_center, view_up)) / z;
  // A sphere off the axis is drawn as an ellipse, longest away from the centre of the picture.
  float stretch = sqrt(1.0 + dot(slope, slope)) * (1.0 + 2.0 * sphere_radius / z);
  gl_PointSize = 2.0 * sphere_radius / z * pixels_per_slope * stretch + 1.0;
#endif
  gl_Position.z = (2.0 * front_depth(z, sphere_radius) - 1.0) * gl_Position.w;
}

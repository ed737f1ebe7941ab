#include <algorithm>
#include <cmath>

#include "render/passes.h"

namespace neve::render {
namespace {

/// Along the grid lines: the x axis of the world laid into the plane, where it is not the normal.
Vec3f tangent_of(Vec3f normal) {
  const Vec3f axis = std::abs(normal.x) < 0.9f ? Vec3f{1, 0, 0} : Vec3f{0, 0, 1};
  return normalized(axis - dot(axis, normal) * normal);
}

/// Where the eye is between two lines, in units of their spacing. In double and on the CPU, so that
/// lines stand still far from the origin.
float between_lines(Vec3f eye, Vec3f direction, float spacing) {
  const double lines =
      (double{eye.x} * direction.x + double{eye.y} * direction.y + double{eye.z} * direction.z) /
      double{spacing};
  return static_cast<float>(lines - std::floor(lines));
}

}  // namespace

GroundPass::GroundPass(const Gl& gl, const ShaderLibrary& library)
    : gl_(gl),
      program_(gl, library, "fullscreen.vert", "ground.frag"),
      ghost_program_(gl, library, "fullscreen.vert", "ground.frag", "#define GHOST\n"),
      vertex_array_(gl) {}

void GroundPass::draw(const Frame& frame, const View& view) {
  if (frame.grounds.empty()) return;
  set_solid_state(gl_);
  set_scale(program_, frame, view);
  for (const GroundPlane& ground : frame.grounds) {
    if (dot(ground.point - view.eye, ground.normal) < 0) draw_plane(program_, ground, frame, view);
  }
}

void GroundPass::draw_ghosts(const Frame& frame, const View& view) {
  if (frame.ghost_grounds.empty()) return;
  set_blended_state(gl_);
  set_scale(ghost_program_, frame, view);
  for (const GroundPlane& ground : frame.ghost_grounds) {
    ghost_program_.set("fill", ground.fill);
    draw_plane(ghost_program_, ground, frame, view);
  }
}

void GroundPass::set_scale(const Program& program, const Frame& frame, const View& view) const {
  program.use();
  set_view(program, view);
  const float target_distance = length(frame.camera.target - view.eye);
  program.set("fade_distance", 0.62f * std::max(target_distance, 1e-6f));
  // 1.3 pixels at 720p, in proportion above.
  const float scale = std::max(1.0f, static_cast<float>(frame.height) / 720);
  program.set("line_width", 1.3f * scale * static_cast<float>(frame.supersampling));
}

void GroundPass::draw_plane(const Program& program, const GroundPlane& ground, const Frame& frame,
                            const View& view) const {
  const Vec3f normal = normalized(ground.normal);
  const Vec3f point = ground.point - view.eye;
  const Vec3f target = frame.camera.target - view.eye;
  const Vec3f tangent = tangent_of(normal), bitangent = cross(tangent, normal);
  const float spacing = ground.line_spacing > 0 ? ground.line_spacing : 1e9f;
  program.set("plane_point", point);
  program.set("plane_normal", normal);
  program.set("tangent", tangent);
  program.set("bitangent", bitangent);
  program.set("eye_on_grid", between_lines(view.eye, tangent, spacing),
              between_lines(view.eye, bitangent, spacing));
  program.set("line_spacing", spacing);
  program.set("fade_center", target - dot(target - point, normal) * normal);
  program.set("color", ground.color);
  gl_.BindVertexArray(vertex_array_.id());
  gl_.DrawArrays(GL_TRIANGLES, 0, 3);
}

}  // namespace neve::render

#include "render/frame/ground_place.h"
#include "render/light/shading_constants.h"
#include "render/passes/passes.h"
#include "render/passes/view_uniforms.h"

namespace neve::render::passes {

GroundPass::GroundPass(const gl::Gl& gl, const gl::ShaderLibrary& library)
    : gl_(gl),
      program_(gl, library, "fullscreen.vert", "ground.frag"),
      ghost_program_(gl, library, "fullscreen.vert", "ground.frag", "#define GHOST\n"),
      vertex_array_(gl) {}

void GroundPass::draw(const Frame& frame, const View& view) {
  if (frame.grounds.empty()) return;
  gl::set_solid_state(gl_);
  program_.use();
  set_view(program_, view);
  for (const GroundPlane& ground : frame.grounds) {
    if (!is_seen_from_above(ground, view)) continue;
    program_.set("kind",
                 static_cast<float>(ground.is_holdout ? light::kind_holdout : light::kind_ground));
    draw_plane(program_, ground, frame, view);
  }
}

void GroundPass::draw_ghosts(const Frame& frame, const View& view) {
  if (frame.ghost_grounds.empty()) return;
  set_blended_state(gl_);
  ghost_program_.use();
  set_view(ghost_program_, view);
  for (const GroundPlane& ground : frame.ghost_grounds) {
    ghost_program_.set("fill", ground.fill);
    draw_plane(ghost_program_, ground, frame, view);
  }
}

void GroundPass::draw_plane(const gl::Program& program, const GroundPlane& ground,
                            const Frame& frame, const View& view) const {
  const GroundPlace place = place_ground(ground, frame, view);
  program.set("plane_point", place.point);
  program.set("plane_normal", place.normal);
  program.set("tangent", place.tangent);
  program.set("bitangent", place.bitangent);
  program.set("eye_on_grid", place.eye_on_grid[0], place.eye_on_grid[1]);
  program.set("line_spacing", place.line_spacing);
  program.set("fade_center", place.fade_center);
  program.set("fade_distance", place.fade_distance);
  program.set("line_width", place.line_width);
  program.set("color", ground.color);
  gl_.BindVertexArray(vertex_array_.id());
  gl_.DrawArrays(GL_TRIANGLES, 0, 3);
}

}  // namespace neve::render::passes

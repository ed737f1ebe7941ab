#include <algorithm>
#include <cstddef>

#include "render/frame/point_list.h"
#include "render/light/shading_constants.h"
#include "render/passes/passes.h"
#include "render/passes/view_uniforms.h"

namespace neve::render::passes {

ParticlePass::ParticlePass(const gl::Gl& gl, const gl::ShaderLibrary& library, bool is_software)
    : gl_(gl),
      point_program_(gl, library, "particles.vert", "particles.frag"),
      quad_program_(gl, library, "particles.vert", "particles.frag", "#define QUADS\n"),
      vertex_array_(gl),
      buffer_(gl),
      is_software_(is_software) {
  GLfloat range[2] = {1, 1};
  gl.GetFloatv(GL_POINT_SIZE_RANGE, range);
  // A quad is as fast beyond this size, and drivers have been caught cutting large points short.
  max_point_size_ = std::min(range[1], 64.0f);
  gl.BindVertexArray(vertex_array_.id());
  gl.BindBuffer(GL_ARRAY_BUFFER, buffer_.id());
  constexpr GLsizei stride = sizeof(PointVertex);
  gl.VertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, stride, nullptr);
  gl.VertexAttribPointer(1, 4, GL_UNSIGNED_BYTE, GL_TRUE, stride,
                         reinterpret_cast<const void*>(offsetof(PointVertex, color)));
  gl.EnableVertexAttribArray(0);
  gl.EnableVertexAttribArray(1);
}

void ParticlePass::draw(const Points& points, const View& view, ThreadPool* pool) {
  if (points.position.empty()) return;
  const PointList list = list_points(points, view, max_point_size_, is_software_, pool);
  gl::set_solid_state(gl_);
  gl_.Enable(GL_PROGRAM_POINT_SIZE);
  draw_list(point_program_, false, points, view, list.small.data(), list.small.size());
  draw_list(quad_program_, true, points, view, list.large.data(), list.large.size());
}

void ParticlePass::draw_list(const gl::Program& program, bool as_quads, const Points& points,
                             const View& view, const void* vertices, std::size_t count) {
  if (count == 0) return;
  program.use();
  set_view(program, view);
  program.set("radius", points.radius);
  program.set("min_radius_pixels", min_radius_pixels);
  program.set("kind",
              static_cast<float>(points.value.empty() ? light::kind_snow : light::kind_attribute));
  gl_.BindVertexArray(vertex_array_.id());
  gl_.BindBuffer(GL_ARRAY_BUFFER, buffer_.id());
  gl_.BufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(count * sizeof(PointVertex)), vertices,
                 GL_STREAM_DRAW);
  const GLuint per_instance = as_quads ? 1 : 0;
  gl_.VertexAttribDivisor(0, per_instance);
  gl_.VertexAttribDivisor(1, per_instance);
  const auto n = static_cast<GLsizei>(count);
  if (as_quads) {
    gl_.DrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, n);
  } else {
    gl_.DrawArrays(GL_POINTS, 0, n);
  }
}

}  // namespace neve::render::passes

#include <cmath>

#include "render/passes/slice_passes.h"
#include "render/passes/view_uniforms.h"

namespace neve::render::passes {

LinePass::LinePass(const gl::Gl& gl, const gl::ShaderLibrary& library)
    : gl_(gl), program_(gl, library, "line.vert", "line.frag"), vertex_array_(gl), buffer_(gl) {
  gl.BindVertexArray(vertex_array_.id());
  gl.BindBuffer(GL_ARRAY_BUFFER, buffer_.id());
  constexpr GLsizei stride = 2 * sizeof(Vec3f);
  gl.VertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, stride, nullptr);
  gl.VertexAttribPointer(1, 3, GL_FLOAT, GL_FALSE, stride,
                         reinterpret_cast<const void*>(sizeof(Vec3f)));
  for (const GLuint attribute : {0u, 1u}) {
    gl.EnableVertexAttribArray(attribute);
    gl.VertexAttribDivisor(attribute, 1);
  }
}

void LinePass::draw(const std::vector<Lines>& all, const gl::Targets& targets, const View& view,
                    float samples) {
  if (all.empty()) return;
  gl_.Disable(GL_DEPTH_TEST);  // the shader compares with the G-buffer
  gl_.Disable(GL_CULL_FACE);
  gl_.Disable(GL_SCISSOR_TEST);
  gl_.Enable(GL_BLEND);
  gl_.BlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
  program_.use();
  set_view(program_, view);
  gl_.ActiveTexture(GL_TEXTURE0);
  gl_.BindTexture(GL_TEXTURE_2D, targets.depth.id());
  program_.set("depth_map", 0);
  gl_.BindVertexArray(vertex_array_.id());
  gl_.BindBuffer(GL_ARRAY_BUFFER, buffer_.id());
  // As wide as asked for at 720p, in proportion above.
  const float scale = samples * std::fmax(1.0f, static_cast<float>(targets.height) / 720);
  for (const Lines& lines : all) {
    std::vector<Vec3f> ends;
    ends.reserve(lines.ends.size());
    for (const Vec3f& end : lines.ends) ends.push_back(end - view.eye);
    if (ends.size() < 2) continue;
    program_.set("color", lines.color);
    program_.set("opacity", lines.opacity);
    program_.set("width", lines.width * scale);
    gl_.BufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(ends.size() * sizeof(Vec3f)),
                   ends.data(), GL_STREAM_DRAW);
    gl_.DrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, static_cast<GLsizei>(ends.size() / 2));
  }
}

}  // namespace neve::render::passes

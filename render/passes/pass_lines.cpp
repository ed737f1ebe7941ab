#include <cmath>
#include <cstddef>

#include "render/frame/colormap.h"
#include "render/passes/slice_passes.h"
#include "render/passes/view_uniforms.h"

namespace neve::render::passes {

namespace {

struct LineInstance {
  Vec3f first, second;  ///< m, relative to the eye
  Vec3f color;          ///< sRGB
};

std::vector<LineInstance> instances_of(const Lines& lines, Vec3f eye) {
  std::vector<LineInstance> instances;
  instances.reserve(lines.ends.size() / 2);
  for (std::size_t k = 0; 2 * k + 1 < lines.ends.size(); ++k) {
    LineInstance line{lines.ends[2 * k] - eye, lines.ends[2 * k + 1] - eye, lines.color};
    if (!lines.value.empty()) {
      const Rgb8 c = map_value(lines.colormap, lines.value[k], lines.range_min, lines.range_max);
      line.color =
          Vec3f{static_cast<float>(c.r), static_cast<float>(c.g), static_cast<float>(c.b)} / 255;
    }
    instances.push_back(line);
  }
  return instances;
}

}  // namespace

LinePass::LinePass(const gl::Gl& gl, const gl::ShaderLibrary& library)
    : gl_(gl), program_(gl, library, "line.vert", "line.frag"), vertex_array_(gl), buffer_(gl) {
  gl.BindVertexArray(vertex_array_.id());
  gl.BindBuffer(GL_ARRAY_BUFFER, buffer_.id());
  constexpr GLsizei stride = sizeof(LineInstance);
  gl.VertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, stride, nullptr);
  gl.VertexAttribPointer(1, 3, GL_FLOAT, GL_FALSE, stride,
                         reinterpret_cast<const void*>(offsetof(LineInstance, second)));
  gl.VertexAttribPointer(2, 3, GL_FLOAT, GL_FALSE, stride,
                         reinterpret_cast<const void*>(offsetof(LineInstance, color)));
  for (const GLuint attribute : {0u, 1u, 2u}) {
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
  // Lines are as wide as asked for up to 720p, and in proportion above.
  const float scale = samples * std::fmax(1.0f, static_cast<float>(targets.height) / 720);
  for (const Lines& lines : all) {
    const std::vector<LineInstance> instances = instances_of(lines, view.eye);
    if (instances.empty()) continue;
    program_.set("opacity", lines.opacity);
    program_.set("width", lines.width * scale);
    gl_.BufferData(GL_ARRAY_BUFFER,
                   static_cast<GLsizeiptr>(instances.size() * sizeof(LineInstance)),
                   instances.data(), GL_STREAM_DRAW);
    gl_.DrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, static_cast<GLsizei>(instances.size()));
  }
}

}  // namespace neve::render::passes

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "render/frame/colormap.h"
#include "render/passes/slice_passes.h"
#include "render/passes/view_uniforms.h"

namespace neve::render::passes {
namespace {

constexpr int sides = 8;

struct ArrowVertex {
  Vec3f position, normal;
  std::array<std::uint8_t, 4> color;
};

/// Proportions of the longest arrow, in units of its length.
constexpr float shaft_radius = 0.04f, head_radius = 0.12f, head_length = 0.36f;

/// Short arrows are slimmer, but never hairs.
float slimness(float part) {
  return std::clamp(1.6f * part, 0.6f, 1.0f);
}

class ArrowBuilder {
 public:
  ArrowBuilder(const Arrows& arrows, Vec3f eye, std::vector<ArrowVertex>& out)
      : arrows_(arrows), eye_(eye), out_(out) {
    for (int k = 0; k <= sides; ++k) {
      const float angle = 6.2831853f * static_cast<float>(k) / sides;
      circle_[static_cast<std::size_t>(k)] = {std::cos(angle), std::sin(angle)};
    }
  }

  void add(Vec3f from, Vec3f vector) {
    const float magnitude = length(vector);
    if (!(magnitude > 0) || !std::isfinite(magnitude) || !(arrows_.max_length > 0)) return;
    const float reach = std::min(magnitude * arrows_.length_per_value, arrows_.max_length);
    if (!(reach > 0)) return;
    const Vec3f along = vector / magnitude;
    const Vec3f other = std::abs(along.y) < 0.9f ? Vec3f{0, 1, 0} : Vec3f{1, 0, 0};
    const Vec3f side = normalized(cross(other, along)), top = cross(along, side);
    const Rgb8 c = map_value(arrows_.colormap, magnitude, arrows_.range_min, arrows_.range_max);
    if (arrows_.is_white)
      color_ = {255, 255, 255, 255};
    else
      color_ = {c.r, c.g, c.b, 255};
    const float slim = arrows_.max_length * slimness(reach / arrows_.max_length);
    const float head = std::min(head_length * slim, 0.6f * reach);
    const Vec3f start = from - eye_, neck = start + along * (reach - head),
                tip = start + along * reach;
    const float r_shaft = shaft_radius * slim, r_head = head_radius * slim;
    for (std::size_t k = 0; k < sides; ++k) {
      const Vec3f a = side * circle_[k][0] + top * circle_[k][1];
      const Vec3f b = side * circle_[k + 1][0] + top * circle_[k + 1][1];
      // Shaft, the ring behind the head, the head, the tail's end.
      triangle({start + a * r_shaft, a}, {start + b * r_shaft, b}, {neck + b * r_shaft, b});
      triangle({start + a * r_shaft, a}, {neck + b * r_shaft, b}, {neck + a * r_shaft, a});
      triangle({neck, -along}, {neck + a * r_head, -along}, {neck + b * r_head, -along});
      const float lean = r_head / head;
      triangle({neck + a * r_head, a + along * lean}, {neck + b * r_head, b + along * lean},
               {tip, a + b + along * (2 * lean)});
      triangle({start, -along}, {start + a * r_shaft, -along}, {start + b * r_shaft, -along});
    }
  }

 private:
  struct Corner {
    Vec3f position, normal;
  };
  void triangle(const Corner& a, const Corner& b, const Corner& c) {
    for (const Corner& corner : {a, b, c})
      out_.push_back({corner.position, normalized(corner.normal), color_});
  }

  const Arrows& arrows_;
  Vec3f eye_;
  std::vector<ArrowVertex>& out_;
  std::array<std::array<float, 2>, sides + 1> circle_;
  std::array<std::uint8_t, 4> color_{};
};

}  // namespace

ArrowPass::ArrowPass(const gl::Gl& gl, const gl::ShaderLibrary& library)
    : gl_(gl), program_(gl, library, "arrow.vert", "arrow.frag"), vertex_array_(gl), buffer_(gl) {
  gl.BindVertexArray(vertex_array_.id());
  gl.BindBuffer(GL_ARRAY_BUFFER, buffer_.id());
  constexpr GLsizei stride = sizeof(ArrowVertex);
  gl.VertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, stride, nullptr);
  gl.VertexAttribPointer(1, 3, GL_FLOAT, GL_FALSE, stride,
                         reinterpret_cast<const void*>(offsetof(ArrowVertex, normal)));
  gl.VertexAttribPointer(2, 4, GL_UNSIGNED_BYTE, GL_TRUE, stride,
                         reinterpret_cast<const void*>(offsetof(ArrowVertex, color)));
  for (const GLuint attribute : {0u, 1u, 2u}) gl.EnableVertexAttribArray(attribute);
}

void ArrowPass::draw(const std::vector<Arrows>& all, const View& view) {
  std::vector<ArrowVertex> vertices;
  for (const Arrows& arrows : all) {
    ArrowBuilder builder(arrows, view.eye, vertices);
    for (std::size_t k = 0; k < arrows.position.size(); ++k)
      builder.add(arrows.position[k], arrows.vector[k]);
  }
  if (vertices.empty()) return;
  gl::set_solid_state(gl_);
  program_.use();
  set_view(program_, view);
  gl_.BindVertexArray(vertex_array_.id());
  gl_.BindBuffer(GL_ARRAY_BUFFER, buffer_.id());
  gl_.BufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(vertices.size() * sizeof(ArrowVertex)),
                 vertices.data(), GL_STREAM_DRAW);
  gl_.DrawArrays(GL_TRIANGLES, 0, static_cast<GLsizei>(vertices.size()));
}

}  // namespace neve::render::passes

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
/// Vertices of an arrow, about: half of the five triangles on each side of it and its rim are seen.
constexpr std::size_t vertices_per_arrow = 3 * 5 * sides;

struct ArrowVertex {
  Vec3f position, normal;
  std::array<std::uint8_t, 4> color;
};

/// Proportions of the longest arrow, in units of its length.
constexpr float shaft_radius = 0.04f, head_radius = 0.12f, head_length = 0.36f;
/// A dark rim around it, so that it stands out from any colour and from the arrows behind it.
constexpr float rim_width = 0.035f;
constexpr std::array<std::uint8_t, 4> rim_color{14, 17, 24, 255};

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

  void add(Vec3f place, Vec3f vector) {
    const float magnitude = length(vector);
    if (!(magnitude > 0) || !std::isfinite(magnitude) || !(arrows_.max_length > 0)) return;
    const float reach = std::min(magnitude * arrows_.length_per_value, arrows_.max_length);
    if (!(reach > 0)) return;
    along_ = vector / magnitude;
    const Vec3f other = std::abs(along_.y) < 0.9f ? Vec3f{0, 1, 0} : Vec3f{1, 0, 0};
    side_ = normalized(cross(other, along_));
    top_ = cross(along_, side_);
    const float slim = arrows_.max_length * slimness(reach / arrows_.max_length);
    const float head = std::min(head_length * slim, 0.6f * reach), rim = rim_width * slim;
    const Vec3f start = place - eye_ - along_ * (arrows_.is_centred ? 0.5f * reach : 0);
    // Nearer by its own thickness, seen from the eye the same: what it lies on hides no part of it.
    const float thick = 1.5f * (head_radius * slim + rim);
    nearer_ = std::max(0.5f, 1 - thick / std::max(length(start), 1e-6f));
    const Rgb8 c = map_value(arrows_.colormap, magnitude, arrows_.range_min, arrows_.range_max);
    color_ = {c.r, c.g, c.b, 255};
    if (arrows_.is_white) color_ = {255, 255, 255, 255};
    is_rim_ = false;
    body(start, reach, head, shaft_radius * slim, head_radius * slim);
    color_ = rim_color;
    is_rim_ = true;
    body(start - along_ * rim, reach + 3 * rim, head + 2 * rim, shaft_radius * slim + rim,
         head_radius * slim + rim);
  }

 private:
  struct Corner {
    Vec3f position, normal;
  };

  void body(Vec3f start, float reach, float head, float r_shaft, float r_head) {
    const Vec3f neck = start + along_ * (reach - head), tip = start + along_ * reach;
    for (std::size_t k = 0; k < sides; ++k) {
      const Vec3f a = side_ * circle_[k][0] + top_ * circle_[k][1];
      const Vec3f b = side_ * circle_[k + 1][0] + top_ * circle_[k + 1][1];
      // Shaft, the ring behind the head, the head, the tail's end.
      triangle({start + a * r_shaft, a}, {start + b * r_shaft, b}, {neck + b * r_shaft, b});
      triangle({start + a * r_shaft, a}, {neck + b * r_shaft, b}, {neck + a * r_shaft, a});
      triangle({neck, -along_}, {neck + a * r_head, -along_}, {neck + b * r_head, -along_});
      const float lean = r_head / head;
      triangle({neck + a * r_head, a + along_ * lean}, {neck + b * r_head, b + along_ * lean},
               {tip, a + b + along_ * (2 * lean)});
      triangle({start, -along_}, {start + a * r_shaft, -along_}, {start + b * r_shaft, -along_});
    }
  }

  /// Keeps only the side of an arrow that is turned to the eye, which hides the other, and only the
  /// side of the rim that is turned away: the arrow is before it.
  void triangle(const Corner& a, const Corner& b, const Corner& c) {
    Vec3f out = cross(b.position - a.position, c.position - a.position);
    if (dot(out, a.normal + b.normal + c.normal) < 0) out = -out;
    const bool is_turned_away = dot(out, a.position) > 0;
    if (is_turned_away != is_rim_) return;
    for (const Corner& corner : {a, b, c})
      out_.push_back({corner.position * nearer_, normalized(corner.normal), color_});
  }

  const Arrows& arrows_;
  Vec3f eye_;
  std::vector<ArrowVertex>& out_;
  std::array<std::array<float, 2>, sides + 1> circle_;
  std::array<std::uint8_t, 4> color_{};
  Vec3f along_, side_, top_;
  float nearer_ = 1;
  bool is_rim_ = false;
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
  std::size_t count = 0;
  for (const Arrows& arrows : all) count += arrows.position.size();
  vertices.reserve(count * vertices_per_arrow);
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

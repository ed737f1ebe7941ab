#include <algorithm>
#include <cmath>

#include "render/frame/colormap.h"
#include "render/frame/range.h"
#include "render/passes/slice_passes.h"
#include "render/passes/view_uniforms.h"

namespace neve::render::passes {

HeatMapPass::HeatMapPass(const gl::Gl& gl, const gl::ShaderLibrary& library)
    : gl_(gl),
      program_(gl, library, "heat_map.vert", "heat_map.frag"),
      vertex_array_(gl),
      values_(gl),
      colors_(gl) {}

void HeatMapPass::upload(const HeatMap& map) {
  // Linear filtering of (value if there is one, whether there is one): their quotient is the mean
  // of the samples that have a value.
  std::vector<float> texels;
  texels.reserve(2 * map.value.size());
  for (std::size_t k = 0; k < map.value.size(); ++k) {
    const bool is_there = std::isfinite(map.value[k]);
    const float cover = !is_there ? 0 : map.cover.empty() ? 1 : map.cover[k];
    texels.push_back(is_there ? cover * map.value[k] : 0);
    texels.push_back(cover);
  }
  std::vector<std::uint8_t> colors;
  for (int k = 0; k < 256; ++k) {
    const Rgb8 c = map_color(map.colormap, static_cast<float>(k) / 255);
    colors.insert(colors.end(), {c.r, c.g, c.b, 255});
  }
  values_ = gl::make_texture_2d(gl_, map.columns, map.rows, GL_RG32F, GL_RG, GL_FLOAT,
                                texels.data(), GL_LINEAR);
  colors_ = gl::make_texture_2d(gl_, 256, 1, GL_RGBA8, GL_RGBA, GL_UNSIGNED_BYTE, colors.data(),
                                GL_LINEAR);
}

void HeatMapPass::draw(const std::vector<HeatMap>& maps, const View& view, float samples) {
  gl::set_solid_state(gl_);
  for (const HeatMap& map : maps) {
    if (map.columns < 1 || map.rows < 1) continue;
    upload(map);
    program_.use();
    set_view(program_, view);
    const Vec3f corner = map.corner - view.eye;
    Vec3f normal = normalized(cross(map.across, map.up));
    if (dot(normal, corner) > 0) normal = -normal;
    program_.set("corner", corner);
    program_.set("across", map.across);
    program_.set("up", map.up);
    program_.set("normal", normal);
    program_.set("range_min", map.range_min);
    const bool is_one_value =
        !has_width(static_cast<double>(map.range_min), static_cast<double>(map.range_max));
    program_.set("range_max", is_one_value ? map.range_min : map.range_max);
    program_.set("isoline_step", std::max(map.isoline_step, 0.0f));
    program_.set("isoline_width", 1.2f * samples);
    gl_.ActiveTexture(GL_TEXTURE0);
    gl_.BindTexture(GL_TEXTURE_2D, values_.id());
    program_.set("values", 0);
    gl_.ActiveTexture(GL_TEXTURE1);
    gl_.BindTexture(GL_TEXTURE_2D, colors_.id());
    program_.set("colors", 1);
    gl_.BindVertexArray(vertex_array_.id());
    gl_.DrawArrays(GL_TRIANGLE_STRIP, 0, 4);
  }
}

}  // namespace neve::render::passes

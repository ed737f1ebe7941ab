#include <algorithm>

#include "render/passes/passes.h"
#include "render/passes/view_uniforms.h"

namespace neve::render::passes {
namespace {

/// Writes one tile into rows of the picture.
void copy_tile(const light::GBufferTile& tile, int x, int y, int width, int height, float* normals,
               std::uint32_t* colors) {
  const int columns = std::min(light::tile_width, width - x);
  for (int j = 0; j < std::min(light::tile_height, height - y); ++j) {
    const auto to = static_cast<std::size_t>(y + j) * static_cast<std::size_t>(width) +
                    static_cast<std::size_t>(x);
    for (int i = 0; i < columns; ++i) {
      const int at = j * light::tile_width + i;
      float* n = normals + 4 * (to + static_cast<std::size_t>(i));
      n[0] = tile.normal_x[at];
      n[1] = tile.normal_y[at];
      n[2] = tile.normal_z[at];
      n[3] = tile.inverse[at];
      colors[to + static_cast<std::size_t>(i)] = tile.albedo[at];
    }
  }
}

}  // namespace

TilePass::TilePass(const gl::Gl& gl, const gl::ShaderLibrary& library)
    : gl_(gl),
      program_(gl, library, "fullscreen.vert", "tiles.frag"),
      vertex_array_(gl),
      normal_inverse_(gl),
      color_(gl) {}

void TilePass::draw(const light::GBufferTile* tiles, int columns, const View& view) {
  const auto count = static_cast<std::size_t>(view.width) * static_cast<std::size_t>(view.height);
  normals_.resize(4 * count);
  colors_.resize(count);
  const light::GBufferTile* tile = tiles;
  for (int y = 0; y < view.height; y += light::tile_height)
    for (int x = 0; x < columns * light::tile_width; x += light::tile_width)
      copy_tile(*tile++, x, y, view.width, view.height, normals_.data(), colors_.data());
  program_.use();
  set_view(program_, view);
  gl_.PixelStorei(GL_UNPACK_ALIGNMENT, 1);
  const auto upload = [&](GLenum unit, const gl::Texture& texture, GLint internal, GLenum type,
                          const void* from) {
    gl_.ActiveTexture(GL_TEXTURE0 + unit);
    gl_.BindTexture(GL_TEXTURE_2D, texture.id());
    gl_.TexImage2D(GL_TEXTURE_2D, 0, internal, view.width, view.height, 0, GL_RGBA, type, from);
    for (const GLenum filter : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER})
      gl_.TexParameteri(GL_TEXTURE_2D, filter, GL_NEAREST);
  };
  upload(0, normal_inverse_, GL_RGBA32F, GL_FLOAT, normals_.data());
  upload(1, color_, GL_RGBA8, GL_UNSIGNED_BYTE, colors_.data());
  program_.set("normal_inverse_map", 0);
  program_.set("color_map", 1);
  gl_.Enable(GL_DEPTH_TEST);
  gl_.DepthFunc(GL_LESS);
  gl_.DepthMask(GL_TRUE);
  gl_.Disable(GL_BLEND);
  gl_.BindVertexArray(vertex_array_.id());
  gl_.DrawArrays(GL_TRIANGLES, 0, 3);
}

}  // namespace neve::render::passes

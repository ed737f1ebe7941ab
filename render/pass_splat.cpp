#include "render/passes.h"

namespace neve::render {

void SplatPass::draw(const Points& points, const View& view, const Targets& targets) {
  splatter_.draw(points, view, pool_, [&](const SplatBand& band) {
    const auto upload = [&](const Texture& texture, GLenum format, GLenum type,
                            const void* samples) {
      gl_.BindTexture(GL_TEXTURE_2D, texture.id());
      gl_.TexSubImage2D(GL_TEXTURE_2D, 0, band.x, band.y, band.width, band.height, format, type,
                        samples);
    };
    gl_.ActiveTexture(GL_TEXTURE0);
    gl_.PixelStorei(GL_UNPACK_ALIGNMENT, 1);
    gl_.PixelStorei(GL_UNPACK_ROW_LENGTH, band.pitch);
    upload(targets.depth, GL_DEPTH_COMPONENT, GL_FLOAT, band.depth);
    upload(targets.normal_kind, GL_RGBA, GL_HALF_FLOAT, band.normal_kind);
    upload(targets.albedo, GL_RGBA, GL_UNSIGNED_BYTE, band.albedo);
    gl_.PixelStorei(GL_UNPACK_ROW_LENGTH, 0);
  });
}

}  // namespace neve::render

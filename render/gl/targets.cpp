#include "render/gl/targets.h"

#include <stdexcept>
#include <string>

namespace neve::render::gl {
namespace {

void attach(const Gl& gl, const Framebuffer& framebuffer, GLenum attachment,
            const Texture& texture) {
  gl.BindFramebuffer(GL_FRAMEBUFFER, framebuffer.id());
  gl.FramebufferTexture2D(GL_FRAMEBUFFER, attachment, GL_TEXTURE_2D, texture.id(), 0);
}

void check_complete(const Gl& gl, const Framebuffer& framebuffer, int width, int height) {
  gl.BindFramebuffer(GL_FRAMEBUFFER, framebuffer.id());
  const GLenum status = gl.CheckFramebufferStatus(GL_FRAMEBUFFER);
  if (status == GL_FRAMEBUFFER_COMPLETE && gl.GetError() != GL_OUT_OF_MEMORY) return;
  throw std::runtime_error("the OpenGL driver cannot draw " + std::to_string(width) + "x" +
                           std::to_string(height) + " samples; try a smaller size");
}

}  // namespace

Targets::Targets(const Gl& gl, int width_, int height_, int supersampling_, bool has_samples_)
    : width(width_), height(height_), supersampling(supersampling_), has_samples(has_samples_) {
  const int w = sample_width(), h = sample_height();
  const auto make = [&](GLint internal, GLenum format, GLenum type, int tw, int th) {
    return make_texture_2d(gl, tw, th, internal, format, type, nullptr, GL_NEAREST);
  };
  depth = make(GL_DEPTH_COMPONENT32F, GL_DEPTH_COMPONENT, GL_FLOAT, w, h);
  normal_kind = make(GL_RGBA16F, GL_RGBA, GL_HALF_FLOAT, w, h);
  albedo = make(GL_RGBA8, GL_RGBA, GL_UNSIGNED_BYTE, w, h);
  picture = make(GL_RGBA8, GL_RGBA, GL_UNSIGNED_BYTE, width, height);

  gbuffer = Framebuffer(gl);
  attach(gl, gbuffer, GL_DEPTH_ATTACHMENT, depth);
  attach(gl, gbuffer, GL_COLOR_ATTACHMENT0, normal_kind);
  attach(gl, gbuffer, GL_COLOR_ATTACHMENT1, albedo);
  constexpr GLenum both[] = {GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1};
  gl.DrawBuffers(2, both);
  check_complete(gl, gbuffer, w, h);

  shaded = Framebuffer(gl);
  if (has_samples) samples = make(GL_RGBA8, GL_RGBA, GL_UNSIGNED_BYTE, w, h);
  attach(gl, shaded, GL_COLOR_ATTACHMENT0, has_samples ? samples : picture);
  check_complete(gl, shaded, w, h);

  laid_over = Framebuffer(gl);
  attach(gl, laid_over, GL_COLOR_ATTACHMENT0, top());
  check_complete(gl, laid_over, w, h);

  laid_over_with_depth = Framebuffer(gl);
  attach(gl, laid_over_with_depth, GL_COLOR_ATTACHMENT0, top());
  attach(gl, laid_over_with_depth, GL_DEPTH_ATTACHMENT, depth);
  check_complete(gl, laid_over_with_depth, w, h);

  finished = Framebuffer(gl);
  attach(gl, finished, GL_COLOR_ATTACHMENT0, picture);
  check_complete(gl, finished, width, height);
}

}  // namespace neve::render::gl

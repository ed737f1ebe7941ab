#include <stdexcept>

#include "render/light/shading_constants.h"
#include "render/passes/passes.h"
#include "render/passes/view_uniforms.h"

namespace neve::render::passes {
namespace {

void upload_2d(const gl::Gl& gl, const gl::Texture& texture, GLint internal, GLenum format,
               int width, int height, const float* texels, GLint filter) {
  gl.BindTexture(GL_TEXTURE_2D, texture.id());
  gl.PixelStorei(GL_UNPACK_ALIGNMENT, 1);
  gl.TexImage2D(GL_TEXTURE_2D, 0, internal, width, height, 0, format, GL_FLOAT, texels);
  for (const GLenum name : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER})
    gl.TexParameteri(GL_TEXTURE_2D, name, filter);
  for (const GLenum name : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T})
    gl.TexParameteri(GL_TEXTURE_2D, name, GL_CLAMP_TO_EDGE);
}

void upload_3d(const gl::Gl& gl, const gl::Texture& texture, GLint internal, GLenum format,
               GLenum type, Vec3i size, const void* texels, GLint filter) {
  gl.BindTexture(GL_TEXTURE_3D, texture.id());
  gl.PixelStorei(GL_UNPACK_ALIGNMENT, 1);
  gl.TexImage3D(GL_TEXTURE_3D, 0, internal, size.x, size.y, size.z, 0, format, type, texels);
  for (const GLenum name : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER})
    gl.TexParameteri(GL_TEXTURE_3D, name, filter);
  for (const GLenum name : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T, GL_TEXTURE_WRAP_R})
    gl.TexParameteri(GL_TEXTURE_3D, name, GL_CLAMP_TO_EDGE);
}

}  // namespace

SmokePass::SmokePass(const gl::Gl& gl, const gl::ShaderLibrary& library)
    : gl_(gl),
      white_program_(gl, library, "fullscreen.vert", "smoke.frag"),
      value_program_(gl, library, "fullscreen.vert", "smoke.frag", "#define VALUE\n"),
      vertex_array_(gl),
      volume_(gl),
      bricks_(gl),
      spans_(gl),
      colormap_(gl),
      sums_(gl),
      depth_(gl) {}

void SmokePass::prepare_target(int width, int height) {
  if (width_ == width && height_ == height) return;
  upload_2d(gl_, sums_, GL_RGBA16F, GL_RGBA, width, height, nullptr, GL_NEAREST);
  upload_2d(gl_, depth_, GL_R32F, GL_RED, width, height, nullptr, GL_NEAREST);
  framebuffer_ = gl::Framebuffer(gl_);
  gl_.BindFramebuffer(GL_FRAMEBUFFER, framebuffer_.id());
  gl_.FramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, sums_.id(), 0);
  gl_.FramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT1, GL_TEXTURE_2D, depth_.id(), 0);
  constexpr GLenum both[] = {GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1};
  gl_.DrawBuffers(2, both);
  if (gl_.CheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
    throw std::runtime_error("the OpenGL driver cannot draw smoke into half floats");
  width_ = width;
  height_ = height;
}

void SmokePass::upload(const light::SmokeGrid& grid, const light::SmokeVolume& volume,
                       const light::SmokeSpans& spans) {
  upload_3d(gl_, volume_, GL_RGBA16F, GL_RGBA, GL_FLOAT, grid.size, volume.texels.data(),
            GL_LINEAR);
  upload_3d(gl_, bricks_, GL_R8, GL_RED, GL_UNSIGNED_BYTE, volume.brick_count, volume.bricks.data(),
            GL_NEAREST);
  upload_2d(gl_, spans_, GL_RG32F, GL_RG, spans.columns, spans.rows, spans.near_far.data(),
            GL_NEAREST);
}

void SmokePass::upload_colormap(const Smoke& smoke) {
  const std::vector<float> colors = light::linear_colors(smoke.colormap);
  upload_2d(gl_, colormap_, GL_RGBA32F, GL_RGBA, light::colormap_width, 1, colors.data(),
            GL_LINEAR);
}

void SmokePass::march(const Smoke& smoke, const light::SmokeGrid& grid,
                      const light::SmokeVolume& volume, const light::SmokeSpans& spans,
                      const Light& light, const gl::Targets& targets, const View& view) {
  const int n = spans.tile / light::smoke_rays_per_tile;
  const bool has_values = !smoke.value.empty();
  prepare_target((view.width + n - 1) / n, (view.height + n - 1) / n);
  gl_.ActiveTexture(GL_TEXTURE0);
  upload(grid, volume, spans);
  if (has_values) upload_colormap(smoke);
  gl_.BindFramebuffer(GL_FRAMEBUFFER, framebuffer_.id());
  gl_.Viewport(0, 0, width_, height_);
  gl::set_flat_state(gl_);
  const gl::Program& program = has_values ? value_program_ : white_program_;
  program.use();
  set_view(program, view);
  program.set("samples_per_ray", n);
  program.set("tile", static_cast<float>(spans.tile));
  program.set("grid_origin", grid.origin - view.eye);
  program.set("grid_size", Vec3f{static_cast<float>(grid.size.x), static_cast<float>(grid.size.y),
                                 static_cast<float>(grid.size.z)});
  program.set("texel", grid.spacing);
  program.set("step_length", light::march_step * grid.spacing);
  program.set("extinction", grid.extinction());
  program.set("smoke_range", spans.nearest, spans.farthest);
  program.set("key_light", light::key_on_colors * light.intensity);
  program.set("sky_light", light::sky_on_colors * light.ambient);
  const auto bind = [&](int unit, GLenum target, const gl::Texture& texture, const char* sampler) {
    gl_.ActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
    gl_.BindTexture(target, texture.id());
    program.set(sampler, unit);
  };
  bind(0, GL_TEXTURE_2D, targets.depth, "depth_map");
  bind(1, GL_TEXTURE_3D, volume_, "smoke_volume");
  bind(2, GL_TEXTURE_3D, bricks_, "brick_map");
  bind(3, GL_TEXTURE_2D, spans_, "span_map");
  bind(4, GL_TEXTURE_2D, colormap_, "colormap");
  gl_.BindVertexArray(vertex_array_.id());
  gl_.DrawArrays(GL_TRIANGLES, 0, 3);
}

std::optional<SmokePicture> SmokePass::draw(const Smoke& smoke, const light::SmokeGrid& grid,
                                            const light::SmokeVolume& volume, const Light& light,
                                            const gl::Targets& targets, const View& view) {
  const int n = light::samples_per_ray(smoke, grid, view);
  const light::SmokeSpans spans =
      light::make_smoke_spans(grid, volume, view, light::smoke_rays_per_tile * n);
  if (spans.nearest > spans.farthest) return std::nullopt;
  march(smoke, grid, volume, spans, light, targets, view);
  SmokePicture picture;
  picture.sums = sums_.id();
  picture.depth = depth_.id();
  picture.samples_per_ray = n;
  picture.nearest = spans.nearest;
  picture.farthest = spans.farthest;
  picture.spacing = grid.spacing;
  picture.is_colored = !smoke.value.empty();
  return picture;
}

}  // namespace neve::render::passes

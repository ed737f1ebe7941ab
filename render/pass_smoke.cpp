#include <array>
#include <cmath>
#include <stdexcept>

#include "render/colormap.h"
#include "render/passes.h"

namespace neve::render {
namespace {

constexpr int rays_per_tile = 8;  // along each axis
constexpr int colormap_width = 64;

void set_filter(const Gl& gl, GLenum target, GLint filter) {
  for (const GLenum name : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER})
    gl.TexParameteri(target, name, filter);
  for (const GLenum name : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T, GL_TEXTURE_WRAP_R})
    gl.TexParameteri(target, name, GL_CLAMP_TO_EDGE);
}

}  // namespace

SmokePass::SmokePass(const Gl& gl, const ShaderLibrary& library)
    : gl_(gl),
      white_program_(gl, library, "fullscreen.vert", "smoke.frag"),
      value_program_(gl, library, "fullscreen.vert", "smoke.frag", "#define VALUE\n"),
      vertex_array_(gl),
      volume_(gl),
      bricks_(gl),
      spans_(gl),
      colormap_(gl) {}

void SmokePass::prepare_target(int width, int height) {
  if (width_ == width && height_ == height) return;
  radiance_ =
      make_texture_2d(gl_, width, height, GL_RGBA16F, GL_RGBA, GL_HALF_FLOAT, nullptr, GL_NEAREST);
  depth_ = make_texture_2d(gl_, width, height, GL_R32F, GL_RED, GL_FLOAT, nullptr, GL_NEAREST);
  framebuffer_ = Framebuffer(gl_);
  gl_.BindFramebuffer(GL_FRAMEBUFFER, framebuffer_.id());
  gl_.FramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, radiance_.id(), 0);
  gl_.FramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT1, GL_TEXTURE_2D, depth_.id(), 0);
  constexpr GLenum both[] = {GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1};
  gl_.DrawBuffers(2, both);
  if (gl_.CheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
    throw std::runtime_error("the OpenGL driver cannot draw smoke into half floats");
  width_ = width;
  height_ = height;
}

void SmokePass::upload(const SmokeGrid& grid, const SmokeVolume& volume, const SmokeSpans& spans) {
  gl_.ActiveTexture(GL_TEXTURE0);
  gl_.PixelStorei(GL_UNPACK_ALIGNMENT, 1);
  gl_.BindTexture(GL_TEXTURE_3D, volume_.id());
  gl_.TexImage3D(GL_TEXTURE_3D, 0, GL_RGBA16, grid.size.x, grid.size.y, grid.size.z, 0, GL_RGBA,
                 GL_UNSIGNED_SHORT, volume.texels.data());
  set_filter(gl_, GL_TEXTURE_3D, GL_LINEAR);
  gl_.BindTexture(GL_TEXTURE_3D, bricks_.id());
  gl_.TexImage3D(GL_TEXTURE_3D, 0, GL_R8, volume.brick_count.x, volume.brick_count.y,
                 volume.brick_count.z, 0, GL_RED, GL_UNSIGNED_BYTE, volume.bricks.data());
  set_filter(gl_, GL_TEXTURE_3D, GL_NEAREST);
  gl_.BindTexture(GL_TEXTURE_2D, spans_.id());
  gl_.TexImage2D(GL_TEXTURE_2D, 0, GL_RG32F, spans.columns, spans.rows, 0, GL_RG, GL_FLOAT,
                 spans.near_far.data());
  set_filter(gl_, GL_TEXTURE_2D, GL_NEAREST);
}

void SmokePass::upload_colormap(const Smoke& smoke) {
  std::array<float, 3 * colormap_width> colors{};
  for (std::size_t i = 0; i < colormap_width; ++i) {
    const Rgb8 color =
        map_color(smoke.colormap, static_cast<float>(i) / static_cast<float>(colormap_width - 1));
    const std::array<std::uint8_t, 3> channels = {color.r, color.g, color.b};
    for (std::size_t c = 0; c < 3; ++c)
      colors[3 * i + c] = std::pow(static_cast<float>(channels[c]) / 255, 2.2f);
  }
  gl_.BindTexture(GL_TEXTURE_2D, colormap_.id());
  gl_.TexImage2D(GL_TEXTURE_2D, 0, GL_RGB32F, colormap_width, 1, 0, GL_RGB, GL_FLOAT,
                 colors.data());
  set_filter(gl_, GL_TEXTURE_2D, GL_LINEAR);
}

std::optional<SmokePicture> SmokePass::draw(const Smoke& smoke, const SmokeGrid& grid,
                                            const SmokeVolume& volume, const Light& light,
                                            const Targets& targets, const View& view) {
  const int n = smoke.samples_per_ray;
  const SmokeSpans spans = make_smoke_spans(grid, volume, view, rays_per_tile * n);
  if (spans.nearest > spans.farthest) return std::nullopt;
  prepare_target((view.width + n - 1) / n, (view.height + n - 1) / n);
  upload(grid, volume, spans);
  const bool has_values = !smoke.value.empty();
  if (has_values) upload_colormap(smoke);

  gl_.BindFramebuffer(GL_FRAMEBUFFER, framebuffer_.id());
  gl_.Viewport(0, 0, width_, height_);
  set_flat_state(gl_);
  const Program& program = has_values ? value_program_ : white_program_;
  program.use();
  set_view(program, view);
  program.set("samples_per_ray", n);
  program.set("tile", static_cast<float>(spans.tile));
  program.set("grid_origin", grid.origin - view.eye);
  program.set("grid_size", Vec3f{static_cast<float>(grid.size.x), static_cast<float>(grid.size.y),
                                 static_cast<float>(grid.size.z)});
  program.set("texel", grid.spacing);
  program.set("step_length", 0.5f * grid.spacing);
  program.set("full_extinction", volume.full_opacity * grid.extinction());
  program.set("smoke_range", spans.nearest, spans.farthest);
  program.set("toward_light", toward_light(light));
  program.set("key_intensity", light.intensity);
  program.set("ambient_intensity", light.ambient);
  const auto bind = [&](int unit, GLenum target, const Texture& texture, const char* sampler) {
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
  return SmokePicture{radiance_.id(), depth_.id(),    n,
                      spans.nearest,  spans.farthest, grid.node_spacing};
}

}  // namespace neve::render

#include "render/passes.h"

namespace neve::render {
namespace {

void set_volume_parameters(const Gl& gl) {
  for (const GLenum filter : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER})
    gl.TexParameteri(GL_TEXTURE_3D, filter, GL_LINEAR);
  for (const GLenum wrap : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T, GL_TEXTURE_WRAP_R})
    gl.TexParameteri(GL_TEXTURE_3D, wrap, GL_CLAMP_TO_EDGE);
}

void bind(const Gl& gl, const Program& program, int unit, GLenum target, const Texture& texture,
          const char* sampler) {
  gl.ActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
  gl.BindTexture(target, texture.id());
  program.set(sampler, unit);
}

void set_flat_state(const Gl& gl) {
  gl.Disable(GL_DEPTH_TEST);
  gl.Disable(GL_BLEND);
  gl.Disable(GL_CULL_FACE);
  gl.Disable(GL_SCISSOR_TEST);
}

}  // namespace

ShadePass::ShadePass(const Gl& gl, const ShaderLibrary& library)
    : gl_(gl),
      program_(gl, library, "fullscreen.vert", "shade.frag"),
      vertex_array_(gl),
      body_(gl),
      light_(gl) {}

void ShadePass::upload(const LightVolume& volume) {
  const Vec3i size = volume.grid.size;
  gl_.ActiveTexture(GL_TEXTURE0);
  gl_.PixelStorei(GL_UNPACK_ALIGNMENT, 1);
  gl_.BindTexture(GL_TEXTURE_3D, body_.id());
  gl_.TexImage3D(GL_TEXTURE_3D, 0, GL_RGBA8_SNORM, size.x, size.y, size.z, 0, GL_RGBA, GL_BYTE,
                 volume.body.data());
  set_volume_parameters(gl_);
  gl_.BindTexture(GL_TEXTURE_3D, light_.id());
  gl_.TexImage3D(GL_TEXTURE_3D, 0, GL_RG16, size.x, size.y, size.z, 0, GL_RG, GL_UNSIGNED_SHORT,
                 volume.light.data());
  set_volume_parameters(gl_);
}

void ShadePass::draw(const Targets& targets, const LightVolume& volume, const Light& light,
                     const View& view) {
  upload(volume);
  set_flat_state(gl_);
  program_.use();
  set_view(program_, view);
  const LightGrid& grid = volume.grid;
  const Vec3f size = {static_cast<float>(grid.size.x), static_cast<float>(grid.size.y),
                      static_cast<float>(grid.size.z)};
  program_.set("box_origin", grid.origin - view.eye);
  program_.set("box_size", size * grid.cell);
  program_.set("cell", grid.cell);
  program_.set("toward_light", toward_light(light));
  program_.set("key_intensity", light.intensity);
  program_.set("ambient_intensity", light.ambient);
  bind(gl_, program_, 0, GL_TEXTURE_2D, targets.depth, "depth_map");
  bind(gl_, program_, 1, GL_TEXTURE_2D, targets.normal_kind, "normal_kind_map");
  bind(gl_, program_, 2, GL_TEXTURE_2D, targets.albedo, "albedo_map");
  bind(gl_, program_, 3, GL_TEXTURE_3D, body_, "body_volume");
  bind(gl_, program_, 4, GL_TEXTURE_3D, light_, "light_volume");
  gl_.BindVertexArray(vertex_array_.id());
  gl_.DrawArrays(GL_TRIANGLES, 0, 3);
}

ResolvePass::ResolvePass(const Gl& gl, const ShaderLibrary& library)
    : gl_(gl), program_(gl, library, "fullscreen.vert", "resolve.frag"), vertex_array_(gl) {}

void ResolvePass::draw(const Targets& targets) {
  set_flat_state(gl_);
  program_.use();
  bind(gl_, program_, 0, GL_TEXTURE_2D, targets.samples, "samples");
  gl_.BindVertexArray(vertex_array_.id());
  gl_.DrawArrays(GL_TRIANGLES, 0, 3);
}

}  // namespace neve::render

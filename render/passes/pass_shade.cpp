#include "render/passes/passes.h"
#include "render/passes/view_uniforms.h"

namespace neve::render::passes {
namespace {

void set_volume_parameters(const gl::Gl& gl) {
  for (const GLenum filter : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER})
    gl.TexParameteri(GL_TEXTURE_3D, filter, GL_LINEAR);
  for (const GLenum wrap : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T, GL_TEXTURE_WRAP_R})
    gl.TexParameteri(GL_TEXTURE_3D, wrap, GL_CLAMP_TO_EDGE);
}

void bind(const gl::Gl& gl, const gl::Program& program, int unit, GLenum target, GLuint texture,
          const char* sampler) {
  gl.ActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
  gl.BindTexture(target, texture);
  program.set(sampler, unit);
}

}  // namespace

ShadePass::ShadePass(const gl::Gl& gl, const gl::ShaderLibrary& library)
    : gl_(gl),
      program_(gl, library, "fullscreen.vert", "shade.frag"),
      smoke_program_(gl, library, "fullscreen.vert", "shade.frag", "#define SMOKE\n"),
      vertex_array_(gl),
      body_(gl),
      light_(gl) {}

void ShadePass::upload(const light::LightVolume& volume) {
  if (volume.serial != 0 && volume.serial == uploaded_) return;
  uploaded_ = volume.serial;
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

void ShadePass::draw(const gl::Targets& targets, const light::LightVolume& volume,
                     const Frame& frame, const View& view, const SmokePicture* smoke) {
  const gl::Program& program = smoke ? smoke_program_ : program_;
  upload(volume);
  gl::set_flat_state(gl_);
  program.use();
  set_view(program, view);
  const light::LightGrid& grid = volume.grid;
  const Vec3f size = {static_cast<float>(grid.size.x), static_cast<float>(grid.size.y),
                      static_cast<float>(grid.size.z)};
  program.set("box_origin", grid.origin - view.eye);
  program.set("box_size", size * grid.cell);
  program.set("cell", grid.cell);
  program.set("toward_light", light::toward_light(frame.light));
  program.set("key_intensity", frame.light.intensity);
  program.set("ambient_intensity", frame.light.ambient);
  program.set("is_transparent", frame.is_transparent ? 1 : 0);
  bind(gl_, program, 0, GL_TEXTURE_2D, targets.depth.id(), "depth_map");
  bind(gl_, program, 1, GL_TEXTURE_2D, targets.normal_kind.id(), "normal_kind_map");
  bind(gl_, program, 2, GL_TEXTURE_2D, targets.albedo.id(), "albedo_map");
  bind(gl_, program, 3, GL_TEXTURE_3D, body_.id(), "body_volume");
  bind(gl_, program, 4, GL_TEXTURE_3D, light_.id(), "light_volume");
  if (smoke) {
    program.set("samples_per_ray", static_cast<float>(smoke->samples_per_ray));
    program.set("smoke_range", smoke->nearest, smoke->farthest);
    program.set("smoke_spacing", smoke->spacing);
    program.set("is_smoke_colored", smoke->is_colored ? 1 : 0);
    bind(gl_, program, 5, GL_TEXTURE_2D, smoke->sums, "smoke_map");
    bind(gl_, program, 6, GL_TEXTURE_2D, smoke->depth, "smoke_depth_map");
  }
  gl_.BindVertexArray(vertex_array_.id());
  gl_.DrawArrays(GL_TRIANGLES, 0, 3);
}

ResolvePass::ResolvePass(const gl::Gl& gl, const gl::ShaderLibrary& library)
    : gl_(gl),
      mean_program_(gl, library, "fullscreen.vert", "resolve.frag"),
      smooth_program_(gl, library, "fullscreen.vert", "smooth.frag"),
      vertex_array_(gl) {}

void ResolvePass::draw(const gl::Targets& targets) {
  gl::set_flat_state(gl_);
  const gl::Program& program = targets.supersampling > 1 ? mean_program_ : smooth_program_;
  program.use();
  bind(gl_, program, 0, GL_TEXTURE_2D, targets.samples.id(), "samples");
  gl_.BindVertexArray(vertex_array_.id());
  gl_.DrawArrays(GL_TRIANGLES, 0, 3);
}

}  // namespace neve::render::passes

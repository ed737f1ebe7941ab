#pragma once
/// The passes that fill the G-buffer and the one that shades it. Each owns its program and buffers
/// and sets the state it relies on; the caller binds the framebuffer and sets the viewport.

#include "render/gl_objects.h"
#include "render/gl_program.h"
#include "render/lighting.h"
#include "render/targets.h"
#include "render/view.h"

namespace neve::render {

/// Spheres; see shaders/particles.vert.
class ParticlePass {
 public:
  /// @param is_software see list_points
  ParticlePass(const Gl& gl, const ShaderLibrary& library, bool is_software);
  void draw(const Points& points, const View& view);

 private:
  void draw_list(const Program& program, bool as_quads, const Points& points, const View& view,
                 const void* vertices, std::size_t count);
  const Gl& gl_;
  Program point_program_, quad_program_;
  VertexArray vertex_array_;
  Buffer buffer_;
  float max_point_size_ = 1;
  bool is_software_;
};

/// Infinite planes with grid lines; see shaders/ground.frag.
class GroundPass {
 public:
  GroundPass(const Gl& gl, const ShaderLibrary& library);
  /// A plane seen from behind is not drawn.
  void draw(const Frame& frame, const View& view);

 private:
  const Gl& gl_;
  Program program_;
  VertexArray vertex_array_;
};

/// Solid triangles; see shaders/mesh.vert.
class MeshPass {
 public:
  MeshPass(const Gl& gl, const ShaderLibrary& library);
  void draw(const std::vector<TriangleMesh>& meshes, const View& view);

 private:
  const Gl& gl_;
  Program program_;
  VertexArray vertex_array_;
  Buffer vertex_buffer_, index_buffer_;
};

/// Lights the G-buffer; see shaders/shade.frag.
class ShadePass {
 public:
  ShadePass(const Gl& gl, const ShaderLibrary& library);
  void draw(const Targets& targets, const LightVolume& volume, const Light& light,
            const View& view);

 private:
  void upload(const LightVolume& volume);
  const Gl& gl_;
  Program program_;
  VertexArray vertex_array_;
  Texture body_, light_;
};

/// Averages the samples of each pixel; see shaders/resolve.frag.
class ResolvePass {
 public:
  ResolvePass(const Gl& gl, const ShaderLibrary& library);
  void draw(const Targets& targets);

 private:
  const Gl& gl_;
  Program program_;
  VertexArray vertex_array_;
};

}  // namespace neve::render

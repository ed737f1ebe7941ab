#pragma once
/// The passes that fill the G-buffer and the one that shades it. Each owns its program and buffers
/// and sets the state it relies on; the caller binds the framebuffer and sets the viewport.

#include <optional>

#include "render/frame/view.h"
#include "render/gl/gl_objects.h"
#include "render/gl/gl_program.h"
#include "render/gl/targets.h"
#include "render/light/gbuffer_tile.h"
#include "render/light/lighting.h"
#include "render/light/smoke_volume.h"

namespace neve::render::passes {

/// Sets the state for layers over the shaded picture: nearer surfaces hide them, alpha blends them.
void set_blended_state(const gl::Gl& gl);

/// Spheres; see shaders/particles.vert.
class ParticlePass {
 public:
  /// @param is_software see list_points
  ParticlePass(const gl::Gl& gl, const gl::ShaderLibrary& library, bool is_software);
  /// @param pool may be null
  void draw(const Points& points, const View& view, ThreadPool* pool);

 private:
  void draw_list(const gl::Program& program, bool as_quads, const Points& points, const View& view,
                 const void* vertices, std::size_t count);
  const gl::Gl& gl_;
  gl::Program point_program_, quad_program_;
  gl::VertexArray vertex_array_;
  gl::Buffer buffer_;
  float max_point_size_ = 1;
  bool is_software_;
};

/// Samples of finished light that the processor has drawn, tile by tile; see shaders/tiles.frag.
class TilePass {
 public:
  TilePass(const gl::Gl& gl, const gl::ShaderLibrary& library);
  /// @param tiles  row by row from the lower left one @param columns of tiles
  void draw(const light::GBufferTile* tiles, int columns, const View& view);

 private:
  const gl::Gl& gl_;
  gl::Program program_;
  gl::VertexArray vertex_array_;
  gl::Texture normal_inverse_, color_;
  std::vector<float> normals_;  ///< kept, as allocating them costs as much as filling them
  std::vector<std::uint32_t> colors_;
};

/// Infinite planes with grid lines; see shaders/ground.frag.
class GroundPass {
 public:
  GroundPass(const gl::Gl& gl, const gl::ShaderLibrary& library);
  /// A plane seen from behind is not drawn.
  void draw(const Frame& frame, const View& view);
  /// Draws ghosts over the shaded picture.
  void draw_ghosts(const Frame& frame, const View& view);

 private:
  void draw_plane(const gl::Program& program, const GroundPlane& ground, const Frame& frame,
                  const View& view) const;
  const gl::Gl& gl_;
  gl::Program program_, ghost_program_;
  gl::VertexArray vertex_array_;
};

/// Solid triangles; see shaders/mesh.vert.
class MeshPass {
 public:
  MeshPass(const gl::Gl& gl, const gl::ShaderLibrary& library);
  void draw(const std::vector<TriangleMesh>& meshes, const View& view);
  /// Draws ghosts over the shaded picture, the farthest first; see shaders/ghost.frag.
  void draw_ghosts(const std::vector<TriangleMesh>& meshes, Vec3f toward_light, const View& view);

 private:
  void draw_mesh(const gl::Program& program, const TriangleMesh& mesh, const View& view);
  const gl::Gl& gl_;
  gl::Program program_, ghost_program_;
  gl::VertexArray vertex_array_;
  gl::Buffer vertex_buffer_, index_buffer_;
};

/// Smoke as the shading pass lays it over the surfaces.
struct SmokePicture {
  GLuint sums = 0;                  ///< out_sums of shaders/smoke.frag
  GLuint depth = 0;                 ///< m along the view, where each ray ended
  int samples_per_ray = 1;          ///< along each axis
  float nearest = 0, farthest = 0;  ///< m along the view: depths are clamped to these
  float spacing = 1;                ///< m, over which smoke hardly changes
  bool is_colored = false;
};

/// Marches through smoke up to the surfaces; see shaders/smoke.frag.
class SmokePass {
 public:
  SmokePass(const gl::Gl& gl, const gl::ShaderLibrary& library);
  /// Binds a framebuffer of its own.
  /// @param grid of `smoke`, not empty
  /// @return empty if no smoke is in view
  std::optional<SmokePicture> draw(const Smoke& smoke, const light::SmokeGrid& grid,
                                   const light::SmokeVolume& volume, const Light& light,
                                   const gl::Targets& targets, const View& view);

 private:
  void march(const Smoke& smoke, const light::SmokeGrid& grid, const light::SmokeVolume& volume,
             const light::SmokeSpans& spans, const Light& light, const gl::Targets& targets,
             const View& view);
  void prepare_target(int width, int height);
  void upload(const light::SmokeGrid& grid, const light::SmokeVolume& volume,
              const light::SmokeSpans& spans);
  void upload_colormap(const Smoke& smoke);
  const gl::Gl& gl_;
  gl::Program white_program_, value_program_;
  gl::VertexArray vertex_array_;
  gl::Texture volume_, bricks_, spans_, colormap_;
  int width_ = 0, height_ = 0;
  gl::Texture sums_, depth_;
  gl::Framebuffer framebuffer_;
};

/// Lights the G-buffer; see shaders/shade.frag.
class ShadePass {
 public:
  ShadePass(const gl::Gl& gl, const gl::ShaderLibrary& library);
  /// @param smoke null if there is none
  void draw(const gl::Targets& targets, const light::LightVolume& volume, const Frame& frame,
            const View& view, const SmokePicture* smoke);

 private:
  void upload(const light::LightVolume& volume);
  const gl::Gl& gl_;
  gl::Program program_, smoke_program_;
  gl::VertexArray vertex_array_;
  gl::Texture body_, light_;
  std::uint64_t uploaded_ = 0;  ///< serial of the volume in the textures
};

/// Makes pixels of samples: the mean of several, see shaders/resolve.frag, or one with smooth
/// edges, see shaders/smooth.frag.
class ResolvePass {
 public:
  ResolvePass(const gl::Gl& gl, const gl::ShaderLibrary& library);
  void draw(const gl::Targets& targets);

 private:
  const gl::Gl& gl_;
  gl::Program mean_program_, smooth_program_;
  gl::VertexArray vertex_array_;
};

}  // namespace neve::render::passes

#pragma once
/// Passes for fields on planes and for wires. As those of passes.h: each sets the state it relies
/// on.

#include <vector>

#include "render/frame/view.h"
#include "render/gl/gl_objects.h"
#include "render/gl/gl_program.h"
#include "render/gl/targets.h"

namespace neve::render::passes {

/// Round arrows into the G-buffer; see shaders/arrow.vert.
class ArrowPass {
 public:
  ArrowPass(const gl::Gl& gl, const gl::ShaderLibrary& library);
  void draw(const std::vector<Arrows>& arrows, const View& view);

 private:
  const gl::Gl& gl_;
  gl::Program program_;
  gl::VertexArray vertex_array_;
  gl::Buffer buffer_;
};

/// Rectangles of values into the G-buffer; see shaders/heat_map.frag.
class HeatMapPass {
 public:
  HeatMapPass(const gl::Gl& gl, const gl::ShaderLibrary& library);
  /// @param samples per pixel and axis of the finished picture, for the width of isolines
  void draw(const std::vector<HeatMap>& maps, const View& view, float samples);

 private:
  void upload(const HeatMap& map);
  const gl::Gl& gl_;
  gl::Program program_;
  gl::VertexArray vertex_array_;
  gl::Texture values_, colors_;
};

/// Lines over the shaded samples, hidden by the depth of the G-buffer; see shaders/line.vert.
class LinePass {
 public:
  LinePass(const gl::Gl& gl, const gl::ShaderLibrary& library);
  /// @param samples per pixel and axis of the finished picture, for the width of lines
  void draw(const std::vector<Lines>& lines, const gl::Targets& targets, const View& view,
            float samples);

 private:
  const gl::Gl& gl_;
  gl::Program program_;
  gl::VertexArray vertex_array_;
  gl::Buffer buffer_;
};

}  // namespace neve::render::passes

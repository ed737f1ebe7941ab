#pragma once
/// Passes for fields on planes and for wires. As those of passes.h: each sets the state it relies
/// on.

#include <vector>

#include "render/gl_objects.h"
#include "render/gl_program.h"
#include "render/targets.h"
#include "render/view.h"

namespace neve::render {

/// Round arrows into the G-buffer; see shaders/arrow.vert.
class ArrowPass {
 public:
  ArrowPass(const Gl& gl, const ShaderLibrary& library);
  void draw(const std::vector<Arrows>& arrows, const View& view);

 private:
  const Gl& gl_;
  Program program_;
  VertexArray vertex_array_;
  Buffer buffer_;
};

/// Rectangles of values into the G-buffer; see shaders/heat_map.frag.
class HeatMapPass {
 public:
  HeatMapPass(const Gl& gl, const ShaderLibrary& library);
  /// @param samples per pixel and axis of the finished picture, for the width of isolines
  void draw(const std::vector<HeatMap>& maps, const View& view, float samples);

 private:
  void upload(const HeatMap& map);
  const Gl& gl_;
  Program program_;
  VertexArray vertex_array_;
  Texture values_, colors_;
};

/// Lines over the shaded samples, hidden by the depth of the G-buffer; see shaders/line.vert.
class LinePass {
 public:
  LinePass(const Gl& gl, const ShaderLibrary& library);
  /// @param samples per pixel and axis of the finished picture, for the width of lines
  void draw(const std::vector<Lines>& lines, const Targets& targets, const View& view,
            float samples);

 private:
  const Gl& gl_;
  Program program_;
  VertexArray vertex_array_;
  Buffer buffer_;
};

}  // namespace neve::render

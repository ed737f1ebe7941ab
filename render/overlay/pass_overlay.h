#pragma once
/// Text and signs over the finished picture: caption in the upper left corner, legends one above
/// the other in the lower right one, labels beside their places, rings around marked ones, plots in
/// the lower left one, a footnote beside them; patches and notes wherever they say.

#include "render/frame/frame.h"
#include "render/frame/view.h"
#include "render/overlay/imgui_draw.h"

namespace neve::render::overlay {

class OverlayPass {
 public:
  OverlayPass(const gl::Gl& gl, const gl::ShaderLibrary& library) : imgui_(gl, library) {}
  /// @param view of the finished picture, not of its samples
  void draw(const Frame& frame, const View& view);

 private:
  /// Legends leave this room to what is beside them, pixels.
  struct Limits {
    float caption;     ///< right edge of text in the upper third
    float below;       ///< right edge of plots and text at the bottom
    float legend_top;  ///< of the highest title
  };
  Limits draw_legends(const Frame& frame) const;
  void draw_caption(const Frame& frame, const Limits& limits) const;
  void draw_footnote(const Frame& frame, float left, float right) const;
  void draw_scale_bar(const ScaleBar& bar, float left, float right, float bottom) const;
  void draw_labels(const Frame& frame, const View& view, const Limits& limits) const;
  void draw_notes(const Frame& frame) const;
  void draw_edge_words(const Frame& frame) const;
  void draw_marks(const Frame& frame, const View& view) const;

  ImGuiDraw imgui_;
};

}  // namespace neve::render::overlay

#pragma once
/// Plots drawn with ImGui: those of a frame in the lower left corner, others in a window.

#include <imgui.h>

#include "render/frame/frame.h"
#include "render/overlay/plot_canvas.h"

namespace neve::render::overlay {

class ImGuiCanvas : public PlotCanvas {
 public:
  ImGuiCanvas(const ImFont& font, ImDrawList& list)
      : PlotCanvas(font.FontSize), font_(font), list_(list) {}

  float text_width(const std::string& text) const override;
  std::string fitting(const std::string& text, float width) const override;
  void text(Place at, Note::Anchor anchor, Rgba color, const std::string& text) override;
  void rectangle(Place low, Place high, Rgba color) override;
  void curve(std::span<const Place> points, Rgba color, float width) override;
  void circle(Place center, float radius, Rgba color, float line, const std::string&) override;
  void clip(Place low, Place high) override;
  void unclip() override { list_.PopClipRect(); }

 private:
  const ImFont& font_;
  ImDrawList& list_;
};

/// One below the other over a common time axis. A picture too small for all of them shows the
/// first ones. To be called between ImGuiDraw::begin and end.
/// @param right_limit pixels; where something else begins
/// @return right edge of the drawing, pixels; 0: nothing drawn
float draw_plots(const Frame& frame, const ImFont& font, float right_limit);

}  // namespace neve::render::overlay

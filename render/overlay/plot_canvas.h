#pragma once
/// Plots, drawn alike on every canvas: a picture, a window, an SVG file.

#include <array>
#include <cstdint>
#include <span>
#include <string>

#include "render/frame/frame.h"

namespace neve::render::overlay {

struct Place {
  float x = 0, y = 0;  ///< px, y down
};
using Rgba = std::array<std::uint8_t, 4>;  ///< sRGB and opacity

/// Draws plots.
class PlotCanvas {
 public:
  explicit PlotCanvas(float height_of_text) : text_size(height_of_text) {}
  virtual ~PlotCanvas() = default;

  const float text_size;  ///< px, height of a line; all distances are in proportion to it
  virtual float text_width(const std::string& text) const = 0;
  /// The text, or as much of its beginning as fits with an ellipsis.
  virtual std::string fitting(const std::string& text, float) const { return text; }
  /// @param at  upper edge of the text, and its left end, middle or right end
  virtual void text(Place at, Note::Anchor anchor, Rgba color, const std::string& text) = 0;
  virtual void rectangle(Place low, Place high, Rgba color) = 0;
  virtual void curve(std::span<const Place> points, Rgba color, float width) = 0;
  /// @param line  its width; 0: a filled circle
  /// @param note  shown where a mouse points at it, if the canvas can
  virtual void circle(Place center, float radius, Rgba color, float line,
                      const std::string& note) = 0;
  /// Drawings between clip() and unclip() show inside the rectangle only.
  virtual void clip(Place low, Place high) = 0;
  virtual void unclip() = 0;
};

/// The rectangle of a plot without its words, px.
struct PlotPanel {
  float left, right, top, bottom;
};

/// Words around the panel of a plot.
struct PlotWords {
  bool has_title = true;   ///< above, with the names of the series
  bool has_values = true;  ///< at the left
  bool has_x = true;       ///< below
};

void draw_plot(const Plot& plot, const PlotPanel& panel, PlotWords words, PlotCanvas& canvas);

}  // namespace neve::render::overlay

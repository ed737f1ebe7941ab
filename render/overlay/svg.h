#pragma once
/// Drawings and plots as SVG.

#include <string>

#include "render/overlay/plot_canvas.h"

namespace neve::render::overlay {

/// "&lt;" and so on.
std::string xml_text(const std::string& text);

/// Coordinates in pixels have one decimal.
std::string svg_number(double x, int digits = 1);

/// @param anchor  start, middle or end of the text lies at the place, which is on its base line
/// @param look    further attributes, with a blank before each
std::string svg_text(double x, double y, const char* anchor, const std::string& look,
                     const std::string& text);

/// @param background   a colour; "": none
/// @param is_document  with the XML head of a file of its own
std::string svg_drawing(double width, double height, const std::string& background,
                        const std::string& body, bool is_document);

/// Writes plots as SVG, in the colours that they have over a picture.
class SvgCanvas : public PlotCanvas {
 public:
  using PlotCanvas::PlotCanvas;
  /// Returns the width of digits; words are about as wide.
  float text_width(const std::string& text) const override;
  void text(Place at, Note::Anchor anchor, Rgba color, const std::string& text) override;
  void rectangle(Place low, Place high, Rgba color) override;
  void curve(std::span<const Place> points, Rgba color, float width) override;
  void circle(Place center, float radius, Rgba color, float line, const std::string& note) override;
  void clip(Place low, Place high) override;
  void unclip() override { body_ += "</svg>\n"; }

  /// Returns the drawing so far, on a dark ground.
  std::string drawing(double width, double height, bool is_document) const;

 private:
  std::string body_;
};

}  // namespace neve::render::overlay

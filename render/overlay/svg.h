#pragma once
/// Drawings and plots as SVG.

#include <string>

#include "render/overlay/plot_canvas.h"

namespace neve::render::overlay {

/// "&lt;" and so on.
std::string xml_text(const std::string& text);

/// Coordinates in pixels, with one decimal.
std::string svg_number(double x);

/// @param anchor  start, middle or end of the text lies at the place, which is on its base line
/// @param kind    classes of the style sheet
std::string svg_text(double x, double y, const char* anchor, const char* kind,
                     const std::string& text);

/// @param background    a colour; "": none
/// @param is_document  with the XML head of a file of its own
std::string svg_drawing(double width, double height, const std::string& background,
                        const std::string& body, bool is_document);

/// Writes plots as SVG, in the colours that they have over a picture.
class SvgCanvas : public PlotCanvas {
 public:
  explicit SvgCanvas(float font_size) : size_(font_size) {}

  float font_size() const override { return size_; }
  /// That of digits; words are about as wide.
  float text_width(const std::string& text) const override;
  std::string fitting(const std::string& text, float) const override { return text; }
  void text(Place at, Note::Anchor anchor, Rgba color, const std::string& text) override;
  void rectangle(Place low, Place high, Rgba color) override;
  void curve(std::span<const Place> points, Rgba color, float width) override;
  void disc(Place center, float radius, Rgba color, const std::string& note) override;
  void ring(Place center, float radius, Rgba color, float width, const std::string& note) override;
  void clip(Place low, Place high) override;
  void unclip() override { body_ += "</svg>\n"; }

  /// What was drawn, on a dark ground.
  std::string drawing(double width, double height, bool is_document) const;

 private:
  const float size_;
  std::string body_;
};

}  // namespace neve::render::overlay

#include "render/overlay/svg.h"

#include <algorithm>
#include <charconv>

namespace neve::render::overlay {
namespace {

/// Over the size of a font: the height of its lines, how far down their base line is, and the width
/// of a digit, all of DejaVu Sans as ImGui sets it.
constexpr float line_height = 1.164f, base_line = 0.928f, digit_width = 0.636f;

std::string number(float x, int digits) {
  char text[64];
  const auto end = std::to_chars(text, text + sizeof text, x, std::chars_format::fixed, digits).ptr;
  return {text, end};
}

std::string place(const char* x, const char* y, Place at) {
  return std::string(" ") + x + "=\"" + svg_number(at.x) + "\" " + y + "=\"" + svg_number(at.y) +
         "\"";
}

std::string box(Place low, Place high) {
  return place("x", "y", low) + place("width", "height", {high.x - low.x, high.y - low.y});
}

std::string paint(const char* what, Rgba color) {
  std::string text = std::string(" ") + what + "=\"rgb(" + std::to_string(color[0]) + "," +
                     std::to_string(color[1]) + "," + std::to_string(color[2]) + ")\"";
  if (color[3] < 255)
    text += std::string(" ") + what + "-opacity=\"" + number(color[3] / 255.0f, 2) + "\"";
  return text;
}

std::string circle(Place center, float radius, const std::string& look, const std::string& note) {
  return "<circle" + place("cx", "cy", center) + " r=\"" + svg_number(radius) + "\"" + look +
         (note.empty() ? "/>\n" : "><title>" + xml_text(note) + "</title></circle>\n");
}

}  // namespace

std::string xml_text(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '<')
      out += "&lt;";
    else if (c == '>')
      out += "&gt;";
    else if (c == '&')
      out += "&amp;";
    else if (c == '"')
      out += "&quot;";
    else
      out += c;
  }
  return out;
}

std::string svg_number(double x) {
  return number(static_cast<float>(x), 1);
}

std::string svg_text(double x, double y, const char* anchor, const char* kind,
                     const std::string& text) {
  return "<text x=\"" + svg_number(x) + "\" y=\"" + svg_number(y) + "\" text-anchor=\"" + anchor +
         "\" class=\"" + kind + "\">" + xml_text(text) + "</text>\n";
}

std::string svg_drawing(double width, double height, const std::string& background,
                        const std::string& body, bool is_document) {
  const std::string w = svg_number(width), h = svg_number(height);
  std::string svg = is_document ? "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n" : "";
  svg += "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" + w + "\" height=\"" + h +
         "\" viewBox=\"0 0 " + w + " " + h + "\">\n";
  if (!background.empty())
    svg += "<rect width=\"100%\" height=\"100%\" fill=\"" + background + "\"/>\n";
  return svg + body + "</svg>\n";
}

float SvgCanvas::text_width(const std::string& text) const {
  const auto letters = std::count_if(text.begin(), text.end(),
                                     [](char c) { return (c & 0xc0) != 0x80; });  // of UTF-8
  return static_cast<float>(letters) * digit_width / line_height * size_;
}

void SvgCanvas::text(Place at, Note::Anchor anchor, Rgba color, const std::string& text) {
  constexpr const char* anchors[] = {"start", "middle", "end"};
  const Place line{at.x, at.y + base_line / line_height * size_};
  body_ += "<text" + place("x", "y", line) + " text-anchor=\"" + anchors[static_cast<int>(anchor)] +
           "\"" + paint("fill", color) + ">" + xml_text(text) + "</text>\n";
}

void SvgCanvas::rectangle(Place low, Place high, Rgba color) {
  // Neighbours touch without a seam, at any scale.
  body_ += "<rect shape-rendering=\"crispEdges\"" + box(low, high) + paint("fill", color) + "/>\n";
}

void SvgCanvas::curve(std::span<const Place> points, Rgba color, float width) {
  body_ += "<polyline fill=\"none\"" + paint("stroke", color) + " stroke-width=\"" +
           svg_number(width) + "\" points=\"";
  for (const Place at : points) body_ += svg_number(at.x) + "," + svg_number(at.y) + " ";
  body_ += "\"/>\n";
}

void SvgCanvas::disc(Place center, float radius, Rgba color, const std::string& note) {
  body_ += circle(center, radius, paint("fill", color), note);
}

void SvgCanvas::ring(Place center, float radius, Rgba color, float width, const std::string& note) {
  body_ += circle(
      center, radius,
      " fill=\"none\"" + paint("stroke", color) + " stroke-width=\"" + svg_number(width) + "\"",
      note);
}

/// An inner drawing hides what is outside it.
void SvgCanvas::clip(Place low, Place high) {
  body_ += "<svg" + box(low, high) + " viewBox=\"" + svg_number(low.x) + " " + svg_number(low.y) +
           " " + svg_number(high.x - low.x) + " " + svg_number(high.y - low.y) + "\">\n";
}

std::string SvgCanvas::drawing(double width, double height, bool is_document) const {
  const std::string group = "<g font-family=\"DejaVu Sans, Verdana, sans-serif\" font-size=\"" +
                            svg_number(size_ / line_height) + "\">\n";
  return svg_drawing(width, height, "#1b2029", group + body_ + "</g>\n", is_document);
}

}  // namespace neve::render::overlay

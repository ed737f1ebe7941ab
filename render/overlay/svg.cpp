#include "render/overlay/svg.h"

#include <algorithm>
#include <charconv>

namespace neve::render::overlay {
namespace {

/// Measures of DejaVu Sans as ImGui sets it, over the size of the font: the height of a line, its
/// base line from above, and the width of a digit.
constexpr float line_height = 1.164f, base_line = 0.928f, digit_width = 0.636f;

/// " NAME="3.0"": an attribute.
std::string with(const char* name, double x, int digits = 1) {
  return std::string(" ") + name + "=\"" + svg_number(x, digits) + "\"";
}

std::string box(Place low, Place high) {
  return with("x", low.x) + with("y", low.y) + with("width", high.x - low.x) +
         with("height", high.y - low.y);
}

std::string paint(const char* what, Rgba color) {
  constexpr const char* digits = "0123456789abcdef";
  std::string text = std::string(" ") + what + "=\"#";
  for (const std::size_t k : {0u, 1u, 2u}) (text += digits[color[k] >> 4]) += digits[color[k] & 15];
  text += "\"";
  return color[3] == 255
             ? text
             : text + with((what + std::string("-opacity")).c_str(), color[3] / 255.0, 2);
}

}  // namespace

std::string xml_text(const std::string& text) {
  std::string out;
  for (const char c : text)
    out += c >= 0 && c < ' ' ? " "  // XML has no controls
           : c == '<'        ? "&lt;"
           : c == '>'        ? "&gt;"
           : c == '&'        ? "&amp;"
           : c == '"'        ? "&quot;"
                             : std::string(1, c);
  return out;
}

std::string svg_number(double x, int digits) {
  char text[400];
  return {text, std::to_chars(text, text + sizeof text, x, std::chars_format::fixed, digits).ptr};
}

std::string svg_text(double x, double y, const char* anchor, const std::string& look,
                     const std::string& text) {
  return "<text" + with("x", x) + with("y", y) + " text-anchor=\"" + anchor + "\"" + look + ">" +
         xml_text(text) + "</text>\n";
}

std::string svg_drawing(double width, double height, const std::string& background,
                        const std::string& body, bool is_document) {
  std::string svg = is_document ? "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n" : "";
  svg += "<svg xmlns=\"http://www.w3.org/2000/svg\"" + with("width", width) +
         with("height", height) + " viewBox=\"0 0 " + svg_number(width) + " " + svg_number(height) +
         "\">\n";
  if (!background.empty())
    svg += "<rect width=\"100%\" height=\"100%\" fill=\"" + background + "\"/>\n";
  return svg + body + "</svg>\n";
}

float SvgCanvas::text_width(const std::string& text) const {
  const auto letters = std::count_if(text.begin(), text.end(),
                                     [](char c) { return (c & 0xc0) != 0x80; });  // of UTF-8
  return static_cast<float>(letters) * digit_width / line_height * text_size;
}

void SvgCanvas::text(Place at, Note::Anchor anchor, Rgba color, const std::string& text) {
  constexpr const char* anchors[] = {"start", "middle", "end"};
  body_ += svg_text(at.x, at.y + base_line / line_height * text_size,
                    anchors[static_cast<int>(anchor)], paint("fill", color), text);
}

void SvgCanvas::rectangle(Place low, Place high, Rgba color) {
  // Neighbours touch without a seam, at any scale.
  body_ += "<rect shape-rendering=\"crispEdges\"" + box(low, high) + paint("fill", color) + "/>\n";
}

void SvgCanvas::curve(std::span<const Place> points, Rgba color, float width) {
  body_ += "<polyline fill=\"none\"" + paint("stroke", color) + with("stroke-width", width) +
           " points=\"";
  for (const Place at : points) body_ += svg_number(at.x) + "," + svg_number(at.y) + " ";
  body_ += "\"/>\n";
}

void SvgCanvas::circle(Place center, float radius, Rgba color, float line,
                       const std::string& note) {
  body_ += "<circle" + with("cx", center.x) + with("cy", center.y) + with("r", radius);
  body_ += line > 0 ? " fill=\"none\"" + paint("stroke", color) + with("stroke-width", line)
                    : paint("fill", color);
  body_ += note.empty() ? "/>\n" : "><title>" + xml_text(note) + "</title></circle>\n";
}

/// An inner drawing hides what is outside it.
void SvgCanvas::clip(Place low, Place high) {
  body_ += "<svg" + box(low, high) + " viewBox=\"" + svg_number(low.x) + " " + svg_number(low.y) +
           " " + svg_number(high.x - low.x) + " " + svg_number(high.y - low.y) + "\">\n";
}

std::string SvgCanvas::drawing(double width, double height, bool is_document) const {
  return svg_drawing(width, height, "#1b2029",
                     "<g font-family=\"DejaVu Sans, Verdana, sans-serif\"" +
                         with("font-size", text_size / line_height) + ">\n" + body_ + "</g>\n",
                     is_document);
}

}  // namespace neve::render::overlay

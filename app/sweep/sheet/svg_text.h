#pragma once
/// Text of drawings and pages.

#include <string>

namespace neve::app::sweep::sheet {

/// "&lt;" and so on.
std::string xml_text(const std::string& text);

/// Coordinates in pixels, with one decimal.
std::string svg_number(double x);

/// @param anchor  start, middle or end of the text lies at the place
/// @param kind    classes of the style sheet
std::string svg_text(double x, double y, const char* anchor, const char* kind,
                     const std::string& text);

}  // namespace neve::app::sweep::sheet

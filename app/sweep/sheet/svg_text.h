#pragma once
/// Text of drawings and pages.

#include <string>

namespace neve::app::sweep::sheet {

/// "&lt;" and so on.
std::string xml_text(const std::string& text);

/// Coordinates in pixels, with one decimal.
std::string svg_number(double x);

}  // namespace neve::app::sweep::sheet

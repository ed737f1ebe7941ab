#include "app/sweep/sheet/svg_text.h"

#include "app/support/text.h"

namespace neve::app::sweep::sheet {

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
  return fixed_text(x, 1);
}

std::string svg_text(double x, double y, const char* anchor, const char* kind,
                     const std::string& text) {
  return "<text x=\"" + svg_number(x) + "\" y=\"" + svg_number(y) + "\" text-anchor=\"" + anchor +
         "\" class=\"" + kind + "\">" + xml_text(text) + "</text>\n";
}

}  // namespace neve::app::sweep::sheet

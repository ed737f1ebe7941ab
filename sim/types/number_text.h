#pragma once
/// Numbers in sentences, the same in every locale.

#include <locale>
#include <sstream>
#include <string>

namespace neve::sim {

/// Writes a number with so many significant digits.
inline std::string number_text(double x, int digits = 3) {
  std::ostringstream out;
  out.imbue(std::locale::classic());
  out.precision(digits);
  out << x;
  return out.str();
}

}  // namespace neve::sim

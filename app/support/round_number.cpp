#include "app/support/round_number.h"

#include <cmath>
#include <initializer_list>

namespace neve::app {

double round_up(double x) {
  if (!(x > 0) || !std::isfinite(x)) return 0;
  const double power = std::pow(10.0, std::floor(std::log10(x)));
  // The step may be slightly less than x, so that 3 stays 3 after rounding of the power.
  for (const double step : {1.0, 1.2, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0})
    if (step * power >= x * (1 - 1e-9)) return step * power;
  return 10 * power;
}

double round_down(double x) {
  if (!(x > 0) || !std::isfinite(x)) return 0;
  const double power = std::pow(10.0, std::floor(std::log10(x)));
  for (const double step : {5.0, 2.0})
    if (step * power <= x * (1 + 1e-9)) return step * power;
  return power;
}

double round_to(double x, double scale, int digits) {
  if (!(scale > 0) || !std::isfinite(x)) return x;
  const int places = digits - 1 - static_cast<int>(std::floor(std::log10(scale)));
  // Dividing by a power of ten gives the double nearest to the decimal number; multiplying by its
  // inverse does not.
  const double power = std::pow(10.0, std::abs(places));
  // Adding 0 turns -0 into 0.
  return 0.0 + (places >= 0 ? std::round(x * power) / power : std::round(x / power) * power);
}

}  // namespace neve::app

#include "app/support/film_rate.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "app/support/text.h"

namespace neve::app {

namespace {

constexpr int whole_rates[] = {24, 30, 48, 60, 120};

double slowed(int n) {
  return n * 1000.0 / 1001;
}

}  // namespace

double exact_rate(double fps) {
  for (const int n : whole_rates)
    for (const double places : {100.0, 1000.0})
      if (std::abs(fps - std::round(slowed(n) * places) / places) < 1e-9) return slowed(n);
  return fps;
}

std::string plain_rate(double fps) {
  const double rounded = std::round(1000 * fps) / 1000;
  char buffer[64];
  const auto end = std::to_chars(buffer, buffer + sizeof buffer, rounded > 0 ? rounded : fps);
  return {buffer, end.ptr};
}

std::string time_text(double seconds, double fps) {
  constexpr int usual = 3;
  return fixed_text(seconds, std::max(usual, static_cast<int>(std::ceil(std::log10(fps))))) + " s";
}

std::string rate_text(double fps) {
  for (const int n : whole_rates)
    if (std::abs(fps - slowed(n)) < 1e-9) return std::to_string(n * 1000) + "/1001";
  char buffer[64];
  const auto end = std::to_chars(buffer, buffer + sizeof buffer, fps, std::chars_format::fixed);
  return {buffer, end.ptr};
}

}  // namespace neve::app

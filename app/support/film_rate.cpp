#include "app/support/film_rate.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>

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

namespace {

/// Frames that a second of the code has: 24 of 23.976; 0: no code has that rate.
long frames_a_second(double fps) {
  constexpr double near = 1e-9, most = 120;
  const double rate = exact_rate(fps);
  for (const double whole : {rate, rate * 1.001})
    if (whole > 0.5 && whole <= most && std::abs(whole - std::round(whole)) < near)
      return std::lround(whole);
  return 0;
}

/// Numbers that a minute leaves out; 0 where nothing may be dropped.
long dropped_a_minute(double fps) {
  const long nominal = frames_a_second(fps);
  const bool is_slowed = std::abs(exact_rate(fps) - static_cast<double>(nominal)) > 1e-6;
  return is_slowed && (nominal == 30 || nominal == 60) ? nominal / 15 : 0;
}

}  // namespace

bool drops_numbers(const std::string& time_code) {
  return time_code.find(';') != std::string::npos;
}

std::optional<long> frames_of_time_code(const std::string& text, double fps) {
  const long nominal = frames_a_second(fps);
  std::array<int, 4> part{};
  char separator = 0;
  int end = 0;
  if (std::sscanf(text.c_str(), "%2d:%2d:%2d%c%3d%n", &part[0], &part[1], &part[2], &separator,
                  &part[3], &end) != 5 ||
      static_cast<std::size_t>(end) != text.size() || (separator != ':' && separator != ';'))
    return std::nullopt;
  for (const int value : part)
    if (value < 0) return std::nullopt;
  const auto [hours, minutes, seconds, frames] = part;
  const long dropped = separator == ';' ? dropped_a_minute(fps) : 0;
  if (hours > 23 || minutes > 59 || seconds > 59 || frames >= nominal ||
      (separator == ';' && dropped == 0))
    return std::nullopt;
  // Numbers that are left out name no frame.
  if (frames < dropped && seconds == 0 && minutes % 10 != 0) return std::nullopt;
  const long all_minutes = 60L * hours + minutes;
  return (60 * all_minutes + seconds) * nominal + frames -
         dropped * (all_minutes - all_minutes / 10);
}

std::string time_code_text(long frames, double fps, bool drops) {
  const long nominal = frames_a_second(fps);
  if (nominal == 0) return {};
  const long dropped = drops ? dropped_a_minute(fps) : 0;
  const long ten_minutes = 600 * nominal - 9 * dropped, day = 144 * ten_minutes;
  long number = (frames % day + day) % day;
  if (dropped > 0) {
    const long tens = number / ten_minutes, rest = number % ten_minutes;
    const long minute = 60 * nominal - dropped;
    // The first minute of ten is whole.
    const long minutes = rest < 60 * nominal ? 0 : 1 + (rest - 60 * nominal) / minute;
    number += dropped * (9 * tens + minutes);
  }
  const char* const between = dropped > 0 ? ";" : ":";
  return fmt::format("{:02}:{:02}:{:02}{}{:02}", number / (3600 * nominal),
                     number / (60 * nominal) % 60, number / nominal % 60, between,
                     number % nominal);
}

}  // namespace neve::app

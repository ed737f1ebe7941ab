#pragma once
/// Values that a parameter may take, and when a change takes effect.

#include <limits>
#include <string>

namespace neve::app::scene {

/// live: may change while a simulation runs; restart: only from frame 0.
enum class Change { live, restart };

/// Numbers (of vectors: every component) between two bounds, each open or closed.
struct Valid {
  enum class Text { any, name, file, numbered_files };

  bool is_path() const { return text == Text::file || text == Text::numbered_files; }

  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  bool is_min_open = false, is_max_open = false;
  Text text = Text::any;
  double min_above_0 = 0;    ///< 0 is allowed, values between 0 and this are not
  bool is_required = false;  ///< a scene has to give it: there is no default

  constexpr Valid below(double x) const { return {min, x, is_min_open, true, text}; }
  constexpr Valid at_most(double x) const { return {min, x, is_min_open, false, text}; }
  constexpr Valid at_most_or_0(double x) const { return {0, x, false, false, text, min}; }

  constexpr Valid required() const {
    Valid valid = *this;
    valid.is_required = true;
    return valid;
  }

  /// False for NaN and infinities as well.
  bool contains(double x) const;
  /// "0 <= value < 0.5"
  std::string text_of_bounds() const;
  /// Advises on a number outside of the bounds that may be per cent: "As a share of 1 it is 0.2"
  /// for 20. Returns "" if the share is outside too.
  std::string advice_on(double x) const;
};

inline constexpr Valid anything{};
inline constexpr Valid identifier{.text = Valid::Text::name};  ///< [A-Za-z0-9_-]+
inline constexpr Valid file_path{.text = Valid::Text::file};   ///< of a file that exists
/// Stands for files: their name has %d or %04d in place of a number.
inline constexpr Valid file_pattern{.text = Valid::Text::numbered_files};

constexpr Valid above(double x) {
  return Valid{.min = x, .is_min_open = true};
}
constexpr Valid at_least(double x) {
  return Valid{.min = x};
}
constexpr Valid between(double low, double high) {
  return Valid{.min = low, .max = high};
}
constexpr Valid within(double x) {
  return between(-x, x);
}

/// True if `text` can name a body, material, collider or view.
bool is_identifier(const std::string& text);

}  // namespace neve::app::scene

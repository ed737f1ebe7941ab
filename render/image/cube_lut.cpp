#include "render/image/cube_lut.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "sim/base/byte_order_mark.h"

namespace neve::render {
namespace {

using Colour = std::array<float, 3>;

constexpr std::string_view blanks = " \t\r\f\v";
constexpr int max_size_1d = 65536, max_size_3d = 256;

/// Removes the first word of a line. @return "" at its end
std::string_view next_word(std::string_view& line) {
  line.remove_prefix(std::min(line.find_first_not_of(blanks), line.size()));
  const std::string_view word = line.substr(0, line.find_first_of(blanks));
  line.remove_prefix(word.size());
  return word;
}

class CubeReader {
 public:
  CubeReader(std::string_view text, const std::string& name)
      : text_(without_mark(text)), name_(name) {}

  CubeLut read() {
    while (!text_.empty()) {
      const std::size_t end = std::min(text_.find('\n'), text_.size());
      ++line_;
      read_line(text_.substr(0, end));
      text_.remove_prefix(std::min(end + 1, text_.size()));
    }
    if (lut_.size == 0) fail("it says neither LUT_1D_SIZE nor LUT_3D_SIZE; expected a .cube file");
    if (lut_.entries.size() != count())
      fail("it has " + std::to_string(lut_.entries.size()) + " entries; expected " +
           std::to_string(count()));
    return std::move(lut_);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw ImageError(name_ + ":" + std::to_string(line_) + ": " + what);
  }

  std::size_t count() const {
    const auto n = static_cast<std::size_t>(lut_.size);
    return lut_.is_3d ? n * n * n : n;
  }

  template <class Number>
  Number number(std::string_view word) const {
    Number value{};
    if (word.starts_with('+')) word.remove_prefix(1);
    const auto [stop, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc{} || stop != word.data() + word.size() ||
        !std::isfinite(static_cast<double>(value)))
      fail("\"" + std::string(word.substr(0, 40)) + "\" is not a number");
    return value;
  }

  void read_line(std::string_view line) {
    const std::string_view all = line, word = next_word(line);
    if (word.empty() || word.front() == '#' || word == "TITLE") return;
    if (word == "LUT_1D_SIZE" || word == "LUT_3D_SIZE") return read_size(word, next_word(line));
    if (word == "DOMAIN_MIN") return read_colour(line, lut_.low);
    if (word == "DOMAIN_MAX") return read_colour(line, lut_.high);
    if (word == "LUT_1D_INPUT_RANGE" || word == "LUT_3D_INPUT_RANGE") {
      lut_.low.fill(number<float>(next_word(line)));
      lut_.high.fill(number<float>(next_word(line)));
      return;
    }
    if (lut_.size == 0) fail("an entry before LUT_1D_SIZE or LUT_3D_SIZE");
    if (lut_.entries.size() == count())
      fail("more entries than the " + std::to_string(count()) + " of its size");
    std::string_view rest = all;
    read_colour(rest, lut_.entries.emplace_back());
  }

  void read_size(std::string_view word, std::string_view size) {
    if (lut_.size > 0) fail("a second size; one table is read");
    lut_.is_3d = word == "LUT_3D_SIZE";
    const int most = lut_.is_3d ? max_size_3d : max_size_1d;
    lut_.size = number<int>(size);
    if (lut_.size < 2 || lut_.size > most)
      fail(std::string(word) + " " + std::string(size) + "; expected 2 to " + std::to_string(most));
  }

  void read_colour(std::string_view& line, Colour& colour) const {
    for (float& value : colour) value = number<float>(next_word(line));
  }

  std::string_view text_;
  const std::string& name_;
  std::size_t line_ = 0;
  CubeLut lut_;
};

/// Place of a value among the entries of an axis: the one before, and the way to the next.
struct Place {
  std::size_t first;
  float part;
};

Place place_of(const CubeLut& lut, std::size_t axis, float value) {
  const float last = static_cast<float>(lut.size - 1), span = lut.high[axis] - lut.low[axis];
  const float at = std::clamp(span != 0 ? (value - lut.low[axis]) / span * last : 0.0f, 0.0f, last);
  const float first = std::min(std::floor(at), last - 1);
  return {static_cast<std::size_t>(first), at - first};
}

Colour look_up(const CubeLut& lut, const Colour& from) {
  const std::array places{place_of(lut, 0, from[0]), place_of(lut, 1, from[1]),
                          place_of(lut, 2, from[2])};
  Colour to{0, 0, 0};
  if (!lut.is_3d) {
    for (std::size_t c = 0; c < 3; ++c) {
      const auto& [first, part] = places[c];
      to[c] = (1 - part) * lut.entries[first][c] + part * lut.entries[first + 1][c];
    }
    return to;
  }
  const auto n = static_cast<std::size_t>(lut.size);
  for (std::size_t corner = 0; corner < 8; ++corner) {
    float weight = 1;
    std::size_t index = 0;
    for (std::size_t axis = 3; axis-- > 0;) {
      const bool is_next = (corner >> axis & 1) != 0;
      weight *= is_next ? places[axis].part : 1 - places[axis].part;
      index = index * n + places[axis].first + (is_next ? 1 : 0);
    }
    for (std::size_t c = 0; c < 3; ++c) to[c] += weight * lut.entries[index][c];
  }
  return to;
}

}  // namespace

CubeLut parse_cube(std::string_view text, const std::string& name) {
  return CubeReader(text, name).read();
}

void apply(const CubeLut& lut, Image& image) {
  if (image.channels < 3) return;
  const auto stride = static_cast<std::size_t>(image.channels);
  for (std::size_t i = 0; i < image.pixels.size(); i += stride) {
    const Colour to = look_up(lut, {static_cast<float>(image.pixels[i]) / 255,
                                    static_cast<float>(image.pixels[i + 1]) / 255,
                                    static_cast<float>(image.pixels[i + 2]) / 255});
    for (std::size_t c = 0; c < 3; ++c)
      image.pixels[i + c] =
          static_cast<std::uint8_t>(std::lround(255 * std::clamp(to[c], 0.0f, 1.0f)));
  }
}

}  // namespace neve::render

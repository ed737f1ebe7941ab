// An own reader rather than GDAL (Debian: libgdal-dev), which is 106 packages and 363 MB for two
// hundred lines.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "sim/files/height_grid.h"
#include "sim/files/height_reader.h"
#include "sim/files/input_file.h"
#include "sim/types/number_text.h"

namespace neve::sim::files {
namespace {

/// Counts of any size that a file may name.
std::string whole_text(double count) {
  return number_text(count, 15);
}

/// Sets heights relative to their middle: single precision tells heights apart on any mountain.
/// @param heights  m; NaN: there is no data
/// @throws ShapeError where no post has data
void set_heights(const std::vector<double>& heights, const std::string& name, HeightGrid& grid) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const double h : heights) {
    // NaN is neither.
    if (h < low) low = h;
    if (h > high) high = h;
  }
  if (!(low <= high)) refuse_input(name, "no post of the height field has data");
  grid.datum = std::round(0.5 * (low + high));
  grid.lowest = low - grid.datum;
  grid.highest = high - grid.datum;
  grid.height.resize(heights.size());
  std::ranges::transform(heights, grid.height.begin(),
                         [&](double h) { return static_cast<float>(h - grid.datum); });
}

class AsciiGrid {
 public:
  AsciiGrid(std::string_view text, const std::string& name)
      : rest_(plain_text(text, name)), name_(name) {}

  HeightGrid read() {
    read_header();
    HeightGrid grid;
    grid.columns = static_cast<std::size_t>(count("ncols", value(ncols)));
    grid.rows = static_cast<std::size_t>(count("nrows", value(nrows)));
    set_place(grid);
    const std::vector<double> heights = read_heights(grid);
    set_heights(heights, name_, grid);
    return grid;
  }

 private:
  enum Key {
    ncols,
    nrows,
    xllcorner,
    xllcenter,
    yllcorner,
    yllcenter,
    cellsize,
    nodata,
    key_count
  };
  static constexpr std::array<const char*, key_count> keys = {
      "ncols",     "nrows",     "xllcorner", "xllcenter",
      "yllcorner", "yllcenter", "cellsize",  "nodata_value"};
  struct Entry {
    double value;
    std::size_t line;
  };

  [[noreturn]] void refuse(std::size_t line, const std::string& what) const {
    refuse_input(name_ + ":" + std::to_string(line), what);
  }

  void skip_blanks() {
    std::size_t at = 0;
    for (; at < rest_.size() && (is_blank(rest_[at]) || rest_[at] == '\n'); ++at)
      line_ += rest_[at] == '\n';
    rest_.remove_prefix(at);
  }

  /// The next word, "" at the end.
  std::string_view peek() {
    skip_blanks();
    std::size_t end = 0;
    while (end < rest_.size() && !is_blank(rest_[end]) && rest_[end] != '\n') ++end;
    return rest_.substr(0, end);
  }

  std::string_view next() {
    const std::string_view word = peek();
    rest_.remove_prefix(word.size());
    return word;
  }

  static std::optional<Key> key_of(std::string_view word) {
    std::string lower(word.substr(0, 20));
    for (char& c : lower)
      if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    const auto found = std::ranges::find(keys, lower);
    if (found == keys.end()) return std::nullopt;
    return static_cast<Key>(found - keys.begin());
  }

  void read_header() {
    for (;;) {
      const std::string_view word = peek();
      // "nan" begins the posts, "nodata_value" does not.
      if (word.empty() || number_in(word)) break;
      const std::optional<Key> key = key_of(word);
      if (!key)
        refuse(line_, quoted_input(word) +
                          (entries_[ncols] ? " is neither a key of the header nor a number"
                                           : ": not a height field; expected an ESRI ASCII grid, "
                                             "which begins with ncols, or a PNG of 16 bits"));
      const std::size_t line = line_;
      next();
      if (entries_[*key]) refuse(line, std::string(keys[*key]) + " is given twice");
      const std::string_view number = line_of_peek() == line ? next() : std::string_view{};
      const std::optional<double> value = number_in(number);
      const bool may_be_nan = *key == nodata;
      if (!value || (!may_be_nan && !std::isfinite(*value)))
        refuse(line, std::string(keys[*key]) + " = " + quoted_input(number) + "; expected " +
                         (may_be_nan ? "a number" : "a finite number"));
      entries_[*key] = Entry{*value, line};
    }
    for (const Key key : {ncols, nrows, cellsize})
      if (!entries_[key]) refuse(line_, std::string("the header has no ") + keys[key]);
    for (const auto& [corner, center] :
         {std::pair{xllcorner, xllcenter}, std::pair{yllcorner, yllcenter}}) {
      if (entries_[corner] && entries_[center])
        refuse(entries_[center]->line, std::string(keys[corner]) + " and " + keys[center] +
                                           " are both given; expected one of them");
      if (!entries_[corner] && !entries_[center])
        refuse(line_, std::string("the header has no ") + keys[corner]);
    }
  }

  std::size_t line_of_peek() {
    skip_blanks();
    return line_;
  }

  const Entry& value(Key key) const { return *entries_[key]; }

  double count(const char* key, const Entry& entry) const {
    if (entry.value >= 2 && entry.value <= max_posts_a_side &&
        entry.value == std::floor(entry.value))
      return entry.value;
    refuse(entry.line, std::string(key) + " = " + number_text(entry.value) +
                           "; expected a whole number from 2 to " + whole_text(max_posts_a_side));
  }

  void set_place(HeightGrid& grid) const {
    const Entry& size = value(cellsize);
    if (!(size.value > 1e-6 && size.value <= 1e6))
      refuse(size.line, "cellsize = " + number_text(size.value) +
                            "; expected metres, above 0 and at most 1e6");
    grid.spacing = size.value;
    const auto coordinate = [&](Key corner, Key center) {
      const bool is_corner = entries_[corner].has_value();
      const Entry& entry = value(is_corner ? corner : center);
      if (!(std::abs(entry.value) <= max_map_coordinate))
        refuse(entry.line, std::string(keys[is_corner ? corner : center]) + " = " +
                               number_text(entry.value) + "; expected at most 1e8 m");
      return entry.value + (is_corner ? 0.5 * grid.spacing : 0);
    };
    grid.west = coordinate(xllcorner, xllcenter);
    grid.north =
        coordinate(yllcorner, yllcenter) + grid.spacing * static_cast<double>(grid.rows - 1);
    const double posts = static_cast<double>(grid.columns) * static_cast<double>(grid.rows);
    if (posts > max_posts)
      refuse(value(ncols).line, whole_text(posts) +
                                    " posts; expected at most 1e8. Cut it: "
                                    "gdal_translate -of AAIGrid -projwin, or -tr for fewer posts");
    // Each has a digit, and a blank before the next.
    if (2 * posts - 1 > static_cast<double>(rest_.size()))
      refuse(value(ncols).line, "the header names " + whole_text(value(ncols).value) + " x " +
                                    whole_text(value(nrows).value) + " posts, and the file has " +
                                    std::to_string(rest_.size()) + " bytes left for them");
  }

  double height(std::string_view word) const {
    const std::optional<double> number = number_in(word);
    const double none = entries_[nodata] ? entries_[nodata]->value : -9999;
    if (number && (*number == none || (std::isnan(*number) && std::isnan(none))))
      return std::numeric_limits<double>::quiet_NaN();
    if (number && std::abs(*number) <= max_height) return *number;
    refuse(line_, quoted_input(word) +
                      "; expected a height, a number of metres between -1e5 and "
                      "1e5, or the NODATA_value of the header");
  }

  std::vector<double> read_heights(const HeightGrid& grid) {
    std::vector<double> heights(grid.columns * grid.rows);
    for (std::size_t k = 0; k < heights.size(); ++k) {
      const std::string_view word = next();
      if (word.empty())
        refuse(line_, "the file ends after " + std::to_string(k) + " heights; expected " +
                          std::to_string(heights.size()) + ", ncols x nrows");
      heights[k] = height(word);
    }
    if (!peek().empty())
      refuse(line_, quoted_input(peek()) + " comes after all " + std::to_string(heights.size()) +
                        " heights, ncols x nrows; expected the end of the file");
    return heights;
  }

  std::string_view rest_;
  const std::string& name_;
  std::size_t line_ = 1;
  std::array<std::optional<Entry>, key_count> entries_{};
};

}  // namespace

HeightGrid parse_ascii_grid(std::string_view text, const std::string& name) {
  return AsciiGrid(text, name).read();
}

}  // namespace neve::sim::files

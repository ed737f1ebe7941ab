#include "app/sweep/sheet/sheet_layout.h"

#include <algorithm>
#include <cmath>

#include "app/support/room.h"
#include "app/support/text.h"

namespace neve::app::sweep::sheet {

namespace {

using Anchor = render::Note::Anchor;

constexpr std::array<std::uint8_t, 3> bright_ink{240, 244, 250}, soft_ink{172, 182, 196},
    bracket{96, 106, 122};
constexpr std::size_t longest_row = 6;

/// One side of the sheet: axes from the outermost to the innermost.
struct Side {
  std::vector<std::size_t> axes;

  int count(const store::Manifest& m) const {
    int product = 1;
    for (const std::size_t a : axes) product *= static_cast<int>(m.axes[a].values.size());
    return product;
  }
  /// Place of a run along this side.
  int index(const store::Manifest& m, const std::vector<int>& at) const {
    int place = 0;
    for (const std::size_t a : axes)
      place = place * static_cast<int>(m.axes[a].values.size()) + at[a];
    return place;
  }
  /// The value of each axis at a place, outermost first.
  std::vector<int> values(const store::Manifest& m, int place) const {
    std::vector<int> at(axes.size());
    for (std::size_t k = axes.size(); k-- > 0;) {
      const int size = static_cast<int>(m.axes[axes[k]].values.size());
      at[k] = place % size;
      place /= size;
    }
    return at;
  }
  /// Number of outer levels that start again at a place: gaps grow with it.
  int level(const store::Manifest& m, int place) const {
    int level = 0, block = 1;
    for (std::size_t k = axes.size(); k-- > 1;) {
      block *= static_cast<int>(m.axes[axes[k]].values.size());
      if (place > 0 && place % block == 0) ++level;
    }
    return level;
  }
};

struct Sides {
  Side columns, rows;
};

/// Chooses the axes that run across and down the sheet.
Sides choose_sides(const store::Manifest& m, double tile_aspect) {
  Sides sides;
  const auto count = static_cast<int>(m.axes.size());
  const int across = m.columns >= 0 && m.columns != m.rows ? m.columns
                     : m.rows == count - 1                 ? count - 2
                                                           : count - 1;
  int down = m.rows >= 0 ? m.rows : (across == count - 1 ? count - 2 : count - 1);
  if (across >= 0) sides.columns.axes = {static_cast<std::size_t>(across)};
  if (down >= 0) sides.rows.axes = {static_cast<std::size_t>(down)};
  for (int a = count - 1; a >= 0; --a) {
    if (a == across || a == down) continue;
    const double width = tile_aspect * sides.columns.count(m), height = sides.rows.count(m);
    // A little wider than high is how screens and pages are.
    Side& side = width < 1.6 * height ? sides.columns : sides.rows;
    side.axes.insert(side.axes.begin(), static_cast<std::size_t>(a));
  }
  return sides;
}

std::string label_text(const store::Manifest& m, std::size_t axis, int value) {
  const store::AxisLabels& a = m.axes[axis];
  return a.name + " = " + a.values[static_cast<std::size_t>(value)];
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines(1);
  for (const char c : text) {
    if (c == '\n')
      lines.emplace_back();
    else
      lines.back() += c;
  }
  return lines;
}

bool is_wrapped(const store::Manifest& m) {
  if (m.axes.empty()) return true;
  return m.axes.size() == 1 && (m.wrap > 0 || m.axes[0].values.size() > longest_row) && m.rows < 0;
}

/// Tiles side by side so that the sheet is about as wide as a screen.
int wrap_count(const store::Manifest& m, std::size_t count, double tile_aspect) {
  if (m.wrap > 0) return std::min(m.wrap, static_cast<int>(count));
  const double wanted = std::sqrt(static_cast<double>(count) * 1.6 / tile_aspect);
  // Whole trajectories of a screening are side by side.
  const int together = m.screened.empty() ? 1 : static_cast<int>(m.screened.size()) + 1;
  const int across = std::max(1, static_cast<int>(std::lround(wanted / together))) * together;
  return std::clamp(across, 1, static_cast<int>(count));
}

class Layouter {
 public:
  /// @param whole  the sweep that the runs are a part of
  Layouter(const store::Manifest& m, const store::Manifest& whole, bool has_legend, int tile_width,
           const SheetWords& words)
      : m_(m), whole_(whole), words_(words), has_legend_(has_legend) {
    out_.tile_width = tile_width;
    out_.tile_height =
        std::max(1, static_cast<int>(std::lround(1.0 * tile_width * m.tile_height / m.tile_width)));
    out_.font_size = std::clamp(static_cast<int>(std::lround(tile_width / 28.0)), 11, 28);
    if (m.tile_label != "none")
      out_.seal_height = rows_height(
          rows_of(words.seals, letters_in(out_.tile_width, out_.font_size)), out_.font_size);
    gap_ = std::max(3, out_.font_size / 4);
    out_.words = word_room();
  }

  SheetLayout make() {
    is_wrapped_ = is_wrapped(m_);
    out_.has_edges = !is_wrapped_;
    out_.label_height = label_height();
    const double aspect = 1.0 * out_.tile_width / whole_height();
    sides_ = choose_sides(m_, aspect);
    columns_ = is_wrapped_ ? wrap_count(m_, m_.runs.size(), aspect) : sides_.columns.count(m_);
    if (!is_wrapped_) {
      column_gaps_ = gaps_of(sides_.columns, columns_);
      // Runs that are on no axis follow below.
      row_gaps_ = gaps_of(sides_.rows,
                          sides_.rows.count(m_) + static_cast<int>(m_.runs.size()) / columns_ + 1);
    }
    left_ = margin() + (is_wrapped_ ? 0 : row_label_width());
    const int legend = has_legend_ ? static_cast<int>(9.5 * out_.font_size) : 0;
    out_.width = column_x(columns_ - 1) + out_.tile_width + margin() + legend;
    // A title needs room too.
    out_.width = std::max(out_.width, 26 * out_.font_size);
    const auto below = broken_lines(words_.heading, letters_in(out_.width, out_.font_size)).size();
    const double more = below > 1 ? static_cast<double>(below - 1) : 0;
    top_ = static_cast<int>((3.6 + more) * line()) + (is_wrapped_ ? 0 : column_label_height());
    out_.header = static_cast<int>((3.3 + more) * line());
    place_tiles();
    if (!is_wrapped_) add_labels();
    out_.key = wrapped_key(words_.seals.key, out_.width, out_.font_size);
    out_.key_height = key_height(out_.key.size(), out_.font_size);
    out_.height = bottom_ + margin() + out_.key_height;
    return out_;
  }

 private:
  /// Words are at the upper edge of a tile and leave its lower third free.
  WordRoom word_room() const {
    constexpr double share = 0.67;
    const double lines = share * out_.tile_height / (1.25 * out_.font_size);
    return {letters_in(out_.tile_width, out_.font_size),
            static_cast<std::size_t>(std::max(1.0, lines))};
  }

  /// One line is on the picture; several would hide the snow and are above it.
  int label_height() const {
    std::size_t lines = 0;
    for (const Run& run : m_.runs)
      lines = std::max(lines, tile_words(whole_, run, out_.has_edges, out_.words).size());
    return lines < 2 ? 0
                     : static_cast<int>(
                           std::lround((1.25 * static_cast<double>(lines) + 0.5) * out_.font_size));
  }

  /// px, of a picture with what is above and below it.
  int whole_height() const { return out_.label_height + out_.tile_height + out_.seal_height; }

  double line() const { return 1.3 * out_.font_size; }
  int margin() const { return out_.font_size; }
  int wide_gap() const { return 3 * gap_ + out_.font_size / 2; }

  /// Gaps between groups of columns or rows, up to each of them.
  std::vector<int> gaps_of(const Side& side, int count) const {
    std::vector<int> gaps(static_cast<std::size_t>(count), 0);
    for (std::size_t k = 1; k < gaps.size(); ++k)
      gaps[k] = gaps[k - 1] + side.level(m_, static_cast<int>(k)) * wide_gap();
    return gaps;
  }
  static int gap_at(const std::vector<int>& gaps, int place) {
    return gaps.empty() ? 0 : gaps[static_cast<std::size_t>(place)];
  }

  int column_x(int column) const {
    return left_ + column * (out_.tile_width + gap_) + gap_at(column_gaps_, column);
  }
  int row_y(int row) const { return top_ + row * (whole_height() + gap_) + gap_at(row_gaps_, row); }

  void put(std::size_t run, int column, int row) {
    out_.tiles.push_back({run, column_x(column), row_y(row) + out_.label_height});
    bottom_ = std::max(bottom_, row_y(row) + whole_height());
  }

  void place_tiles() {
    int next = is_wrapped_ ? 0 : sides_.rows.count(m_) * columns_;
    for (std::size_t k = 0; k < m_.runs.size(); ++k) {
      const std::vector<int>& at = m_.runs[k].coordinates;
      if (!is_wrapped_ && at.size() == m_.axes.size()) {
        put(k, sides_.columns.index(m_, at), sides_.rows.index(m_, at));
      } else {
        put(k, next % columns_, next / columns_);
        ++next;
      }
    }
  }

  int column_label_height() const {
    return static_cast<int>(
        std::lround(line() * static_cast<double>(sides_.columns.axes.size()) + 0.2 * line()));
  }

  double max_level_width() const { return 14.0 * out_.font_size; }
  double width_of(std::size_t letters) const {
    return letter_width * out_.font_size * static_cast<double>(letters + 1);
  }

  /// True if "name = value" fits side by side for all values of an axis.
  bool is_joined(std::size_t axis) const {
    const store::AxisLabels& a = m_.axes[axis];
    std::size_t longest = 0;
    for (const std::string& value : a.values) {
      if (value.find('\n') != std::string::npos) return false;
      longest = std::max(longest, value.size());
    }
    return !a.name.empty() && width_of(a.name.size() + 3 + longest) <= max_level_width();
  }

  /// Lines of a row header: name above value if both do not fit side by side.
  std::vector<std::string> row_lines(std::size_t axis, int value) const {
    if (is_joined(axis)) return {label_text(m_, axis, value)};
    std::vector<std::string> lines =
        lines_of(m_.axes[axis].values[static_cast<std::size_t>(value)]);
    if (!m_.axes[axis].name.empty()) lines.insert(lines.begin(), m_.axes[axis].name + " =");
    return lines;
  }

  int level_width(std::size_t axis) const {
    std::size_t longest = 0;
    for (int value = 0; value < static_cast<int>(m_.axes[axis].values.size()); ++value)
      for (const std::string& text : row_lines(axis, value))
        longest = std::max(longest, text.size());
    return static_cast<int>(std::min(width_of(longest), max_level_width()));
  }
  int row_label_width() const {
    int width = 0;
    for (const std::size_t a : sides_.rows.axes) width += level_width(a) + out_.font_size / 2;
    return width;
  }

  void add_labels() {
    add_column_labels();
    add_row_labels();
  }

  /// One line for each level, over the middle of its columns.
  void add_column_labels() {
    const auto levels = sides_.columns.axes.size();
    for (std::size_t k = 0; k < levels; ++k) {
      int block = 1;
      for (std::size_t j = k + 1; j < levels; ++j)
        block *= static_cast<int>(m_.axes[sides_.columns.axes[j]].values.size());
      for (int first = 0; first < columns_; first += block) {
        const int value = sides_.columns.values(m_, first)[k];
        const int left = column_x(first), right = column_x(first + block - 1) + out_.tile_width;
        const double y = top_ - line() * static_cast<double>(levels - k) - 0.1 * line();
        out_.labels.push_back({0.5f * static_cast<float>(left + right), static_cast<float>(y),
                               label_text(m_, sides_.columns.axes[k], value), Anchor::middle,
                               static_cast<float>(right - left), false,
                               k + 1 == levels ? bright_ink : soft_ink});
      }
    }
  }

  void add_row_labels() {
    const auto levels = sides_.rows.axes.size();
    int x = margin();
    for (std::size_t k = 0; k < levels; ++k) {
      const std::size_t axis = sides_.rows.axes[k];
      int block = 1;
      for (std::size_t j = k + 1; j < levels; ++j)
        block *= static_cast<int>(m_.axes[sides_.rows.axes[j]].values.size());
      for (int first = 0; first < sides_.rows.count(m_); first += block) {
        const int value = sides_.rows.values(m_, first)[k];
        const double middle = 0.5 * (row_y(first) + row_y(first + block - 1) + whole_height());
        const auto room = static_cast<float>(level_width(axis));
        const std::vector<std::string> lines = row_lines(axis, value);
        const bool has_name = !m_.axes[axis].name.empty() && !is_joined(axis);
        for (std::size_t n = 0; n < lines.size(); ++n) {
          const double at =
              middle + line() * (static_cast<double>(n) - 0.5 * static_cast<double>(lines.size()));
          const bool is_soft = has_name ? n == 0 : n > 0;
          out_.labels.push_back({static_cast<float>(x), static_cast<float>(at), lines[n],
                                 Anchor::left, room, false, is_soft ? soft_ink : bright_ink});
        }
        if (k + 1 < levels) add_bracket(x + level_width(axis), first, first + block - 1);
      }
      x += level_width(axis) + out_.font_size / 2;
    }
  }

  /// A line along the rows that an outer value holds for.
  void add_bracket(int x, int first, int last) {
    const auto top = static_cast<float>(row_y(first)),
               bottom = static_cast<float>(row_y(last) + whole_height());
    out_.brackets.push_back({static_cast<float>(x),
                             top,
                             std::max(1.0f, 0.1f * static_cast<float>(out_.font_size)),
                             bottom - top,
                             {bracket[0], bracket[1], bracket[2], 255}});
  }

  const store::Manifest& m_;
  const store::Manifest& whole_;  ///< a tile names what its run changes of the one before it
  const SheetWords& words_;
  bool has_legend_;
  Sides sides_;
  bool is_wrapped_ = false;
  std::vector<int> column_gaps_, row_gaps_;  ///< none where tiles are wrapped
  int columns_ = 1, left_ = 0, top_ = 0, bottom_ = 0, gap_ = 4;
  SheetLayout out_;
};

/// @param whole  see Layouter
SheetLayout layout_part(const store::Manifest& part, const store::Manifest& whole, bool has_legend,
                        int largest, const SheetWords& words) {
  constexpr int smallest_tile = 64;
  int tile = part.tile_width;
  while (true) {
    SheetLayout layout = Layouter(part, whole, has_legend, tile, words).make();
    if (fits(layout, largest) || tile <= smallest_tile) return layout;
    tile = std::max(smallest_tile, tile * 9 / 10);
  }
}

}  // namespace

std::size_t letters_in(double width, double font_size) {
  constexpr double space = 1.2;
  return static_cast<std::size_t>(std::max(1.0, (width / font_size - space) / letter_width));
}

int rows_height(int rows, int font_size) {
  return rows == 0 ? 0 : static_cast<int>(std::lround((1.3 * rows + 0.5) * font_size));
}

bool fits(const SheetLayout& layout, int largest) {
  // The sheet, its overlay and its encoder.
  const double max_pixels = std::min(48e6, memory_room() / 20);
  return layout.width <= largest && layout.height <= largest &&
         1.0 * layout.width * layout.height <= max_pixels;
}

SheetLayout layout_sheet(const store::Manifest& manifest, bool has_legend, int largest,
                         const SheetWords& words) {
  return layout_part(manifest, manifest, has_legend, largest, words);
}

std::vector<SheetPage> layout_pages(const store::Manifest& manifest, bool has_legend, int largest,
                                    const SheetWords& words) {
  constexpr int readable_tile = 160;
  SheetLayout whole = layout_sheet(manifest, has_legend, largest, words);
  if (fits(whole, largest)) return {{0, manifest.runs.size(), std::move(whole)}};

  store::Manifest part = manifest;
  part.axes.clear();
  part.columns = part.rows = -1;
  const auto layout_of = [&](std::size_t first, std::size_t count) {
    const auto begin = manifest.runs.begin() + static_cast<std::ptrdiff_t>(first);
    part.runs.assign(begin, begin + static_cast<std::ptrdiff_t>(count));
    return layout_part(part, manifest, has_legend, largest, words);
  };
  const auto is_readable = [&](const SheetLayout& layout) {
    return fits(layout, largest) &&
           layout.tile_width >= std::min(readable_tile, manifest.tile_width);
  };
  std::size_t count = manifest.runs.size();
  while (count > 1 && !is_readable(layout_of(0, count))) count = (count + 1) / 2;
  if (const std::size_t together = manifest.screened.size() + 1; count > together)
    count -= count % together;
  std::vector<SheetPage> pages;
  for (std::size_t first = 0; first < manifest.runs.size(); first += count) {
    const std::size_t here = std::min(count, manifest.runs.size() - first);
    pages.push_back({first, here, layout_of(first, here)});
    for (SheetTile& tile : pages.back().layout.tiles) tile.run += first;
  }
  return pages;
}

}  // namespace neve::app::sweep::sheet

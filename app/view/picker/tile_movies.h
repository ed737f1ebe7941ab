#pragma once
/// The moving pictures of nine tiles, decoded and made as large as they are shown when they are
/// needed.

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "render/image/image.h"

namespace neve::app::view::picker {

inline constexpr int tile_count = 9;

/// Nine equal places in three rows; px.
struct Grid {
  int x = 0, y = 0;  ///< of the upper left corner
  int tile_width = 160, tile_height = 90, gap = 4;

  int width() const { return 3 * tile_width + 2 * gap; }
  int height() const { return 3 * tile_height + 2 * gap; }
  int tile_x(int tile) const { return x + (tile % 3) * (tile_width + gap); }
  int tile_y(int tile) const { return y + (tile / 3) * (tile_height + gap); }
  bool operator==(const Grid&) const = default;
};

class TileMovies {
 public:
  /// Reads the pictures of a tile, which replace those it had. @throws IoError
  void load(int tile, const std::vector<std::filesystem::path>& files);
  bool has(int tile) const { return !movies_[static_cast<std::size_t>(tile)].files.empty(); }
  /// Pictures of the longest movie.
  int length() const;

  /// All tiles at a moment, side by side; no larger than their pictures, so that it may have to be
  /// scaled up. Movies that are shorter stay at their end.
  const render::Image& grid(const Grid& place, int moment);
  /// One tile at a moment, as it was drawn.
  render::Image large(int tile, int moment) const;

 private:
  using Bytes = std::vector<std::uint8_t>;
  struct Movie {
    std::vector<Bytes> files;           ///< PNG
    std::vector<render::Image> scaled;  ///< at the size of the grid; empty ones are not made yet
  };

  const render::Image& scaled(Movie& movie, int moment);
  int stride() const;
  void fit(const Grid& place);

  std::array<Movie, tile_count> movies_;
  Grid place_;
  int width_ = 0, height_ = 0;  ///< of a tile in the grid, px
  render::Image grid_;
};

}  // namespace neve::app::view::picker

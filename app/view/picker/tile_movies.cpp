#include "app/view/picker/tile_movies.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "app/output/atomic_file.h"
#include "render/frame/compose.h"

namespace neve::app::view::picker {

namespace {

/// Bytes of all scaled pictures; longer movies are shown with fewer pictures.
constexpr std::size_t memory = 200'000'000;
constexpr std::array<std::uint8_t, 3> background{12, 14, 18};

/// A black picture where the bytes are no PNG: a disk may lose some.
render::Image decoded(const std::vector<std::uint8_t>& bytes) {
  try {
    return render::decode_png(bytes);
  } catch (const render::ImageError&) {
    return render::compose(16, 9, {0, 0, 0}, {});
  }
}

/// RGB of exactly this size.
render::Image resized(const render::Image& picture, int width, int height) {
  if (picture.width == width && picture.height == height && picture.channels == 3) return picture;
  const int w = std::min(width, picture.width), h = std::min(height, picture.height);
  return render::compose(width, height, background, {{0, 0, render::shrink(picture, w, h)}});
}

/// A row of pixels of an RGB picture.
std::uint8_t* row_of(render::Image& image, int x, int y) {
  return image.pixels.data() +
         3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
              static_cast<std::size_t>(x));
}

}  // namespace

void TileMovies::load(int tile, const std::vector<std::filesystem::path>& files) {
  Movie movie;
  for (const std::filesystem::path& file : files) movie.files.push_back(output::read_file(file));
  movie.scaled.resize(movie.files.size());
  movies_[static_cast<std::size_t>(tile)] = std::move(movie);
  place_ = {};  // the first picture may have another size
}

int TileMovies::length() const {
  std::size_t longest = 0;
  for (const Movie& movie : movies_) longest = std::max(longest, movie.files.size());
  return static_cast<int>(longest);
}

int TileMovies::stride() const {
  const double all = 3.0 * tile_count * width_ * height_ * length();
  return std::max(1, static_cast<int>(std::ceil(all / static_cast<double>(memory))));
}

/// Pictures of another size are made again.
void TileMovies::fit(const Grid& place) {
  if (place == place_) return;
  place_ = place;
  int width = place.tile_width, height = place.tile_height;
  for (const Movie& movie : movies_) {
    if (movie.files.empty()) continue;
    const render::Image first = decoded(movie.files.front());
    width = std::min(width, first.width);
    height = std::min(height, first.height);
    break;
  }
  if (width == width_ && height == height_) return;
  width_ = width;
  height_ = height;
  for (Movie& movie : movies_)
    for (render::Image& picture : movie.scaled) picture = {};
}

const render::Image& TileMovies::scaled(Movie& movie, int moment) {
  const int last = static_cast<int>(movie.files.size()) - 1;
  const int shown = std::min(moment - moment % stride(), last);
  render::Image& picture = movie.scaled[static_cast<std::size_t>(shown)];
  if (picture.width != width_ || picture.height != height_)
    picture = resized(decoded(movie.files[static_cast<std::size_t>(shown)]), width_, height_);
  return picture;
}

const render::Image& TileMovies::grid(const Grid& place, int moment) {
  fit(place);
  // Gaps are as much smaller as the tiles are.
  const int gap = std::max(1, place.gap * width_ / std::max(1, place.tile_width));
  const Grid small{0, 0, width_, height_, gap};
  if (grid_.width != small.width() || grid_.height != small.height())
    grid_ = render::compose(small.width(), small.height(), background, {});
  for (int tile = 0; tile < tile_count; ++tile) {
    Movie& movie = movies_[static_cast<std::size_t>(tile)];
    if (movie.files.empty()) continue;
    const render::Image& picture = scaled(movie, moment);
    for (int y = 0; y < height_; ++y) {
      const auto* from = picture.pixels.data() +
                         3 * static_cast<std::size_t>(y) * static_cast<std::size_t>(width_);
      std::copy(from, from + 3 * width_, row_of(grid_, small.tile_x(tile), small.tile_y(tile) + y));
    }
  }
  return grid_;
}

render::Image TileMovies::large(int tile, int moment) const {
  const Movie& movie = movies_[static_cast<std::size_t>(tile)];
  if (movie.files.empty()) return {};
  const render::Image picture =
      decoded(movie.files[std::min(static_cast<std::size_t>(moment), movie.files.size() - 1)]);
  return resized(picture, picture.width, picture.height);
}

}  // namespace neve::app::view::picker

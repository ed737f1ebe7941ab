#include "render/splat.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdlib>
#include <string_view>
#include <utility>

#include "render/light_fields.h"
#include "render/point_list.h"

namespace neve::render {
namespace {

/// Samples of a band: few enough to stay in the cache until the driver has copied them.
constexpr int band_samples = 1 << 18;
constexpr int max_parts = 64;

SplatView splat_view(const Points& points, const View& view) {
  return {view.eye,
          view.right,
          view.up,
          view.forward,
          view.pixels_per_slope,
          view.near_distance,
          view.width,
          view.height,
          points.radius,
          min_radius_pixels / view.pixels_per_slope};
}

/// Calls body(tile) for every tile that the disc may touch.
template <class Body>
void for_each_tile(const SplatDisc& disc, int columns, const Body& body) {
  if (disc.x_low > disc.x_high) return;
  for (int row = disc.y_low / splat_tile_height; row <= disc.y_high / splat_tile_height; ++row)
    for (int column = disc.x_low / splat_tile_width; column <= disc.x_high / splat_tile_width;
         ++column)
      body(row * columns + column);
}

}  // namespace

const SplatKernels& chosen_splat_kernels() {
#ifdef NEVE_X86_SPLAT
  const char* wanted = std::getenv("NEVE_SIMD");
  if (__builtin_cpu_supports("x86-64-v3") && !(wanted && std::string_view(wanted) == "baseline"))
    return splat_avx2;
#endif
  return splat_baseline;
}

/// Discs of all points in the order of ids, and how many of each part lie in each tile.
void Splatter::project(const Points& points, const SplatView& view, ThreadPool* pool) {
  const auto count = points.position.size();
  const std::vector<std::uint32_t> order = order_by_id(points);
  const PointColors color(points);
  discs_.resize(count);
  part_count_ = static_cast<int>(std::clamp<std::size_t>(count / 4096, 1, max_parts));
  const int tiles = columns_ * rows_;
  part_counts_.assign(static_cast<std::size_t>(part_count_) * static_cast<std::size_t>(tiles), 0);
  for_each_task(part_count_, pool, [&](int part) {
    const auto p = static_cast<std::size_t>(part), of = static_cast<std::size_t>(part_count_);
    const ProjectJob job{
        view,          points.position.data(),           order.empty() ? nullptr : order.data(),
        discs_.data(), static_cast<int>(count * p / of), static_cast<int>(count * (p + 1) / of)};
    kernels_.project(job);
    int* counts = part_counts_.data() + p * static_cast<std::size_t>(tiles);
    for (int i = job.begin; i < job.end; ++i) {
      SplatDisc& disc = discs_[static_cast<std::size_t>(i)];
      if (disc.x_low > disc.x_high) continue;
      disc.color = color.root_albedo(job.order ? job.order[i] : static_cast<std::uint32_t>(i));
      for_each_tile(disc, columns_, [&](int tile) { ++counts[tile]; });
    }
  });
}

/// Lists the discs of each tile, in the order of ids: parts follow one another.
void Splatter::fill_bins(ThreadPool* pool) {
  const auto tiles = static_cast<std::size_t>(columns_ * rows_);
  bin_start_.resize(tiles + 1);
  first_column_ = columns_, last_column_ = -1, first_row_ = rows_, last_row_ = -1;
  int total = 0;
  for (std::size_t tile = 0; tile < tiles; ++tile) {
    bin_start_[tile] = total;
    for (std::size_t part = 0; part < static_cast<std::size_t>(part_count_); ++part) {
      int& count = part_counts_[part * tiles + tile];
      total += std::exchange(count, total);
    }
    if (total == bin_start_[tile]) continue;
    const int column = static_cast<int>(tile) % columns_, row = static_cast<int>(tile) / columns_;
    first_column_ = std::min(first_column_, column);
    last_column_ = std::max(last_column_, column);
    first_row_ = std::min(first_row_, row);
    last_row_ = row;
  }
  bin_start_[tiles] = total;
  list_.resize(static_cast<std::size_t>(total));
  sorted_.resize(static_cast<std::size_t>(total));
  for_each_task(part_count_, pool, [&](int part) {
    const auto p = static_cast<std::size_t>(part), of = static_cast<std::size_t>(part_count_);
    int* next = part_counts_.data() + p * tiles;
    for (std::size_t i = discs_.size() * p / of; i < discs_.size() * (p + 1) / of; ++i)
      for_each_tile(discs_[i], columns_, [&](int tile) {
        list_[static_cast<std::size_t>(next[tile]++)] = static_cast<int>(i);
      });
  });
}

/// Roughly front to back, equals in the order of ids: one counting sort over the bits of the
/// inverse distance, which grow with it.
void Splatter::sort_bin(int tile) {
  constexpr std::uint32_t slabs = 1024;
  const auto begin = list_.begin() + bin_start_[static_cast<std::size_t>(tile)];
  const auto end = list_.begin() + bin_start_[static_cast<std::size_t>(tile) + 1];
  const auto key = [&](int disc) {
    return std::bit_cast<std::uint32_t>(discs_[static_cast<std::size_t>(disc)].nearest);
  };
  std::uint32_t least = ~0u, most = 0;
  for (auto i = begin; i != end; ++i) {
    least = std::min(least, key(*i));
    most = std::max(most, key(*i));
  }
  constexpr auto key_bits = static_cast<int>(std::bit_width(slabs - 1));
  const int shift = std::max(0, static_cast<int>(std::bit_width(most - least)) - key_bits);
  std::array<int, slabs + 1> start{};
  for (auto i = begin; i != end; ++i) ++start[((most - key(*i)) >> shift) + 1];
  for (std::size_t s = 0; s < slabs; ++s) start[s + 1] += start[s];
  int* to = sorted_.data() + (begin - list_.begin());
  for (auto i = begin; i != end; ++i) to[start[(most - key(*i)) >> shift]++] = *i;
}

SplatBand Splatter::draw_band(int first_row, int last_row, ThreadPool* pool, unsigned kind) {
  const int across = last_column_ - first_column_ + 1;
  const int pitch = across * splat_tile_width;
  const auto samples = static_cast<std::size_t>(pitch) *
                       static_cast<std::size_t>((last_row - first_row + 1) * splat_tile_height);
  if (depth_.size() < samples) {
    depth_.resize(samples);
    albedo_.resize(samples);
    normal_kind_.resize(4 * samples);
  }
  for_each_task(across * (last_row - first_row + 1), pool, [&](int n) {
    const int column = first_column_ + n % across, row = first_row + n / across;
    const int tile = row * columns_ + column;
    sort_bin(tile);
    const int begin = bin_start_[static_cast<std::size_t>(tile)];
    const std::ptrdiff_t corner = (row - first_row) * splat_tile_height * std::ptrdiff_t{pitch} +
                                  (column - first_column_) * splat_tile_width;
    kernels_.draw_tile({view_, discs_.data(), sorted_.data() + begin,
                        bin_start_[static_cast<std::size_t>(tile) + 1] - begin,
                        column * splat_tile_width, row * splat_tile_height, kind,
                        depth_.data() + corner, normal_kind_.data() + 4 * corner,
                        albedo_.data() + corner, pitch});
  });
  const int x = first_column_ * splat_tile_width, y = first_row * splat_tile_height;
  return {x,
          y,
          std::min(pitch, view_.width - x),
          std::min((last_row + 1) * splat_tile_height, view_.height) - y,
          pitch,
          depth_.data(),
          normal_kind_.data(),
          albedo_.data()};
}

void Splatter::draw(const Points& points, const View& view, ThreadPool* pool,
                    const std::function<void(const SplatBand&)>& receive) {
  if (points.position.empty()) return;
  constexpr unsigned kind_snow = 0x4200, kind_attribute = 0x4400;  // 3 and 4 as half floats
  view_ = splat_view(points, view);
  columns_ = (view.width + splat_tile_width - 1) / splat_tile_width;
  rows_ = (view.height + splat_tile_height - 1) / splat_tile_height;
  project(points, view_, pool);
  fill_bins(pool);
  if (last_row_ < 0) return;
  const int across = (last_column_ - first_column_ + 1) * splat_tile_width * splat_tile_height;
  const int step = std::max(1, band_samples / across);
  for (int row = first_row_; row <= last_row_; row += step)
    receive(draw_band(row, std::min(row + step - 1, last_row_), pool,
                      points.value.empty() ? kind_snow : kind_attribute));
}

}  // namespace neve::render

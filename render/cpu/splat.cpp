#include "render/cpu/splat.h"

#include <algorithm>
#include <array>
#include <bit>
#include <utility>

#include "render/frame/point_list.h"
#include "render/light/light_fields.h"

namespace neve::render::cpu {
namespace {

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
  for (int row = disc.y_low / light::tile_height; row <= disc.y_high / light::tile_height; ++row)
    for (int column = disc.x_low / light::tile_width; column <= disc.x_high / light::tile_width;
         ++column)
      body(row * columns + column);
}

}  // namespace

/// Discs of all points in the order of ids, and how many of each part lie in each tile.
void Splatter::project(const Points& points, ThreadPool* pool, Paint paint) {
  const auto count = points.position.size();
  const std::vector<std::uint32_t> order = order_by_id(points);
  const PointColors color(points);
  discs_.resize(count);
  part_count_ = static_cast<int>(std::clamp<std::size_t>(count / 4096, 1, max_parts));
  const int tiles = columns_ * rows_;
  part_counts_.assign(static_cast<std::size_t>(part_count_) * static_cast<std::size_t>(tiles), 0);
  light::for_each_task(part_count_, pool, [&](int part) {
    const auto p = static_cast<std::size_t>(part), of = static_cast<std::size_t>(part_count_);
    const ProjectJob job{
        view_,         points.position.data(),           order.empty() ? nullptr : order.data(),
        discs_.data(), static_cast<int>(count * p / of), static_cast<int>(count * (p + 1) / of)};
    kernels_.project(job);
    int* counts = part_counts_.data() + p * static_cast<std::size_t>(tiles);
    for (int i = job.begin; i < job.end; ++i) {
      SplatDisc& disc = discs_[static_cast<std::size_t>(i)];
      if (disc.x_low > disc.x_high) continue;
      const std::uint32_t point = job.order ? job.order[i] : static_cast<std::uint32_t>(i);
      disc.color = paint == Paint::index ? point : color.root_albedo(point);
      for_each_tile(disc, columns_, [&](int tile) { ++counts[tile]; });
    }
  });
}

/// Lists the discs of each tile, in the order of ids: parts follow one another.
void Splatter::fill_bins(ThreadPool* pool) {
  const auto tiles = static_cast<std::size_t>(columns_ * rows_);
  bin_start_.resize(tiles + 1);
  int total = 0;
  for (std::size_t tile = 0; tile < tiles; ++tile) {
    bin_start_[tile] = total;
    for (std::size_t part = 0; part < static_cast<std::size_t>(part_count_); ++part) {
      int& count = part_counts_[part * tiles + tile];
      total += std::exchange(count, total);
    }
  }
  bin_start_[tiles] = total;
  list_.resize(static_cast<std::size_t>(total));
  sorted_.resize(static_cast<std::size_t>(total));
  light::for_each_task(part_count_, pool, [&](int part) {
    const auto p = static_cast<std::size_t>(part), of = static_cast<std::size_t>(part_count_);
    int* next = part_counts_.data() + p * tiles;
    for (std::size_t i = discs_.size() * p / of; i < discs_.size() * (p + 1) / of; ++i)
      for_each_tile(discs_[i], columns_, [&](int tile) {
        list_[static_cast<std::size_t>(next[tile]++)] = static_cast<int>(i);
      });
  });
}

/// Sorts a bin roughly front to back, equals in the order of ids: one counting sort over the bits
/// of the inverse distance, which grow with it.
void Splatter::sort_bin(int tile) {
  constexpr std::uint32_t slabs = 1024;
  const auto begin = list_.begin() + bin_start_[static_cast<std::size_t>(tile)];
  const auto end = list_.begin() + bin_start_[static_cast<std::size_t>(tile) + 1];
  const auto key = [&](int disc) {
    return std::bit_cast<std::uint32_t>(discs_[static_cast<std::size_t>(disc)].nearest);
  };
  if (begin == end) return;
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

void Splatter::prepare(const Points& points, const View& view, ThreadPool* pool, Paint paint) {
  view_ = splat_view(points, view);
  kind_ = points.value.empty() ? light::kind_snow : light::kind_attribute;
  columns_ = (view.width + light::tile_width - 1) / light::tile_width;
  rows_ = (view.height + light::tile_height - 1) / light::tile_height;
  project(points, pool, paint);
  fill_bins(pool);
}

void Splatter::draw_tile(int tile, light::GBufferTile& out) {
  sort_bin(tile);
  const int begin = bin_start_[static_cast<std::size_t>(tile)];
  kernels_.splat_tile({view_, discs_.data(), sorted_.data() + begin,
                       bin_start_[static_cast<std::size_t>(tile) + 1] - begin,
                       tile % columns_ * light::tile_width, tile / columns_ * light::tile_height,
                       kind_, &out});
}

}  // namespace neve::render::cpu

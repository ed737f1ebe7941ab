#include "render/snow/march.h"

#include <algorithm>
#include <cstring>

#include "render/cpu/surfaces.h"

namespace neve::render::snow {

namespace {

using light::tile_height;
using light::tile_width;
using surface::block_side;

}  // namespace

Marcher::Marcher(const Body& body, const View& view, const cpu::DrawKernels& kernels)
    : kernels_(kernels), body_(body), view_(view), lane_view_(cpu::lane_view(view)) {
  columns_ = (view.width + tile_width - 1) / tile_width;
  const int rows = (view.height + tile_height - 1) / tile_height;
  const double cell = static_cast<double>(body.field.cell);
  const auto corner = [&](int block, float eye) {
    return static_cast<float>(cell * block_side * block - static_cast<double>(eye));
  };
  for (std::uint32_t n = 0; n < body.padded_block.size(); ++n) {
    const Vec3i b = body.field.block[body.padded_block[n]];
    const CellBox& box = body.surface_box[n];
    const Vec3f low{corner(b.x, view.eye.x), corner(b.y, view.eye.y), corner(b.z, view.eye.z)};
    corner_.push_back(low);
    if (box.low.x > box.high.x) continue;  // no cell with the surface
    BlockOnPicture block{1e30f, n, view.width, -1, view.height, -1};
    float x_low = 1e30f, x_high = -1e30f, y_low = 1e30f, y_high = -1e30f, farthest = 0;
    for (int c = 0; c < 8; ++c) {
      const auto end = [&](int bit, int first, int last) {
        return static_cast<float>(c & bit ? last + 1 : first) * body.field.cell;
      };
      const Vec3f p = low + Vec3f{end(1, box.low.x, box.high.x), end(2, box.low.y, box.high.y),
                                  end(4, box.low.z, box.high.z)};
      const float z = dot(p, view.forward);
      block.nearest = std::min(block.nearest, z);
      farthest = std::max(farthest, z);
      const float scale = view.pixels_per_slope / std::max(z, 1e-6f);
      x_low = std::min(x_low, dot(p, view.right) * scale);
      x_high = std::max(x_high, dot(p, view.right) * scale);
      y_low = std::min(y_low, dot(p, view.up) * scale);
      y_high = std::max(y_high, dot(p, view.up) * scale);
    }
    if (farthest <= view.near_distance) continue;
    const float half_width = 0.5f * static_cast<float>(view.width),
                half_height = 0.5f * static_cast<float>(view.height);
    if (block.nearest <= view.near_distance) {  // all of the picture may see it
      x_low = -half_width;
      x_high = half_width;
      y_low = -half_height;
      y_high = half_height;
    }
    const auto sample = [](float at, int last) {
      return static_cast<int>(std::clamp(at, 0.0f, static_cast<float>(last)));
    };
    if (x_high < -half_width || x_low > half_width || y_high < -half_height || y_low > half_height)
      continue;
    block.x_low = sample(x_low + half_width, view.width - 1);
    block.x_high = sample(x_high + half_width, view.width - 1);
    block.y_low = sample(y_low + half_height, view.height - 1);
    block.y_high = sample(y_high + half_height, view.height - 1);
    blocks_.push_back(block);
  }
  std::stable_sort(
      blocks_.begin(), blocks_.end(),
      [](const BlockOnPicture& a, const BlockOnPicture& b) { return a.nearest < b.nearest; });
  const auto tiles = static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows);
  const auto for_tiles = [&](const BlockOnPicture& b, const auto& use) {
    for (int row = b.y_low / tile_height; row <= b.y_high / tile_height; ++row)
      for (int column = b.x_low / tile_width; column <= b.x_high / tile_width; ++column)
        use(static_cast<std::size_t>(row * columns_ + column));
  };
  first_.assign(tiles + 1, 0);
  for (const BlockOnPicture& b : blocks_) for_tiles(b, [&](std::size_t t) { ++first_[t + 1]; });
  for (std::size_t t = 0; t < tiles; ++t) first_[t + 1] += first_[t];
  list_.resize(first_[tiles]);
  std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
  for (std::uint32_t n = 0; n < blocks_.size(); ++n)
    for_tiles(blocks_[n], [&](std::size_t t) { list_[next[t]++] = n; });
}

Vec3f Marcher::ray(int x, int y) const {
  const float per_sample = 1 / view_.pixels_per_slope;
  const float right =
      (static_cast<float>(x) + 0.5f - 0.5f * static_cast<float>(view_.width)) * per_sample;
  const float up =
      (static_cast<float>(y) + 0.5f - 0.5f * static_cast<float>(view_.height)) * per_sample;
  return view_.forward + view_.right * right + view_.up * up;
}

void Marcher::march_block(const BlockOnPicture& block, int x, int y, TileHits& hits) const {
  const CellBox& box = body_.surface_box[block.padded];
  const auto place = [](Vec3i cell) {
    return Vec3f{static_cast<float>(cell.x), static_cast<float>(cell.y),
                 static_cast<float>(cell.z)};
  };
  const float per_cell = 1 / body_.field.cell;
  kernels_.march_block({lane_view_, body_.padded.data() + std::size_t{block.padded} * padded_nodes,
                        surface_share, per_cell, corner_[block.padded] * -per_cell, place(box.low),
                        place(box.high + Vec3i{1, 1, 1}), block.nearest, block.padded, x, y,
                        std::max(block.x_low, x), std::min(block.x_high, x + tile_width - 1),
                        std::max(block.y_low, y), std::min(block.y_high, y + tile_height - 1),
                        &hits});
}

void Marcher::march_tile(int x, int y, TileHits& hits) const {
  std::memset(hits.distance, 0, sizeof hits.distance);
  const auto tile = static_cast<std::size_t>(y / tile_height * columns_ + x / tile_width);
  for (std::uint32_t n = first_[tile]; n < first_[tile + 1]; ++n)
    march_block(blocks_[list_[n]], x, y, hits);
}

}  // namespace neve::render::snow

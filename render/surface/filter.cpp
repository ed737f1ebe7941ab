#include "render/surface/filter.h"

#include <algorithm>
#include <cmath>

#include "render/surface/block_map.h"
#include "render/surface/loops.h"

namespace neve::render::surface {

namespace {

/// Largest variance of a sum of three neighbours that looks like a part of a Gaussian.
constexpr double widest_step = 0.5;

/// Filters a block along the axis whose neighbours are `inner` numbers apart.
template <int inner>
void filter_block(const Filter& filter, const Field& field, std::size_t b, float* out) {
  constexpr int along = inner == 1 ? 1 : inner == 8 ? 3 : 9;
  constexpr int line = inner * block_side;
  const auto values = [&](int side) -> const float* {
    const std::uint32_t block = field.near[b][static_cast<std::size_t>(13 + side * along)];
    return block == no_block ? nullptr : field.value.data() + std::size_t{block_nodes} * block;
  };
  const float *before = values(-1), *own = values(0), *after = values(1);
  const int margin = filter.radius * inner;
  // The line with as much of its neighbours as the filter sees.
  float wide[3 * line];
  for (int begin = 0; begin < block_nodes; begin += line) {
    if (before)
      std::copy_n(before + begin + line - margin, margin, wide);
    else
      std::fill_n(wide, margin, 0.0f);
    std::copy_n(own + begin, line, wide + margin);
    if (after)
      std::copy_n(after + begin, margin, wide + margin + line);
    else
      std::fill_n(wide + margin + line, margin, 0.0f);
    float sum[line];
    const float* middle = wide + margin;
    for (int n = 0; n < line; ++n) sum[n] = filter.weight[0] * middle[n];
    for (int k = 1; k <= filter.radius; ++k) {
      const float weight = filter.weight[static_cast<std::size_t>(k)];
      const float *left = middle - k * inner, *right = middle + k * inner;
      for (int n = 0; n < line; ++n) sum[n] += weight * (left[n] + right[n]);
    }
    std::copy_n(sum, line, out + begin);
  }
}

template <int inner>
void filter_axis(const Filter& filter, Field& field, std::vector<float>& spare, ThreadPool* pool) {
  for_ranges(pool, field.block.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b)
      filter_block<inner>(filter, field, b, spare.data() + block_nodes * b);
  });
  field.value.swap(spare);
}

}  // namespace

Filter make_filter(double variance) {
  Filter filter;
  if (!(variance > 0)) return filter;
  constexpr double most = 7 * widest_step;
  filter.passes = static_cast<int>(std::ceil(variance / most));
  const double of_pass = variance / filter.passes;
  filter.radius = std::max(1, static_cast<int>(std::ceil(of_pass / widest_step)));
  const double side = 0.5 * of_pass / filter.radius;
  std::array<double, 17> weight{};  // of -8 to 8 nodes away
  weight[8] = 1;
  for (int step = 0; step < filter.radius; ++step) {
    const std::array<double, 17> before = weight;
    for (std::size_t k = 1; k < 16; ++k)
      weight[k] = (1 - 2 * side) * before[k] + side * (before[k - 1] + before[k + 1]);
  }
  for (std::size_t k = 0; k <= static_cast<std::size_t>(filter.radius); ++k)
    filter.weight[k] = static_cast<float>(weight[8 + k]);
  return filter;
}

void apply(const Filter& filter, Field& field, ThreadPool* pool) {
  std::vector<float> spare(filter.passes > 0 ? field.value.size() : 0);
  for (int pass = 0; pass < filter.passes; ++pass) {
    filter_axis<64>(filter, field, spare, pool);
    filter_axis<8>(filter, field, spare, pool);
    filter_axis<1>(filter, field, spare, pool);
  }
}

}  // namespace neve::render::surface

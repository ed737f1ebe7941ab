#include "render/snow/grain_noise.h"

#include <cstdint>
#include <numeric>

#include "sim/base/hash.h"

namespace neve::render::snow {

namespace {

constexpr int texels_per_unit = GrainNoise::texels_per_unit;

constexpr std::size_t texel(int i, int j, int k) {
  return GrainNoise::texel(i, j, k);
}

float random_value(int i, int j, int k, int octave) {
  const auto key = static_cast<std::uint64_t>((octave << 24) | (i << 16) | (j << 8) | k);
  return static_cast<float>(mix64(key + 1) >> 40) * (2.0f / 16777216) - 1;
}

/// Smooth value noise: cubic between random values that lie `period` texels apart.
float octave_value(int i, int j, int k, int period, int octave) {
  const int count = GrainNoise::side / period;
  const auto smooth = [&](int at) {
    const float t = static_cast<float>(at % period) / static_cast<float>(period);
    return t * t * (3 - 2 * t);
  };
  const float x = smooth(i), y = smooth(j), z = smooth(k);
  float sum = 0;
  for (int n = 0; n < 8; ++n) {
    const int a = n & 1, b = n >> 1 & 1, c = n >> 2;
    const float w = (a ? x : 1 - x) * (b ? y : 1 - y) * (c ? z : 1 - z);
    sum += w * random_value((i / period + a) % count, (j / period + b) % count,
                            (k / period + c) % count, octave);
  }
  return sum;
}

std::vector<float> heights(int octaves) {
  std::vector<float> height(texel(-1, -1, -1) + 1);
  for (int k = 0; k < GrainNoise::side; ++k)
    for (int j = 0; j < GrainNoise::side; ++j)
      for (int i = 0; i < GrainNoise::side; ++i) {
        float sum = 0, amplitude = 0.6f;
        for (int octave = 0, period = texels_per_unit; octave < octaves; ++octave, period /= 2) {
          sum += amplitude * octave_value(i, j, k, period, octave);
          amplitude *= 0.6f;
        }
        height[texel(i, j, k)] = sum;
      }
  // The mean is taken away, so that relief neither lightens nor darkens snow.
  const float mean =
      std::accumulate(height.begin(), height.end(), 0.0f) / static_cast<float>(height.size());
  for (float& h : height) h -= mean;
  return height;
}

}  // namespace

GrainNoise::GrainNoise() {
  for (int level = 0; level < levels; ++level) {
    const std::vector<float> height = heights(levels - level);
    std::vector<float>& to = levels_[static_cast<std::size_t>(level)];
    to.reserve(4 * height.size());
    constexpr float per_unit = 0.5f * texels_per_unit;
    for (int k = 0; k < side; ++k)
      for (int j = 0; j < side; ++j)
        for (int i = 0; i < side; ++i)
          to.insert(to.end(),
                    {height[texel(i, j, k)],
                     per_unit * (height[texel(i + 1, j, k)] - height[texel(i - 1, j, k)]),
                     per_unit * (height[texel(i, j + 1, k)] - height[texel(i, j - 1, k)]),
                     per_unit * (height[texel(i, j, k + 1)] - height[texel(i, j, k - 1)])});
  }
}

const GrainNoise& grain_noise() {
  static const GrainNoise noise;
  return noise;
}

}  // namespace neve::render::snow

/// Smooth edges of pictures with one sample for each pixel.

#include "render/image/smooth_edges.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace {

using neve::ThreadPool;
using neve::render::SmoothEdges;

constexpr int side = 96;

std::uint32_t grey(double value) {
  const auto byte = static_cast<std::uint32_t>(std::lround(255 * value));
  return 0xff000000u | byte << 16 | byte << 8 | byte;
}
double value_of(std::uint32_t color) {
  return (color & 0xff) / 255.0;
}

/// Light below a straight line, dark above. @param samples  per pixel and axis
std::vector<double> half_plane(double slope, int samples) {
  std::vector<double> picture;
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x) {
      double sum = 0;
      for (int k = 0; k < samples * samples; ++k) {
        const double u = x + (k % samples + 0.5) / samples, v = y + (k / samples + 0.5) / samples;
        sum += v < 0.4 * side + slope * (u - 0.5 * side) ? 0.6 : 0.2;
      }
      picture.push_back(sum / (samples * samples));
    }
  return picture;
}

double error_of(const std::vector<std::uint32_t>& picture, const std::vector<double>& exact) {
  double sum = 0;
  for (std::size_t k = 0; k < exact.size(); ++k)
    sum += std::pow(value_of(picture[k]) - exact[k], 2);
  return std::sqrt(sum / static_cast<double>(exact.size()));
}

std::vector<std::uint32_t> smoothed(const std::vector<std::uint32_t>& picture,
                                    ThreadPool* pool = nullptr) {
  SmoothEdges smooth;
  const std::uint32_t* out = smooth.of(picture.data(), side, side, side, pool);
  return {out, out + side * side};
}

std::vector<std::uint32_t> pixels_of(const std::vector<double>& values) {
  std::vector<std::uint32_t> picture;
  for (const double value : values) picture.push_back(grey(value));
  return picture;
}

/// The error is against the share of each pixel that the light half covers: a half and more of it
/// goes where a step is no longer than an edge is followed.
TEST(SmoothEdges, AStraightEdgeComesNearWhatItCovers) {
  for (const double slope : {0.1, 0.3, 0.7, 1.5, 8.0}) {
    const std::vector<double> exact = half_plane(slope, 16);
    const std::vector<std::uint32_t> picture = pixels_of(half_plane(slope, 1));
    EXPECT_LT(error_of(smoothed(picture), exact), 0.55 * error_of(picture, exact)) << slope;
  }
}

TEST(SmoothEdges, LevelEdgesAndGrainStayAsTheyAre) {
  std::vector<std::uint32_t> picture;
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x)
      picture.push_back(grey(y < 40 ? 0.2 : 0.85 + 0.04 * ((7 * x + 11 * y) % 3 - 1)));
  EXPECT_EQ(smoothed(picture), picture);
  const std::vector<std::uint32_t> one{grey(0.5)};
  SmoothEdges smooth;
  EXPECT_EQ(*smooth.of(one.data(), 1, 1, 1, nullptr), one[0]);
}

TEST(SmoothEdges, RowsMayLieApartAndThreadsDoNotMatter) {
  const std::vector<std::uint32_t> picture = pixels_of(half_plane(0.3, 1));
  constexpr int pitch = side + 5;
  std::vector<std::uint32_t> apart(pitch * side, 0x12345678);
  for (int y = 0; y < side; ++y)
    std::copy_n(picture.begin() + side * y, side, apart.begin() + pitch * y);
  ThreadPool pool(3);
  SmoothEdges smooth;
  const std::uint32_t* out = smooth.of(apart.data(), pitch, side, side, &pool);
  EXPECT_EQ(std::vector<std::uint32_t>(out, out + side * side), smoothed(picture));
}

}  // namespace

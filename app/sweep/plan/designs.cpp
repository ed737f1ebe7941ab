#include "app/sweep/plan/designs.h"

#include <algorithm>
#include <array>
#include <numeric>

#include "sim/base/hash.h"

namespace neve::app::sweep::plan {

namespace {

constexpr int bits = 32;

/// A primitive polynomial over the integers modulo 2, without its first and last coefficients, and
/// the first direction numbers.
struct Direction {
  int degree;
  std::uint32_t coefficients;
  std::array<std::uint32_t, 7> first;
};

/// new-joe-kuo-6, from the second axis on.
constexpr std::array<Direction, max_sobol_axes - 1> directions{{
    {1, 0, {1}},
    {2, 1, {1, 3}},
    {3, 1, {1, 3, 1}},
    {3, 2, {1, 1, 1}},
    {4, 1, {1, 1, 3, 3}},
    {4, 4, {1, 3, 5, 13}},
    {5, 2, {1, 1, 5, 5, 17}},
    {5, 4, {1, 1, 5, 5, 5}},
    {5, 7, {1, 1, 7, 11, 19}},
    {5, 11, {1, 1, 5, 1, 1}},
    {5, 13, {1, 1, 1, 3, 11}},
    {5, 14, {1, 3, 5, 5, 31}},
    {6, 1, {1, 3, 3, 9, 7, 49}},
    {6, 13, {1, 1, 1, 15, 21, 21}},
    {6, 16, {1, 3, 1, 13, 27, 49}},
    {6, 19, {1, 1, 1, 15, 7, 5}},
    {6, 22, {1, 3, 1, 15, 13, 25}},
    {6, 25, {1, 1, 5, 5, 19, 61}},
    {7, 1, {1, 3, 7, 11, 23, 15, 103}},
    {7, 4, {1, 3, 7, 13, 13, 15, 69}},
}};

using Directions = std::array<std::uint32_t, bits>;

/// Bit k of a sample's number flips the bits of v_k; the first axis is the van der Corput sequence.
Directions direction_numbers(std::size_t axis) {
  Directions v{};
  if (axis == 0) {
    for (int k = 0; k < bits; ++k) v[k] = std::uint32_t{1} << (bits - 1 - k);
    return v;
  }
  const Direction& d = directions[axis - 1];
  for (int k = 0; k < bits; ++k) {
    if (k < d.degree) {
      v[k] = d.first[k] << (bits - 1 - k);
      continue;
    }
    v[k] = v[k - d.degree] ^ (v[k - d.degree] >> d.degree);
    for (int j = 1; j < d.degree; ++j)
      if (d.coefficients >> (d.degree - 1 - j) & 1) v[k] ^= v[k - j];
  }
  return v;
}

std::uint32_t reversed(std::uint32_t x) {
  std::uint32_t out = 0;
  for (int k = 0; k < bits; ++k) out = out << 1 | (x >> k & 1);
  return out;
}

/// Each bit is flipped by a hash of the bits above it alone: halves, quarters, ... change places,
/// and every part of the interval keeps its share of the points.
std::uint32_t scrambled(std::uint32_t x, std::uint32_t seed) {
  std::uint32_t y = reversed(x);
  y += seed;
  y ^= y * 0x6c50b47cu;
  y ^= y * 0xb82f1e52u;
  y ^= y * 0xc7afe638u;
  y ^= y * 0x8d22f6e6u;
  return reversed(y);
}

}  // namespace

double sobol_place(std::uint32_t sample, std::size_t axis, std::uint64_t seed) {
  const Directions v = direction_numbers(axis);
  std::uint32_t x = 0;
  for (int k = 0; k < bits; ++k)
    if (sample >> k & 1) x ^= v[k];
  return scrambled(x, static_cast<std::uint32_t>(mix64(seed, axis))) * 0x1p-32;
}

std::vector<std::vector<int>> morris_trajectory(std::uint64_t trajectory, std::size_t axes,
                                                std::uint64_t seed) {
  const std::uint64_t own = mix64(seed, trajectory);
  std::vector<int> at(axes);
  for (std::size_t a = 0; a < axes; ++a)
    at[a] = static_cast<int>(unit_double(mix64(own, a)) * morris_levels);
  std::vector<std::size_t> order(axes);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return mix64(own + 1, a) < mix64(own + 1, b);
  });
  std::vector<std::vector<int>> points{at};
  for (const std::size_t a : order) {
    at[a] += at[a] < morris_step ? morris_step : -morris_step;
    points.push_back(at);
  }
  return points;
}

}  // namespace neve::app::sweep::plan

#pragma once
/// Conversions between particle records and Eigen's types.

#include <cmath>
#include <cstdint>

#include "sim/kernels/particles.h"
#include "sim/types/material.h"
#include "sim/types/math.h"

namespace neve::sim::engine {

/// Ids are signed words.
inline constexpr std::uint64_t max_ids = std::uint64_t(1) << 31;

/// Splits a coordinate in cells into the cell and the offset in it; the offset is below 1 also
/// after rounding to Real.
template <class Real>
void split(double in_cells, int& cell, Real& offset) {
  const double whole = std::floor(in_cells);
  cell = static_cast<int>(whole);
  offset = static_cast<Real>(in_cells - whole);
  if (offset >= Real(1)) {
    ++cell;
    offset = 0;
  }
}

template <class Real>
Vec3d vector(const Real* xyz) {
  return {static_cast<double>(xyz[0]), static_cast<double>(xyz[1]), static_cast<double>(xyz[2])};
}

template <class Real>
Mat3d matrix(const Real* row_by_row) {
  Mat3d m;
  for (int a = 0; a < 3; ++a)
    for (int b = 0; b < 3; ++b) m(a, b) = static_cast<double>(row_by_row[3 * a + b]);
  return m;
}

template <class Real>
void store_matrix(const Mat3d& m, Real* row_by_row) {
  for (int a = 0; a < 3; ++a)
    for (int b = 0; b < 3; ++b) row_by_row[3 * a + b] = static_cast<Real>(m(a, b));
}

}  // namespace neve::sim::engine

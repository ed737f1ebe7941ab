#pragma once
/// Particles from a file: PLY (ascii, binary of either byte order) or CSV with a header line.

#include <string>
#include <string_view>
#include <vector>

#include "sim/types/math.h"

namespace neve::sim::files {

/// Points in file order. v, m and V are as long as x, or empty if the file has none.
struct PointCloud {
  std::vector<Vec3d> x;   ///< m
  std::vector<Vec3d> v;   ///< m/s
  std::vector<double> m;  ///< kg, > 0
  std::vector<double> V;  ///< m3, > 0
};

/// Columns are found by name, in any order, case and punctuation: position x y z, or with
/// p, pos, position before the axis, or Points:0 to 2; velocity vx vy vz, or with vel, velocity;
/// mass m or mass; volume vol, volume or V0. Others are passed over. Independent of the locale.
/// @param name of the text in messages, NAME:LINE: ...; of binary points NAME: point NUMBER
/// @throws ShapeError for text neither PLY nor CSV, without positions, with a part of a vector
///         only or one column twice, truncated, with numbers that are missing, not finite or out of
///         range (|x| <= 1e6 m, |v| <= 1e6 m/s, mass and volume above 0 and up to 1e12), or without
///         points. Counts in a file are compared with its length before anything is allocated.
PointCloud parse_points(std::string_view bytes, const std::string& name);

/// Reads the element vertex, whose properties, and those of elements before it, are single numbers.
PointCloud parse_ply_points(std::string_view bytes, const std::string& name);

/// Fields are separated by commas, semicolons or tabs, the most frequent in the header, and may be
/// between double quotes; lines that are empty or start with # are passed over.
PointCloud parse_csv_points(std::string_view text, const std::string& name);

/// @throws ShapeError also when the file cannot be read or is larger than 1 GiB
PointCloud read_points(const std::string& path);

}  // namespace neve::sim::files

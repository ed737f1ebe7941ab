#pragma once
/// Polygons as triangles.

#include <array>
#include <optional>
#include <vector>

#include "sim/types/math.h"

namespace neve::sim::shapes {

/// Corners of a triangle, as indices of a polygon's corners.
using CornerTriple = std::array<std::size_t, 3>;

/// True if a fan from the first corner covers the polygon and nothing else.
bool is_convex(const std::vector<Vec3d>& polygon);

/// Cuts one ear after the other, seen along the normal of the polygon. Debian has no library for it
/// that C++ could use: earcut is there for Python alone, and poly2tri and CGAL's triangulation need
/// corners that differ, or exact arithmetic.
/// @param polygon  three corners or more, nearly in one plane
/// @return as many triangles as corners less two, wound as the polygon; nothing where its sides
/// cross
std::optional<std::vector<CornerTriple>> cut_ears(const std::vector<Vec3d>& polygon);

}  // namespace neve::sim::shapes

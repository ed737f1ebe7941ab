#pragma once
/// Evenly spaced streamlines of a field on a plane (Jobard and Lefer 1997).

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <vector>

namespace neve::app::picture {

/// The vector of a field at a place in the plane; empty where the field has no vector.
using PlaneField = std::function<std::optional<Eigen::Vector2d>(const Eigen::Vector2d&)>;

struct StreamlineStyle {
  double distance = 1;        ///< m, from line to line
  double step = 0.1;          ///< m, along a line
  double shortest = 1;        ///< m; shorter ones are left out
  Eigen::Vector2d low, high;  ///< m, corners of the region
};

/// A polygon along the field, in its direction.
using Streamline = std::vector<Eigen::Vector2d>;

/// Lines that keep half of the distance from each other and are about the distance apart; the same
/// for the same field.
std::vector<Streamline> streamlines(const PlaneField& field, const StreamlineStyle& style);

}  // namespace neve::app::picture

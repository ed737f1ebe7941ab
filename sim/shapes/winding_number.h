#pragma once
/// Generalized winding numbers of triangles: how often they enclose a point, a number between whole
/// ones where they do not close.
///
/// Source: Jacobson, Kavan, Sorkine-Hornung, Robust Inside-Outside Segmentation using Generalized
/// Winding Numbers, 2013; Barill et al., Fast Winding Numbers for Soups and Clouds, 2018, with
/// terms of the second order.

#include <array>
#include <cstdint>
#include <vector>

#include "sim/shapes/mesh.h"

namespace neve::sim::shapes {

class WindingNumber {
 public:
  /// Refers to them.
  WindingNumber(const std::vector<Vec3d>& vertices,
                const std::vector<std::array<std::uint32_t, 3>>& triangles);

  /// Returns the winding number about p, to some 1e-3.
  /// @param looked  if given, more by the triangles that were looked at one by one
  double at(const Vec3d& p, std::size_t* looked = nullptr) const;

 private:
  /// Triangles of a box, as they look from far away.
  struct Node {
    std::uint32_t first, end;       ///< of order_
    std::uint32_t children = 0;     ///< of two nodes in a row, the first; 0: none
    Vec3d middle{0, 0, 0};          ///< by area
    double radius = 0;              ///< m, from the middle to the furthest corner
    Vec3d normals{0, 0, 0};         ///< m2, areas times normals, summed
    Mat3d moments = Mat3d::Zero();  ///< m3, of the normals about the middle
  };

  void build(std::uint32_t node);
  void sum_up(Node& node) const;
  Vec3d middle_of(std::uint32_t triangle) const;

  const std::vector<Vec3d>& vertices_;
  const std::vector<std::array<std::uint32_t, 3>>& triangles_;
  std::vector<std::uint32_t> order_;
  std::vector<Node> nodes_;
};

/// Sets the volume of a mesh with Inside::above_half, by samples to about 0.5 %, its moments by the
/// same ones where not all faces together have them, and the share of it that is in doubt; turns
/// all faces where they are wound inward.
/// @param name  only for errors
/// @throws ShapeError where each question would look at thousands of triangles
void measure_winding(SolidMesh& mesh, const std::string& name);

}  // namespace neve::sim::shapes

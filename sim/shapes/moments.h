#pragma once
/// Volume of a region and its moments: what its mass, centre of mass and inertia follow from.

#include <Eigen/Geometry>

#include "sim/types/math.h"

namespace neve::sim::shapes {

/// Of what is added, about a place.
struct Moments {
  Vec3d from{0, 0, 0};           ///< m, the place
  double volume = 0;             ///< m3
  Vec3d first{0, 0, 0};          ///< m4
  Mat3d second = Mat3d::Zero();  ///< m5

  /// The tetrahedron between the place and a triangle, which is negative if the triangle looks at
  /// the place. All faces of a polyhedron together are the polyhedron.
  /// Source: Eberly, Polyhedral mass properties (revisited), 2002.
  void add_tetrahedron(const Vec3d& a, const Vec3d& b, const Vec3d& c, double times = 1) {
    const Vec3d u = a - from, v = b - from, w = c - from;
    const double part = times * u.dot(v.cross(w)) / 6;
    const Vec3d sum = u + v + w;
    volume += part;
    first += part / 4 * sum;
    second += part / 20 *
              (u * u.transpose() + v * v.transpose() + w * w.transpose() + sum * sum.transpose());
  }

  void add_point(const Vec3d& at, double part) {
    const Vec3d arm = at - from;
    volume += part;
    first += part * arm;
    second += part * arm * arm.transpose();
  }

  /// A rod along x of a thin cross section. @param middle  of it
  void add_rod(const Vec3d& middle, double length, double area) {
    add_point(middle, length * area);
    second(0, 0) += length * area * length * length / 12;
  }

  /// @param other  about the same place
  void add(const Moments& other, double times) {
    volume += times * other.volume;
    first += times * other.first;
    second += times * other.second;
  }

  void scale(double factor) {
    const double cube = factor * factor * factor;
    from *= factor;
    volume *= cube;
    first *= cube * factor;
    second *= cube * factor * factor;
  }
};

}  // namespace neve::sim::shapes

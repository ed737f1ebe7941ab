#pragma once
/// Places that the kernels leave out of contact, against the distances of the host.

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "sim/kernels/contact.h"
#include "sim/types/math.h"

namespace neve::test {

/// True where the kernels leave a ball of places out. Then none of them may touch.
/// @param from      centre of the ball, from the first node of the block
/// @param slack     m, of single precision
/// @param distance  of a place, from the centre, to the surface
template <class Distance>
bool is_left_out(const sim::kernels::LocalCollider<float>& local, const sim::Vec3d& from,
                 double reach, double slack, std::mt19937& random, const Distance& distance) {
  if (!sim::kernels::is_out_of_reach(
          local,
          Vec3<float>{static_cast<float>(from[0]), static_cast<float>(from[1]),
                      static_cast<float>(from[2])},
          static_cast<float>(reach)))
    return false;
  std::uniform_real_distribution<double> unit(-1, 1);
  for (int q = 0; q < 20; ++q) {
    sim::Vec3d way(unit(random), unit(random), unit(random));
    way *= std::abs(unit(random)) * (reach - slack) / way.norm();
    EXPECT_GT(distance(way), 0);
  }
  return true;
}

}  // namespace neve::test

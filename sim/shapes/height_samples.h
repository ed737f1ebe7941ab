#pragma once
/// Heights of posts as kernels read them: no standard header, plain data.

namespace neve::sim::shapes {

/// Distance to ground that is missing: more than any scene is wide. m
inline constexpr double no_ground = 1e9;

/// Posts on a square grid in the x-z plane of a terrain, about its point. Plain data.
struct HeightSamples {
  const float* height = nullptr;  ///< m above datum; x runs fastest, then z; NaN: no ground
  int columns = 0, rows = 0;      ///< at least 2: along x and z
  double spacing = 0;             ///< m
  double first[2] = {0, 0};       ///< m, x and z of the first post from the terrain's point
  double datum = 0;               ///< m, y from the terrain's point
  double highest = 0;             ///< m above datum
  double flattest = 1;  ///< y of the normal where the ground is steepest: a height above it times
                        ///< this is no more than the distance; 0: it has holes
};

}  // namespace neve::sim::shapes

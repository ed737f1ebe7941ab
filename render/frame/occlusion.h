#pragma once
/// Finds spheres that cannot be seen because nearer ones cover them, before they cost fragments: in
/// packed snow that is nearly all of them. Never leaves out a sphere that would show in a sample.

#include <vector>

#include "render/frame/view.h"

namespace neve::render {

/// Square tiles of the picture, each with a depth behind which nothing can be seen.
class OcclusionGrid {
 public:
  /// @param typical_radius of spheres on the picture, samples; sets the size of the tiles
  OcclusionGrid(const View& view, float typical_radius);

  /// True if nearer spheres cover everything within reach of a place.
  /// @param x, y, reach samples, y up; @param nearest distance along the view, m
  bool hides(float x, float y, float reach, float nearest) const;

  /// Notes that a whole disc is covered.
  /// @param farthest distance along the view of its farthest visible point, m
  void cover(float x, float y, float radius, float farthest);

 private:
  /// Tiles that [low, high] touches, clamped to the picture.
  struct Span {
    int first, last;
  };
  Span touched(float low, float high, int count) const;

  float tile_;  ///< samples
  int columns_, rows_;
  std::vector<float> limit_;
};

}  // namespace neve::render

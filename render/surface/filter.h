#pragma once
/// Spreads the values of a field along its axes.

#include "render/surface/field.h"

namespace neve::render::surface {

/// Symmetric weights that sum to 1; the weight of k nodes away.
struct Filter {
  int radius = 0;  ///< at most 7: a pass reaches no further than the next block
  int passes = 0;
  std::array<float, 8> weight{};

  int reach() const { return radius * passes; }
};

/// Makes one of this variance, in squared cells, along an axis. Sums of three neighbours, repeated,
/// are close to a Gaussian and never negative.
Filter make_filter(double variance);

void apply(const Filter& filter, Field& field, ThreadPool* pool);

}  // namespace neve::render::surface

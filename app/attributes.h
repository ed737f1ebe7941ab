#pragma once
/// Values per particle that colours show.

#include <vector>

#include "app/frame_builder.h"

namespace neve::app {

struct AttributeName {
  const char* title;
  const char* unit;
};
AttributeName attribute_name(ColorBy color_by);

/// One value per particle in id order; empty for snow shade.
std::vector<double> attribute_values(const Scene& scene, ColorBy color_by,
                                     const Snapshot& snapshot);

}  // namespace neve::app

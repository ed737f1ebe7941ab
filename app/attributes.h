#pragma once
/// Values per particle that colours show.

#include <vector>

#include "app/scene/scene.h"

namespace neve::app {

struct Snapshot;

struct AttributeName {
  const char* title;
  const char* unit;
};
AttributeName attribute_name(ColorBy color_by);
AttributeName attribute_name(ScalarField field);
AttributeName attribute_name(VectorField field);

/// What particles carry that makes a field of nodes.
ColorBy attribute_of(ScalarField field);

/// One value per particle in id order; empty for snow shade.
std::vector<double> attribute_values(const Scene& scene, ColorBy color_by,
                                     const Snapshot& snapshot);

}  // namespace neve::app

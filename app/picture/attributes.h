#pragma once
/// Per-particle scalars for colouring.

#include <vector>

#include "app/scene/scene.h"

namespace neve::app::picture {

struct Snapshot;

struct AttributeName {
  const char* title;
  const char* unit;
};
AttributeName attribute_name(scene::ColorBy color_by);
AttributeName attribute_name(scene::ScalarField field);
AttributeName attribute_name(scene::VectorField field);

/// One value per particle in id order; empty for snow shade.
std::vector<double> attribute_values(const scene::Scene& scene, scene::ColorBy color_by,
                                     const Snapshot& snapshot);

}  // namespace neve::app::picture

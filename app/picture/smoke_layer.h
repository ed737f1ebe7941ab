#pragma once
/// The mass on the grid as smoke.

#include "app/picture/node_fields.h"
#include "app/scene/scene.h"

namespace neve::app::picture {

/// @param fields with the mass and the colouring field, see field_needs; none: no smoke
void add_smoke(const scene::Scene& scene, const scene::View& view, const FieldSamples& fields,
               render::Frame& frame);

}  // namespace neve::app::picture

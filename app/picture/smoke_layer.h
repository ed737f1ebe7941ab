#pragma once
/// The mass on the grid as smoke, and dust as smoke.

#include "app/picture/node_fields.h"
#include "app/scene/scene.h"
#include "sim/types/dust.h"

namespace neve::app::picture {

/// kg/m3, of packed snow: that of the densest material in use.
double packed_density(const scene::Scene& scene);

/// @param fields with the mass and the colouring field, see field_needs; none: no smoke
void add_smoke(const scene::Scene& scene, const scene::View& view, const FieldSamples& fields,
               render::Frame& frame);

/// The dust in the place of the smoke; without any the frame stays as it is.
void add_dust(const scene::View& view, const sim::DustArrays& dust, render::Frame& frame);

}  // namespace neve::app::picture

#pragma once
/// Colour bars that a view needs.

#include <vector>

#include "app/scene/scene.h"
#include "render/frame/frame.h"

namespace neve::app::picture {

/// One for each thing that the view colours by a value, and for white smoke.
/// @param view   resolved: it has ranges
/// @param drawn  has the values: a legend says where some lie beyond its range; empty for one that
///               pictures share
std::vector<render::Legend> legends_of(const scene::Scene& scene, const scene::View& view,
                                       const render::Frame& drawn = {});

}  // namespace neve::app::picture

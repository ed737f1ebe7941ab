#pragma once
/// Legend of the smoke in a picture: the density that looks so white, and smoke that is left out.

#include <cstddef>

#include "render/frame/frame.h"

namespace neve::render {

/// A bar from no mass to twice that of packed snow: the grey that white smoke of this density has
/// through some cells, before a dark background. Twice the mass shows where the bar still rises.
/// @param full_density  kg/m3, see Smoke
Legend smoke_legend(float full_density, float density_scale);

/// Blocks of nodes with smoke that is not drawn, as it lies too far from the rest.
std::size_t smoke_left_out(const Smoke& smoke);

}  // namespace neve::render

#pragma once
/// How dense smoke has to be to look so white.

#include "render/frame/frame.h"

namespace neve::render {

/// A bar from no mass to twice that of packed snow: the grey that white smoke of this density has
/// through some cells, before a dark background. Where the bar still rises, twice the mass shows.
/// @param full_density  kg/m3, see Smoke
Legend smoke_legend(float full_density, float density_scale);

}  // namespace neve::render

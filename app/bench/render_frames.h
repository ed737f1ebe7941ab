#pragma once
/// The pictures that `neve bench render` draws: the same ones on every machine.

#include "render/frame/frame.h"

namespace neve::app::bench {

/// A ball of packed points on a slab of them, on the ground, at 1280x720.
/// @param particles about so many
render::Frame particles_frame(double particles);

/// The same with all that a picture can show: smoke over 64^3 nodes, 961 arrows and a heat map on a
/// slice, a solid, a legend and a caption.
render::Frame all_layers_frame(double particles);

}  // namespace neve::app::bench

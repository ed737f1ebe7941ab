#pragma once
/// A picture behind a frame, and on it the shadows that fall on the frame's grounds.

#include "render/channels/gather.h"
#include "render/image/image.h"

namespace neve::render::channels {

/// Shares of the light that snow and colliders leave on the grounds, for each sample: 1 where there
/// is no ground or no shadow. @param lit  surfaces of a transparent frame with grounds
cpu::LinearSamples ground_shadow(const LitSurfaces& lit);

/// Lays surfaces over a plate. The plate stays as it is where there are neither surfaces nor
/// shadows.
/// @param front   of a transparent frame without grounds
/// @param shadow  of the same size @param plate  RGB, of the size of the frame
Image lay_over_plate(const cpu::LinearSamples& front, const cpu::LinearSamples& shadow,
                     const Frame& frame, const Image& plate);

}  // namespace neve::render::channels

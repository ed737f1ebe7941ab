#pragma once
/// Motion blur: the moments of a frame while the shutter is open.

#include "app/picture/motion.h"

namespace neve::app::picture {

/// Most moments of a frame. A picture is drawn for each.
inline constexpr int max_moments = 32;

/// Frames around the moment of the state: half of them before it. Each particle has its own phase
/// between two moments, so that fast snow leaves a streak and no row of copies. As many as pixels
/// that anything moves by; none if nothing moves by half a pixel. Smoke, slices, and lines that are
/// no wires stay.
/// @param source  outlives them
/// @param frame  of the source @param degrees  the shutter is open, of 360 for a whole frame
render::Moments shutter_moments(const MotionSource& source, const render::Frame& frame,
                                double degrees);

/// The same moments for their mean: where there are many, each has one sample of a pixel instead of
/// four, and together they have them all over the pixel.
render::Moments with_shared_samples(render::Moments moments);

}  // namespace neve::app::picture

#pragma once
/// How snow has turned.

#include "render/frame/turn.h"
#include "sim/types/math.h"

namespace neve::app::picture {

/// Rotation of F_E: its columns made orthogonal one after the other. Snow yields before F_E is far
/// from a rotation, so it differs from that of the polar decomposition by hundredths.
/// @return no turn where F_E has none
render::PackedTurn turn_of(const sim::Mat3d& F_E);

}  // namespace neve::app::picture

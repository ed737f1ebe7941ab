#pragma once
/// A slow move of an automatic camera towards the snow that has settled.

#include <optional>
#include <vector>

#include "app/setup/coarse_run.h"
#include "app/setup/framing.h"

namespace neve::app::setup {

struct PushIn {
  double begin, end;  ///< s
  Framing framing;    ///< at its end; the camera looks the same way as before
};

/// The camera sets out when most of the snow is where it is seen to the end, but at the middle of
/// the scene at the latest. It comes nearer by no more than half in a second, and arrives a little
/// before the end. Returns nothing if it comes hardly nearer, or if the coarse run ends too early
/// to say where the snow will lie.
/// @param moments  in order of time @param duration  s
std::optional<PushIn> push_in(const std::vector<CoarseMoment>& moments, const Shot& whole,
                              const Lens& lens, double duration);

}  // namespace neve::app::setup

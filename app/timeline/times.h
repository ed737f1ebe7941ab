#pragma once
/// Times of a film. People type them in decimals: a time that is a rounding error before the end of
/// a frame means its end.

#include <algorithm>
#include <cmath>
#include <string>

#include "app/scene/scene.h"

namespace neve::app::timeline {

inline constexpr double typed_rounding = 1 + 1e-12;

inline bool is_not_after(double time, double limit) {
  return time <= limit * typed_rounding;
}

/// The last frame that ends at a time or before it.
inline int frame_at(double time, double fps) {
  return static_cast<int>(std::min(std::floor(time * fps * typed_rounding), 1e9));
}

/// "; frame 24 is at 1 s" of a time in seconds that would be right as the number of a frame.
/// @param last  frame, counted from 0; "" for numbers of later ones
std::string advice_on_frame(double time, int last, const scene::Scene& scene);

}  // namespace neve::app::timeline

#pragma once
/// Times of a film. People type them in decimals: a time that is a rounding error before the end of
/// a frame means its end.

#include <algorithm>
#include <cmath>
#include <string>

#include "app/scene/scene.h"
#include "app/support/progress.h"
#include "app/support/text.h"

namespace neve::app::timeline {

inline constexpr double typed_rounding = 1 + 1e-12;

inline bool is_not_after(double time, double limit) {
  return time <= limit * typed_rounding;
}

/// The last frame that ends at a time or before it.
inline int frame_at(double time, double fps) {
  return static_cast<int>(std::min(std::floor(time * fps * typed_rounding), 1e9));
}

/// Warns of a last time behind the last frame of the scene: it is simulated, and was a mistake of
/// units more often than not. @param what  as it was typed: "--at 5 s"
inline void warn_of_late_time(const std::string& what, double time, const scene::Scene& scene,
                              Progress& progress) {
  const double end = scene::duration(scene);
  if (!is_not_after(time, end))
    progress.warning(what + " is after the end of the scene, " + rough_text(end) +
                     " s; Ctrl-C stops");
}

}  // namespace neve::app::timeline

#pragma once
/// A word on times that the film does not reach.

#include <string>

#include "app/scene/scene.h"
#include "app/support/progress.h"
#include "app/support/text.h"

namespace neve::app::run {

/// Warns of a last time behind the last frame of the scene: it is simulated, and was a mistake of
/// units more often than not. @param what  as it was typed: "--at 5 s"
inline void warn_of_late_time(const std::string& what, double time, const scene::Scene& scene,
                              Progress& progress) {
  const double end = scene.frames / scene.fps;
  if (time > end * (1 + 1e-12))
    progress.warning(what + " is after the end of the scene, " + rough_text(end) +
                     " s; Ctrl-C stops");
}

}  // namespace neve::app::run

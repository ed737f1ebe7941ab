#include "app/timeline/times.h"

#include <fmt/core.h>

#include "app/support/text.h"

namespace neve::app::timeline {

std::string advice_on_frame(double time, int last, const scene::Scene& scene) {
  const int first = scene::number_of(scene, 0);
  if (time != std::floor(time) || time < first || time > first + last) return {};
  return fmt::format("; frame {} is at {} s", time, rough_text((time - first) / scene.fps));
}

}  // namespace neve::app::timeline

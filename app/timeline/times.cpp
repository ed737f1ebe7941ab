#include "app/timeline/times.h"

#include <fmt/core.h>

#include "app/support/text.h"

namespace neve::app::timeline {

std::string advice_on_frame(double time, int last, double fps) {
  if (time != std::floor(time) || time > last) return {};
  return fmt::format("; frame {} is at {} s", time, rough_text(time / fps));
}

}  // namespace neve::app::timeline

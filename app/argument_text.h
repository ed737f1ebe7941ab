#pragma once
/// The little languages of flag values.

#include <string>

#include "app/plan.h"

namespace neve::app {

/// "1-48", or "48" for 0-48. @throws UsageError
FrameRange parse_frames(const std::string& text);

/// "2", "1.5": a number; coarsen() says which can be used. @throws UsageError
double parse_coarsening(const std::string& text);

/// "1280x720". @throws UsageError
PictureSize parse_size(const std::string& text);

}  // namespace neve::app

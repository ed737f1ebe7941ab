#pragma once
/// The little languages of flag values.

#include <string>

#include "app/commands.h"
#include "app/plan.h"

namespace neve::app {

/// "1-48", or "48" for 0-48. @throws UsageError
FrameRange parse_frames(const std::string& text);

/// "2", "1.5": a number; coarsen() says which can be used. @throws UsageError
double parse_coarsening(const std::string& text);

/// "1280x720". @throws UsageError
PictureSize parse_size(const std::string& text);

/// "0.25s", "0.25": seconds, at least 0. @throws UsageError
double parse_time(const std::string& text);

/// A stage of the step by its name. @throws UsageError with the nearest
sim::Stage parse_stage(const std::string& text);

/// "17": a particle; "0.1,0.5,0": a place in metres. @throws UsageError
Probe parse_probe(const std::string& text);

/// "table" or "vtk". @throws UsageError
DumpFormat parse_format(const std::string& text);

}  // namespace neve::app

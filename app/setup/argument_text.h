#pragma once
/// The little languages of flag values.

#include <optional>
#include <string>
#include <vector>

#include "app/setup/plan.h"

namespace neve::app::setup {

/// A finite number that is all of the text.
std::optional<double> finite_number(const std::string& text);

/// "1-48", or "48" for 0-48. @throws UsageError
FrameRange parse_frames(const std::string& text);

/// "2", "1.5": a number; coarsen() says which can be used. @throws UsageError
double parse_coarsening(const std::string& text);

/// "1280x720". @throws UsageError
scene::PictureSize parse_size(const std::string& text);

/// "0.25s", "0.25": seconds, at least 0. @param flag  that has it @throws UsageError
double parse_time(const std::string& text, const char* flag = "--at");

/// "0.1,0.2s": such times, each later than the one before. @throws UsageError
std::vector<double> parse_times(const std::string& text);

/// "a,b" without empty words.
std::vector<std::string> comma_separated(const std::string& text);

}  // namespace neve::app::setup

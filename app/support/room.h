#pragma once
/// "May I have this much memory?": asked before anything is allocated whose size a file, a picture
/// or a flag names.

#include <string>

namespace neve::app {

/// The variable that --max-memory sets, for this process and those that it starts.
inline constexpr const char* memory_cap_name = "NEVE_MAX_MEMORY";

/// Bytes that one piece of work may take: 80 % of the available memory, and at most the cap.
double memory_room();

/// @param what   that needs the memory: "the picture of 16384x16384 pixels"
/// @param place  file or flag that the size comes from
/// @throws LimitError
void require_room(double bytes, const std::string& what, const std::string& place,
                  const std::string& advice = {});

}  // namespace neve::app

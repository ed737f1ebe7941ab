#pragma once
/// Rates of film and television.

#include <string>

namespace neve::app {

/// 23.976, 23.98, 29.97, 47.952, 59.94 and 119.88 mean n x 1000/1001 frames a second, which has no
/// end in decimals; other rates are what they are.
double exact_rate(double fps);

/// "23.976", "24", "12.5": as people write it.
std::string plain_rate(double fps);

/// "0.042 s": the time of a frame, to as many digits as tell it from the next one, three at least.
std::string time_text(double seconds, double fps);

/// "24000/1001", "24", "12.5": as ffmpeg reads it.
std::string rate_text(double fps);

}  // namespace neve::app

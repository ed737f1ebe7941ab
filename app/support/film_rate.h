#pragma once
/// Rates of film and television, and their time codes: HH:MM:SS:FF, with a semicolon before FF
/// where numbers are dropped.

#include <optional>
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

/// Frames since 00:00:00:00 of a time code at a rate; absent: it is none, or none of that rate.
/// Source: SMPTE 12M; drop codes, of 29.97 and 59.94 alone, leave out the first two or four numbers
/// of each minute but every tenth.
std::optional<long> frames_of_time_code(const std::string& text, double fps);

/// The time code of so many frames, within 24 hours; "" at a rate that has none, as 12.5.
std::string time_code_text(long frames, double fps, bool drops);

/// True where the numbers of a time code are dropped.
bool drops_numbers(const std::string& time_code);

}  // namespace neve::app

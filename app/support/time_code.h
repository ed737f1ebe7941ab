#pragma once
/// Time codes of film and television: HH:MM:SS:FF, with a semicolon before FF where numbers are
/// dropped.

#include <optional>
#include <string>

namespace neve::app {

/// Frames since 00:00:00:00 of a time code at a rate; absent: it is none, or none of that rate.
/// Source: SMPTE 12M; drop codes, of 29.97 and 59.94 alone, leave out the first two or four numbers
/// of each minute but every tenth.
std::optional<long> frames_of_time_code(const std::string& text, double fps);

/// The time code of so many frames, within 24 hours; "" at a rate that has none, as 12.5.
std::string time_code_text(long frames, double fps, bool drops);

/// True where the numbers of a time code are dropped.
bool drops_numbers(const std::string& time_code);

}  // namespace neve::app

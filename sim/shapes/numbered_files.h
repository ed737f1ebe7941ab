#pragma once
/// Paths of files that are numbered one after another.

#include <string>

namespace neve::sim::shapes {

/// Largest number of a file.
inline constexpr int max_file_number = 999999;
inline constexpr int max_numbered_files = 10000;  ///< in one sequence

/// True if the name of the file, not its folder, says once where the number goes: %d or $F; %04d,
/// $F4 or #### for at least four digits (1 to 9; as many # as wanted). It has no other %, # or $.
bool is_file_pattern(const std::string& pattern);

/// The path with that number. @param pattern  see is_file_pattern
std::string numbered_file(const std::string& pattern, int number);

}  // namespace neve::sim::shapes

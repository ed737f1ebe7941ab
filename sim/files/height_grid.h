#pragma once
/// Limits that the readers of height fields have in common.

namespace neve::sim::files {

/// Posts along one side, and of the whole grid: 400 MB.
inline constexpr double max_posts_a_side = 100000, max_posts = 1e8;
/// Heights and coordinates beyond are a mistake in the file, m.
inline constexpr double max_height = 1e5, max_map_coordinate = 1e8;

}  // namespace neve::sim::files

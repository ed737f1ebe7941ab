#pragma once
/// Places of samples in the unit cube, for sweeps of several parameters.

#include <cstdint>
#include <vector>

namespace neve::app::sweep::plan {

/// Axes that a Sobol sequence has here.
inline constexpr std::size_t max_sobol_axes = 21;

/// A coordinate of a point of the Sobol sequence (Sobol 1967; direction numbers of Joe and Kuo
/// 2008), scrambled after Owen (1995) by hashing (Burley 2020). A sequence of n points is the
/// beginning of one of 2 n points.
/// @param axis  below max_sobol_axes
/// @return in [0, 1)
double sobol_place(std::uint32_t sample, std::size_t axis, std::uint64_t seed);

/// Levels of a parameter in a screening, and how many a step goes at once.
inline constexpr int morris_levels = 4, morris_step = 2;

/// One trajectory of a screening after Morris (1991): each point differs from the one before on one
/// axis, by morris_step levels, and each axis has its turn once.
/// @return axes + 1 points of levels 0 to morris_levels - 1
std::vector<std::vector<int>> morris_trajectory(std::uint64_t trajectory, std::size_t axes,
                                                std::uint64_t seed);

}  // namespace neve::app::sweep::plan

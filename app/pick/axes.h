#pragma once
/// The parameters that a search varies, as axes of the unit cube.

#include <string>
#include <vector>

#include "app/pick/search/preference.h"
#include "app/scene/override.h"
#include "app/sweep/read/sweep.h"

namespace neve::app::pick {

inline constexpr std::size_t max_axes = 8;

/// A number between two ends, in equal steps or in equal ratios.
struct PickAxis {
  std::string address, name, unit;  ///< the name is short
  double low = 0, high = 1;
  bool is_logarithmic = false, is_whole = false;

  /// @param u place on the axis, 0 to 1
  double value(double u) const;
  /// The value as it is given to runs: six digits.
  std::string text(double u) const;
};

/// Returns the axis of each -p, from its least value to its greatest. It is in ratios where they
/// are a factor of ten or more apart, or where the rule says so (log_uniform, logspace).
/// @throws UsageError for parameters that are no numbers, for a single value, and for more than
///         max_axes
std::vector<PickAxis> axes_of(const sweep::read::Sweep& sweep);

/// "ADDRESS=5,20" for "ADDRESS=5..20", "ADDRESS=5:20" and "ADDRESS=5-20"; anything else as it is.
std::string with_two_ends(const std::string& axis);

/// Settings of the run at a place.
std::vector<scene::Override> settings_at(const std::vector<PickAxis>& axes,
                                         const search::Point& place);

}  // namespace neve::app::pick

#pragma once
/// Scale of a parameter's slider, from its description; the only place that decides it.

#include <optional>
#include <string>

#include "app/scene/valid.h"

namespace neve::app::view::panels {

struct SliderScale {
  enum class Kind {
    drag,        ///< no ends: changes by a share of itself
    linear,      ///< from end to end
    logarithmic  ///< decades around the usual value, without one from end to end; where 0 is
                 ///< allowed it is the lower end
  };
  Kind kind = Kind::drag;
  double low = 0, high = 0;     ///< ends of the slider
  bool is_zero_at_low = false;  ///< the lower end means 0
};

/// @param usual  the default
/// @param value  present; a slider reaches so far in any case
SliderScale slider_scale(const scene::Valid& valid, const std::optional<double>& usual,
                         double value);

/// Place of a value on a slider, 0 at its left end, 1 at its right one.
double share_of(const SliderScale& scale, double value);

/// The smallest and the largest value that is allowed.
double least(const scene::Valid& valid);
double greatest(const scene::Valid& valid);

/// The default of a parameter that is a number; nothing for other addresses.
std::optional<double> usual_number(const std::string& address);

}  // namespace neve::app::view::panels

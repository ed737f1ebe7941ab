#pragma once
/// `neve view --live`: cells and steps with which simulated time keeps up with the clock.

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "app/forecast/fast.h"
#include "app/scene/scene.h"

namespace neve::app::predict {

struct LiveChoice {
  double coarsening = 1;                   ///< of --coarsen
  std::optional<forecast::FastLook> fast;  ///< of --fast, where it is taken
  double pace = 0;                         ///< s that a second of the film takes, by a forecast

  /// Drawing without a GPU takes about twice what a coarse simulation takes, on the same cores; the
  /// rest is for what no forecast sees.
  static constexpr double room = 0.25;
  bool keeps_up() const { return pace <= 1; }
  /// "--fast --coarsen 1.75: a second of the film takes about 0.7 s on this machine"
  std::string sentence() const;
};

/// s that a second of the film takes to simulate on this machine.
using Pace = std::function<double(const scene::Scene&)>;
Pace measured_pace(int threads);

/// Tries the scene as it is, then with the steps of --fast, then with cells as large as it takes,
/// in quarters, as far as each body keeps a particle.
/// @param last  frame of the film
/// @param chosen  addresses that the user has set, which stay
LiveChoice choose_live(const scene::Scene& scene, int last, const std::vector<std::string>& chosen,
                       const Pace& pace);

}  // namespace neve::app::predict

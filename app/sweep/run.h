#pragma once
/// One sweep, from the plan to the report.

#include <string>
#include <vector>

#include "app/scene/override.h"
#include "app/setup/plan.h"

namespace neve::app::sweep {

/// A run as the sweep file asks for it, then as it was planned, then as it is on disk:
/// DIR/manifest.json keeps all of it.
struct Run {
  int index = 0;
  std::string label;                      ///< of a [[run]] or a labelled value
  std::vector<scene::Override> settings;  ///< without the fixed ones
  /// The values in which the scene of a run that forks differs at the fork from its beginning.
  std::vector<scene::Override> changes{};
  std::vector<int> coordinates;  ///< place on each axis of a grid; empty: on none

  setup::FrameRange frames;
  double particles = 0;  ///< foreseen
  double memory = 0;     ///< foreseen bytes of its process
  double work = 0;       ///< foreseen cost, in explicit steps of one particle

  std::string folder;  ///< "0007", under DIR/runs
  std::string key;     ///< of its scene, version and frames
  /// Values of its scene for parameters that only other runs set.
  std::vector<scene::Override> inherited;

  /// "" if the run leaves it to the scene.
  std::string setting(const std::string& address) const;
  /// The run's own or the scene's; "" if neither has one.
  std::string value(const std::string& address) const;
};

/// A parameter that some run sets.
struct Parameter {
  std::string address, name, unit, type;
};

}  // namespace neve::app::sweep

#pragma once
/// Materials that cards are asked for.

#include <vector>

#include "app/card/card_options.h"
#include "app/card/experiment.h"
#include "app/timeline/origin.h"

namespace neve::app::card {

/// A material with the scene that it is from.
struct Source {
  Subject subject;
  std::string name;  ///< of the scene or preset
  timeline::Origin origin;
};

/// Of scenes, then of presets. @throws SceneError, UsageError, IoError, Error
std::vector<Source> sources_of(const CardOptions& options);

}  // namespace neve::app::card

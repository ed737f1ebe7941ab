#pragma once
/// Materials that cards are asked for.

#include <string>
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

/// A material as its scene begins: a curve of one of its numbers has the word.
/// @throws std::runtime_error when the scene has none of the name
Subject subject_at_start(const scene::Scene& scene, const std::string& material,
                         const std::string& title);

/// Lists the sources of scenes, then of presets. @throws SceneError, UsageError, IoError, Error
std::vector<Source> sources_of(const CardOptions& options);

}  // namespace neve::app::card

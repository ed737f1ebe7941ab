#pragma once
/// What no single parameter can tell: values that do not go together.

#include <optional>
#include <string>

#include "app/scene/scene.h"

namespace neve::app::scene {

struct Problem {
  std::string address;  ///< of the parameter to blame, "" for the scene
  std::string message, hint;
};

/// The first thing wrong with a scene whose parameters are each in range.
std::optional<Problem> find_problem(const Scene& scene);

}  // namespace neve::app::scene

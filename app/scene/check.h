#pragma once
/// Problems of several parameters together: values that contradict each other.

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

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

/// The steps of a run mix the ids of several emitters.
inline bool mixes_emitters(const Scene& scene) {
  return scene.emitters.size() > 1;
}
inline constexpr const char* mixed_emitters =
    "the state does not say which of several emitters a particle comes from";

/// The first thing wrong with a scene whose parameters are each in range.
std::optional<Problem> find_problem(const Scene& scene);

}  // namespace neve::app::scene

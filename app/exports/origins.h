#pragma once
/// The body or emitter that a particle comes from, and when: both follow from its id.

#include <cstdint>
#include <string>
#include <vector>

#include "app/scene/scene.h"

namespace neve::app::exports {

class Origins {
 public:
  /// @param body_end  for each body the id after its last particle
  Origins(const scene::Scene& scene, const std::vector<std::size_t>& body_end);

  /// Number of the body in the scene, from 0; emitters are counted after the bodies.
  int body_of(std::uint32_t id) const;
  /// s; 0 for particles of bodies
  double birth_of(std::uint32_t id) const;

 private:
  std::vector<std::size_t> body_end_;
  double start_ = 0, period_ = 0;  ///< s, of the emitter's births
};

/// Names of bodies and emitters, in the order of Origins::body_of.
std::vector<std::string> origin_names(const scene::Scene& scene);

/// True where ids say which emitter a particle comes from. The steps of a run mix the ids of
/// several emitters.
bool knows_emitters(const scene::Scene& scene);

}  // namespace neve::app::exports

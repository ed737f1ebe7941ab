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

  /// For each body the id after its last particle.
  const std::vector<std::size_t>& body_end() const { return body_end_; }
  /// Number of the body in the scene, from 0; emitters are counted after the bodies.
  int body_of(std::uint32_t id) const;
  /// s, when the birth was due: one that had to wait for room came later. 0 for particles of bodies
  double birth_of(std::uint32_t id) const;

 private:
  std::vector<std::size_t> body_end_;
  double start_ = 0, period_ = 0;  ///< s, of the emitter's births
};

}  // namespace neve::app::exports

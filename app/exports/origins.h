#pragma once
/// The body or emitter that a particle comes from, and when: both follow from its id.

#include <cstdint>
#include <string>
#include <vector>

#include "app/scene/scene.h"
#include "sim/types/particle_arrays.h"

namespace neve::app::exports {

class Origins {
 public:
  /// @param body_end  for each body the id after its last particle
  Origins(const scene::Scene& scene, const std::vector<std::size_t>& body_end);

  /// Indices of the particles of these bodies and emitters; of all where none is named.
  std::vector<std::size_t> rows_of(const std::vector<std::string>& bodies,
                                   const sim::ParticleArrays& particles) const;

  /// Bodies, then emitters.
  const std::vector<std::string>& names() const { return names_; }
  /// The id after the last particle of each body.
  const std::vector<std::size_t>& body_end() const { return body_end_; }
  /// Number of the body in the scene, from 0; emitters are counted after the bodies.
  int body_of(std::uint32_t id) const;
  /// True for the snow of emitters.
  bool is_born(std::uint32_t id) const { return id >= first_born(); }
  /// s, of an emitter that never waited for room; 0 for particles of bodies
  double birth_of(std::uint32_t id) const;

 private:
  std::size_t first_born() const { return body_end_.empty() ? 0 : body_end_.back(); }
  std::vector<std::string> names_;
  std::vector<std::size_t> body_end_;
  double start_ = 0, period_ = 0;  ///< s, of the emitter's births
};

}  // namespace neve::app::exports

#pragma once
/// Camera-independent work on smoke, kept while the smoke is unchanged: several views of one state,
/// and a view that turns, share it.

#include <cstdint>
#include <optional>

#include "render/light/smoke_volume.h"

namespace neve::render::light {

class SmokeCache {
 public:
  /// Returns the grid of smoke, valid until the next call. @param pool may be null
  const SmokeGrid& grid(const Smoke& smoke, ThreadPool* pool);
  /// Volume of the grid requested last, which is not empty. @param light made by Lighting for that
  /// grid
  const SmokeVolume& volume(const LightVolume& light, Vec3f toward_light, ThreadPool* pool);

  /// Number of times that grids and volumes were computed.
  std::uint64_t renewals() const { return renewals_; }

 private:
  std::optional<Smoke> inputs_;  ///< of grid_, without what only its pictures depend on
  SmokeGrid grid_;
  SmokeVolume volume_;
  std::uint64_t renewals_ = 0;
  std::uint64_t light_ = 0;  ///< serial of the light in volume_; 0: none
};

}  // namespace neve::render::light

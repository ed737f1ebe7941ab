#pragma once
/// What becomes of smoke before a camera looks at it, kept for as long as nothing in it changes:
/// several views of one state, and one view that is turned, share it.

#include <cstdint>
#include <memory>

#include "render/light/smoke_volume.h"

namespace neve::render::light {

class SmokeCache {
 public:
  SmokeCache();
  ~SmokeCache();
  /// Valid until the next call. @param pool may be null
  const SmokeGrid& grid(const Smoke& smoke, ThreadPool* pool);
  /// Of the grid asked for last, which is not empty. @param light made by Lighting for that grid
  const SmokeVolume& volume(const LightVolume& light, Vec3f toward_light, ThreadPool* pool);

  /// How often grids and volumes were made anew.
  std::uint64_t renewals() const { return renewals_; }

 private:
  /// All that a grid depends on, to be compared byte by byte.
  struct Key;
  std::unique_ptr<Key> key_;
  SmokeGrid grid_;
  SmokeVolume volume_;
  std::uint64_t renewals_ = 0;
  std::uint64_t light_ = 0;  ///< serial of the light in volume_; 0: none
};

}  // namespace neve::render::light

#include "render/light/smoke_cache.h"

#include <utility>

namespace neve::render::light {

const SmokeGrid& SmokeCache::grid(const Smoke& smoke, ThreadPool* pool) {
  Smoke inputs = smoke;
  inputs.samples_per_ray = 0;
  inputs.colormap = {};
  if (inputs_ == inputs) return grid_;
  inputs_.reset();  // should something throw, there is no grid
  light_ = 0;
  grid_ = make_smoke_grid(inputs, pool);
  ++renewals_;
  inputs_ = std::move(inputs);
  return grid_;
}

const SmokeVolume& SmokeCache::volume(const LightVolume& light, Vec3f toward_light,
                                      ThreadPool* pool) {
  if (light_ != 0 && light_ == light.serial) return volume_;
  light_ = 0;
  volume_ = make_smoke_volume(grid_, light, toward_light, pool);
  ++renewals_;
  light_ = light.serial;
  return volume_;
}

}  // namespace neve::render::light

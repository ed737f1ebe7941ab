#include "render/light/smoke_cache.h"

#include "render/frame/same_bytes.h"

namespace neve::render::light {

struct SmokeCache::Key {
  std::shared_ptr<const NodeLattice> nodes;  ///< held, so that no other takes its place in memory
  std::vector<float> density, value;
  float full_density, density_scale, range_min, range_max;

  explicit Key(const Smoke& smoke)
      : nodes(smoke.nodes),
        density(smoke.density),
        value(smoke.value),
        full_density(smoke.full_density),
        density_scale(smoke.density_scale),
        range_min(smoke.range_min),
        range_max(smoke.range_max) {}

  bool is_same(const Smoke& other) const {
    return nodes == other.nodes && full_density == other.full_density &&
           density_scale == other.density_scale && range_min == other.range_min &&
           range_max == other.range_max && same_bytes(density, other.density) &&
           same_bytes(value, other.value);
  }
};

SmokeCache::SmokeCache() = default;
SmokeCache::~SmokeCache() = default;

const SmokeGrid& SmokeCache::grid(const Smoke& smoke, ThreadPool* pool) {
  if (key_ && key_->is_same(smoke)) return grid_;
  key_.reset();  // should something throw, there is no grid
  light_ = 0;
  grid_ = make_smoke_grid(smoke, pool);
  ++renewals_;
  key_ = std::make_unique<Key>(smoke);
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

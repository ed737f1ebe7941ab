#include "render/passes/solid_cache.h"

namespace neve::render::passes {

bool SolidCache::holds(const Frame& frame, const View& view) const {
  return inputs_ == Inputs{view, frame.supersampling, frame.meshes, frame.heat_maps, frame.arrows};
}

cpu::SolidSamples& SolidCache::renew(const Frame& frame, const View& view) {
  inputs_ = {view, frame.supersampling, frame.meshes, frame.heat_maps, frame.arrows};
  samples_.resize(view.width, view.height);
  ++renewals_;
  return samples_;
}

}  // namespace neve::render::passes

/// Colliders of an engine: where they are, how deep particles are in them, and bringing these out.

#include <algorithm>

#include "sim/engine/engine.h"
#include "sim/engine/kernel_pose.h"

namespace neve::sim::engine {

/// The distances of meshes, made before anything relies on them.
template <class Real>
typename Engine<Real>::Fields Engine<Real>::fields_of(
    const std::vector<shapes::Collider>& colliders) const {
  Fields fields;
  for (const shapes::Collider& c : colliders) {
    const auto* mesh = std::get_if<shapes::Mesh>(&c.shape.form);
    try {
      fields.push_back(mesh ? shapes::distance_field(*mesh, settings_.cell_size, *pool_) : nullptr);
    } catch (const ShapeError& error) {
      throw ShapeError("collider " + c.name + ": " + error.what());
    }
  }
  return fields;
}

template <class Real>
std::optional<kernels::ColliderPose> Engine<Real>::pose_of(
    const shapes::Collider& c, const shapes::DistanceField* field) const {
  return kernel_pose(c, colliders_time_, settings_.cell_size, lattice_origin_, field);
}

template <class Real>
void Engine<Real>::place_colliders() {
  poses_.clear();
  for (std::size_t k = 0; k < colliders_.size(); ++k)
    if (const auto pose = pose_of(colliders_[k], fields_[k].get())) poses_.push_back(*pose);
}

/// Paper step 11.
template <class Real>
void Engine<Real>::move_colliders() {
  if (settings_.skips(Stage::colliders)) return;
  colliders_time_ = time_;
  place_colliders();
}

/// What both drivers do at the end of a step of dt that `a` was made for: time passes, colliders
/// move, and particles leave them where the settings ask for it.
template <class Real>
void Engine<Real>::end_step(double dt, kernels::SweepArgs<Real> a) {
  time_ += dt;
  ++steps_;
  move_colliders();
  if (!settings_.push_out) return;
  a.constants.colliders = poses_.data();
  over_particle_blocks(sweeps_->push_out, a);
}

/// In double, as the kernels see it: four particles at a time.
template <class Real>
double Engine<Real>::max_depth() const {
  using V = Quad<double>;
  const int origin[3] = {kernels::block_side * lattice_origin_[0],
                         kernels::block_side * lattice_origin_[1],
                         kernels::block_side * lattice_origin_[2]};
  std::vector<kernels::LocalCollider<double>> colliders;
  for (const kernels::ColliderPose& pose : poses_)
    colliders.push_back(kernels::localize<double>(pose, origin, settings_.cell_size));
  constexpr std::size_t chunk = 4096;
  std::vector<double> deepest((particles_.size() + chunk - 1) / chunk, 0.0);
  if (colliders.empty() || deepest.empty()) return 0;
  pool_->ranges(deepest.size(), active_threads(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t c = begin; c < end; ++c) {
      const std::size_t last = std::min(particles_.size(), (c + 1) * chunk);
      V least{};
      for (std::size_t q = c * chunk; q < last; q += 4) {
        Vec3<V> r;
        for (int l = 0; l < 4; ++l) {
          const Vec3d x = place(particles_[std::min(q + static_cast<std::size_t>(l), last - 1)]);
          for (int a = 0; a < 3; ++a) r[a][l] = x[a];
        }
        for (const kernels::LocalCollider<double>& collider : colliders) {
          Vec3<V> normal;
          least = smaller_lanes(least, kernels::surface_distance(collider, r, normal));
        }
      }
      // Not -smallest: nothing is 0 deep, never -0.
      deepest[c] = 0 - smallest_lane(least);
    }
  });
  return *std::max_element(deepest.begin(), deepest.end());
}

#define NEVE_ENGINE_CONTACT(Real)                                                             \
  template Engine<Real>::Fields Engine<Real>::fields_of(const std::vector<shapes::Collider>&) \
      const;                                                                                  \
  template std::optional<kernels::ColliderPose> Engine<Real>::pose_of(                        \
      const shapes::Collider&, const shapes::DistanceField*) const;                           \
  template void Engine<Real>::place_colliders();                                              \
  template void Engine<Real>::move_colliders();                                               \
  template void Engine<Real>::end_step(double, kernels::SweepArgs<Real>);                     \
  template double Engine<Real>::max_depth() const;
NEVE_ENGINE_CONTACT(float)
NEVE_ENGINE_CONTACT(double)
#undef NEVE_ENGINE_CONTACT

}  // namespace neve::sim::engine

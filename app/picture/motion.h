#pragma once
/// A moment a little before or after the state of a simulation: particles keep their velocity,
/// colliders and cameras follow their paths.

#include "app/picture/snapshot.h"
#include "app/setup/seed_scene.h"
#include "render/channels/channels.h"
#include "render/frame/frame.h"

namespace neve::app::picture {

/// What a moment is read from.
struct MotionSource {
  const scene::Scene& scene;
  const scene::View& view;
  const setup::SeededScene& seeded;
  const Snapshot& snapshot;
};

/// Velocities of particles of this source by their numbers, m/s; 0 for those without a finite one.
std::vector<Vec3f> velocities(const MotionSource& source, const std::vector<std::uint32_t>& id);

/// @param seconds after the state, or before
render::Camera camera_after(const MotionSource& source, double seconds);

/// The meshes and the grounds of a frame, with their places an interval before and after.
/// A mesh that deforms moves as its pose does.
std::vector<render::channels::Thing> moving_meshes(const MotionSource& source, double interval);
std::vector<render::channels::Thing> moving_grounds(const MotionSource& source, double interval);

}  // namespace neve::app::picture

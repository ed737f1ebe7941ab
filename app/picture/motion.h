#pragma once
/// A moment a little before or after the state of a simulation: particles keep their velocity,
/// colliders and cameras follow their paths; and what cameras and slices move with.

#include <optional>
#include <string>
#include <vector>

#include "app/picture/snapshot.h"
#include "app/setup/seed_scene.h"
#include "render/channels/channels.h"
#include "render/frame/frame.h"

namespace neve::app::picture {

/// The inputs from which the motion of a moment is read.
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

/// The meshes, the grounds and the ghosts of grounds of a frame, with their places an interval
/// before and after. A mesh that deforms moves as its pose does.
std::vector<render::channels::Thing> moving_meshes(const MotionSource& source, double interval);
std::vector<render::channels::Thing> moving_grounds(const MotionSource& source, double interval);
std::vector<render::channels::Thing> moving_ghost_grounds(const MotionSource& source,
                                                          double interval);

/// Returns the centre of mass of the snow of a body, or of a collider; nothing without such snow.
/// @param colliders  of the scene, followed to this moment
/// @param particles  in the order of their ids
std::optional<sim::Vec3d> centre_of(const std::string& name, const scene::Scene& scene,
                                    const std::vector<scene::Collider>& colliders,
                                    const setup::SeededScene& seeded,
                                    const sim::ParticleArrays& particles, double time);

/// @param name  of what a camera or a plane follows; "": nothing
/// @return what the camera or plane moves by, m: its centre, or where it began once a sink has
/// taken it; 0 for nothing
sim::Vec3d followed_by(const std::string& name, const scene::Scene& scene,
                       const std::vector<scene::Collider>& colliders,
                       const setup::SeededScene& seeded, const sim::ParticleArrays& particles,
                       double time);

}  // namespace neve::app::picture

#include "app/picture/motion.h"

#include <algorithm>

#include "app/picture/collider_looks.h"
#include "app/picture/frame_builder.h"
#include "app/picture/to_float.h"
#include "sim/rigid/mass.h"

namespace neve::app::picture {

namespace {

using render::channels::Displacement;
using render::channels::Thing;

/// Moves what is placed by one pose to where another one places it.
Displacement displacement(const sim::shapes::Pose& from, const sim::shapes::Pose& to) {
  const sim::Mat3d rotation = to.rotation * from.rotation.transpose();
  Displacement out;
  for (int row = 0; row < 3; ++row)
    out.rotation[static_cast<std::size_t>(row)] = to_float(sim::Vec3d(rotation.row(row)));
  out.offset = to_float(sim::Vec3d(to.point - rotation * from.point));
  return out;
}

/// Colliders that hide what is behind them, or those that do not, in the order in which
/// add_colliders() makes them.
std::vector<Thing> moving_things(const MotionSource& source, bool are_planes, bool are_hiding,
                                 double interval) {
  std::vector<Thing> things;
  const std::vector<scene::Collider>& colliders = source.scene.colliders;
  const double now = source.snapshot.time;
  for (std::size_t c = 0; c < colliders.size(); ++c) {
    const scene::Collider& collider = colliders[c];
    const bool is_plane = std::holds_alternative<sim::shapes::Plane>(collider.shape.form);
    if (!scene::has_layer(source.view, layer_of(collider))) continue;
    if (is_plane != are_planes || hides(collider.style) != are_hiding) continue;
    const sim::shapes::Pose pose = sim::shapes::pose_at(collider, now);
    const auto at = [&](double time) {
      return displacement(pose, sim::shapes::pose_at(collider, time));
    };
    things.push_back({static_cast<std::int32_t>(c), at(now - interval), at(now + interval)});
  }
  return things;
}

}  // namespace

std::vector<Vec3f> velocities(const MotionSource& source, const std::vector<std::uint32_t>& id) {
  const sim::ParticleArrays& particles = source.snapshot.particles;
  std::vector<Vec3f> list;
  list.reserve(id.size());
  for (const std::uint32_t number : id) {
    const auto index = particles.index_of(number);
    const bool is_known = index && particles.v[*index].allFinite();
    list.push_back(is_known ? to_float(particles.v[*index]) : Vec3f{});
  }
  return list;
}

render::Camera camera_after(const MotionSource& source, double seconds) {
  Snapshot moved;
  moved.frame = source.snapshot.frame;
  moved.time = source.snapshot.time + seconds;
  const sim::ParticleArrays& particles = source.snapshot.particles;
  moved.particles.id = particles.id;
  moved.particles.m = particles.m;
  moved.particles.x = particles.x;
  for (std::size_t p = 0; p < particles.x.size(); ++p)
    moved.particles.x[p] += seconds * particles.v[p];
  return camera_of(source.scene, source.view, source.seeded, moved);
}

std::vector<Thing> moving_meshes(const MotionSource& source, double interval) {
  return moving_things(source, false, true, interval);
}

std::vector<Thing> moving_grounds(const MotionSource& source, double interval) {
  return moving_things(source, true, true, interval);
}

std::vector<Thing> moving_ghost_grounds(const MotionSource& source, double interval) {
  return moving_things(source, true, false, interval);
}

std::optional<sim::Vec3d> centre_of(const std::string& name, const scene::Scene& scene,
                                    const std::vector<scene::Collider>& colliders,
                                    const setup::SeededScene& seeded,
                                    const sim::ParticleArrays& particles, double time) {
  for (std::size_t body = 0; body < seeded.body_end.size(); ++body) {
    if (scene.bodies[body].name != name) continue;
    if (const auto centre = setup::snow_centre(seeded, body, particles)) return centre;
  }
  for (const scene::Collider& collider : colliders)
    if (collider.name == name) return sim::rigid::centre_at(collider, time);
  return std::nullopt;
}

sim::Vec3d followed_by(const std::string& name, const scene::Scene& scene,
                       const std::vector<scene::Collider>& colliders,
                       const setup::SeededScene& seeded, const sim::ParticleArrays& particles,
                       double time) {
  if (name.empty()) return sim::Vec3d::Zero();
  sim::Vec3d start = sim::Vec3d::Zero();
  for (std::size_t body = 0; body < seeded.body_start.size(); ++body)
    if (scene.bodies[body].name == name) start = seeded.body_start[body];
  return centre_of(name, scene, colliders, seeded, particles, time).value_or(start);
}

}  // namespace neve::app::picture

#include "app/record/bodies.h"

#include "app/output/report_json.h"
#include "sim/rigid/rigid_bodies.h"

namespace neve::app::record {

namespace {

void take_largest(double value, std::optional<double>& largest) {
  if (!largest || value > *largest) largest = value;
}

/// @param of  the body before and after
template <class Of>
std::optional<double> largest_of(const std::vector<BodyRecord>& before,
                                 const std::vector<BodyRecord>& after, Of of) {
  std::optional<double> largest;
  for (const BodyRecord& a : before)
    for (const BodyRecord& b : after)
      if (a.collider == b.collider) take_largest(of(a, b), largest);
  return largest;
}

}  // namespace

std::optional<double> largest_speed(const std::vector<BodyRecord>& bodies) {
  std::optional<double> speed;
  for (const BodyRecord& body : bodies) take_largest(body.velocity.norm(), speed);
  return speed;
}

std::optional<double> lowest(const std::vector<BodyRecord>& bodies) {
  std::optional<double> depth;
  for (const BodyRecord& body : bodies) take_largest(-body.centre_of_mass.y(), depth);
  return depth ? std::optional(-*depth) : std::nullopt;
}

std::optional<double> largest_fall(const std::vector<BodyRecord>& before,
                                   const std::vector<BodyRecord>& after) {
  return largest_of(before, after, [](const BodyRecord& a, const BodyRecord& b) {
    return a.centre_of_mass.y() - b.centre_of_mass.y();
  });
}

std::optional<double> largest_way(const std::vector<BodyRecord>& before,
                                  const std::vector<BodyRecord>& after) {
  return largest_of(before, after, [](const BodyRecord& a, const BodyRecord& b) {
    return (b.centre_of_mass - a.centre_of_mass).norm();
  });
}

std::vector<BodyRecord> bodies_of(const std::vector<sim::shapes::Collider>& colliders,
                                  double time) {
  std::vector<BodyRecord> bodies;
  for (const sim::shapes::Collider& collider : colliders) {
    if (!collider.body.moves()) continue;
    const sim::shapes::Pose pose = sim::shapes::pose_at(collider, time);
    const sim::rigid::Motion motion = sim::rigid::motion_at(collider, time);
    bodies.push_back({collider.name, pose.point, sim::degrees_from_rotation(pose.rotation),
                      motion.centre, motion.velocity, motion.spin});
  }
  return bodies;
}

Json to_json(const BodyRecord& body) {
  return {{"collider", body.collider},
          {"position", output::vector_json(body.position)},
          {"rotation", output::vector_json(body.rotation)},
          {"centre_of_mass", output::vector_json(body.centre_of_mass)},
          {"velocity", output::vector_json(body.velocity)},
          {"angular_velocity", output::vector_json(body.angular_velocity)}};
}

BodyRecord body_record(const Json& json) {
  return {json.at("collider").get<std::string>(), output::vector_of(json.at("position")),
          output::vector_of(json.at("rotation")), output::vector_of(json.at("centre_of_mass")),
          output::vector_of(json.at("velocity")), output::vector_of(json.at("angular_velocity"))};
}

}  // namespace neve::app::record

#pragma once
/// Places of bodies that move by themselves, as run.json tells them.

#include <optional>
#include <string>
#include <vector>

#include "app/scene/scene.h"
#include "app/support/json.h"

namespace neve::app::record {

/// Place and rotation are those that a keyframe of the collider has.
struct BodyRecord {
  std::string collider;
  sim::Vec3d position{0, 0, 0};          ///< m, of the point of its shape
  sim::Vec3d rotation{0, 0, 0};          ///< degrees
  sim::Vec3d centre_of_mass{0, 0, 0};    ///< m
  sim::Vec3d velocity{0, 0, 0};          ///< m/s, of the centre of mass
  sim::Vec3d angular_velocity{0, 0, 0};  ///< rad/s
};

/// @param colliders  as they are now, see sim::Simulation::colliders
std::vector<BodyRecord> bodies_of(const std::vector<sim::shapes::Collider>& colliders, double time);

/// m/s, of the fastest; nothing without bodies.
std::optional<double> largest_speed(const std::vector<BodyRecord>& bodies);
/// m, along y, of the lowest.
std::optional<double> lowest(const std::vector<BodyRecord>& bodies);
/// m, below where it was, of the one that fell furthest; those that both moments have are asked.
std::optional<double> largest_fall(const std::vector<BodyRecord>& before,
                                   const std::vector<BodyRecord>& after);
/// m, from where it was, of the one that is furthest away.
std::optional<double> largest_way(const std::vector<BodyRecord>& before,
                                  const std::vector<BodyRecord>& after);

Json to_json(const BodyRecord& body);
/// @throws nlohmann::json::exception
BodyRecord body_record(const Json& json);

}  // namespace neve::app::record

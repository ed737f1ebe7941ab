#pragma once
/// Objects to add to the scene being edited: new ones, and copies of those that it has.

#include <string>
#include <utility>
#include <vector>

#include "app/view/session/document.h"

namespace neve::app::view::session {

enum class NewObject { snow_ball, snow_block, emitter, sink, sphere, box, floor };

/// The words of a menu: "Body: a sphere".
const char* title_of(NewObject object);

/// An object as an edit.
struct AddedObject {
  std::string address;  ///< "body.ball_2", free in the scene
  std::string value;    ///< TOML, a table
};

/// Bodies and colliders are put above what already exists: snow in snow is too dense, and bursts.
/// @param near  place that is looked at, m
/// @param size  half of the object's extent, m; some cells at least, and not so many that it takes
///              minutes
AddedObject new_object(const scene::Scene& scene, NewObject object, const sim::Vec3d& near,
                       double size);

/// A ball that moves by itself.
struct Throw {
  sim::Vec3d from{0, 0, 0}, velocity{0, 0, 0};  ///< m, m/s
  double radius = 0.1;                          ///< m
  double density = 900;                         ///< kg/m3
};
AddedObject thrown_ball(const scene::Scene& scene, const Throw& ball);

/// The object with its edits, beside the original.
/// @throws UsageError where the document has no object at this address
AddedObject copy_of(const Document& document, const std::string& address);

/// The vectors that say where a shape is, by their address in it: "sphere.center".
std::vector<std::pair<std::string, sim::Vec3d>> places_of(const sim::shapes::Shape& shape);
/// Returns the places of a collider: of its shape, its joint and its spring, which go where it is
/// put. Addresses are in the collider: "shape.sphere.center", "joint_point".
std::vector<std::pair<std::string, sim::Vec3d>> places_of(const scene::Collider& collider);

}  // namespace neve::app::view::session

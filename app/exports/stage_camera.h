#pragma once
/// The camera of a USD stage.

#include <string>
#include <vector>

#include "app/exports/axes.h"
#include "app/exports/series.h"

namespace neve::app::exports {

/// What a camera may see of a collider: a box about its point and in its axes. Of a plane this is
/// the square that a stage has.
struct SeenCollider {
  std::string name;
  setup::Box box;
  std::optional<sim::Vec3d> normal{};  ///< of a plane
};

/// A frame whose third axis points away from where one looks.
sim::Mat3d looking(const sim::Vec3d& forward, const sim::Vec3d& up);

/// Empty if the camera has no place yet. Its clipping range has the snow and the colliders of all
/// samples, with room for what is between: USD's own starts at 1 unit, farther than a small scene.
std::string usd_camera(const scene::Scene& scene, const Axes& axes,
                       const std::vector<Sample>& samples,
                       const std::vector<SeenCollider>& colliders);

}  // namespace neve::app::exports

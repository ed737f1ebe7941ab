#pragma once
/// Points that an automatic camera has in its picture: snow, obstacles near it, bodies.

#include <optional>
#include <string>
#include <vector>

#include "app/scene/scene.h"
#include "app/setup/coarse_run.h"

namespace neve::app::setup {

/// The part of what the snow does that pictures show.
enum class Shown {
  fall,    ///< all that it does, from the start
  moments  ///< where most of it is at the given moments, as on the tiles of a sheet
};

/// @param follow  a body or collider that the camera moves along with; "" for none
/// @param normal  of a plane that is looked at from its front
std::vector<sim::Vec3d> subject_of(const scene::Scene& scene,
                                   const std::vector<CoarseMoment>& moments,
                                   const std::string& follow,
                                   const std::optional<sim::Vec3d>& normal, Shown shown);

/// Snow of a coarse run as it will lie, without crumbs that have flown off.
std::vector<sim::Vec3d> heap_of(const std::vector<sim::Vec3d>& x);

/// The snow of one moment without crumbs that have flown off, and what it lies beside.
std::vector<sim::Vec3d> core_of_moment(const scene::Scene& scene, const CoarseMoment& moment);

/// Returns the snow of all moments without loose snow, and what it lies beside.
std::vector<sim::Vec3d> dense_snow(const scene::Scene& scene,
                                   const std::vector<CoarseMoment>& moments);

}  // namespace neve::app::setup

#pragma once
/// The stages of a step, named once: for drivers, messages, dumps and scenes. Numbers are the
/// paper's steps (section 4).

#include <array>
#include <cstddef>

namespace neve::sim {

enum class Stage {
  rasterize,            ///< 1  mass, momentum and v_old to the nodes
  volumes,              ///< 2  V0 of bodies in their first step
  elastic_forces,       ///< 3
  grid_velocities,      ///< 4  v_free
  grid_collisions,      ///< 5  v_star
  implicit_solve,       ///< 6  v_new; explicit steps take v_star
  deformation,          ///< 7  F_E, J_P
  particle_velocities,  ///< 8
  particle_collisions,  ///< 9
  advection,            ///< 10
  colliders             ///< they move
};

inline constexpr std::array stage_names{
    "rasterize",           "volumes",        "elastic_forces", "grid_velocities",
    "grid_collisions",     "implicit_solve", "deformation",    "particle_velocities",
    "particle_collisions", "advection",      "colliders"};

constexpr const char* name(Stage stage) {
  return stage_names[static_cast<std::size_t>(stage)];
}

}  // namespace neve::sim

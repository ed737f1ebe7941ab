#pragma once
/// A coarse run: a short, strongly coarsened copy of a scene that shows roughly how its snow moves.

#include <vector>

#include "app/scene/scene.h"

namespace neve::app::setup {

/// Positions of the coarse particles at one time, and boxes around the colliders that move by
/// themselves.
struct CoarseMoment {
  double time = 0;
  std::vector<sim::Vec3d> x;
  std::vector<sim::shapes::Bounds> bodies{};
};

/// Approximate number of particles of the bodies.
double planned_particles(const scene::Scene& scene);

/// Some hundred particles over the whole scene, or as long as a fixed budget of steps times
/// particles lasts: the result depends on the scene alone, never on the machine.
std::vector<CoarseMoment> coarse_run(const scene::Scene& scene);

/// Returns the moments that are next before and after these times; all of them where a time is long
/// after the last one. @param times  s
std::vector<CoarseMoment> moments_near(const std::vector<CoarseMoment>& moments,
                                       const std::vector<double>& times);

}  // namespace neve::app::setup

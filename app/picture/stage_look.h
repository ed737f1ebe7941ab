#pragma once
/// The change that a stage made, as colours and arrows of the particles beside a plane.

#include "app/picture/slice.h"

namespace neve::app::picture {

/// True if the view shows particles while a stage is looked at: instead of smoke, which no stage
/// changes, and in a slice for the stages of particles.
bool shows_particles_of(const scene::View& view, const StageChange& change);
/// The view with the layers whose colours stay then: those of its slice.
scene::View without_snow(scene::View view);

/// The snow that is left of the side of the plane away from a camera; of a view of the plane alone
/// only a layer of it.
struct StageCut {
  SlicePlane plane;
  double side = 1;  ///< of the plane that the camera is on: 1 or -1
  double cell_size = 1;
  bool is_layer = false;

  StageCut(const scene::View& view, const SlicePlane& plane, const sim::Vec3d& eye,
           double cell_size);
  /// m, on the camera's side positive.
  double above(const sim::Vec3d& x) const { return side * (x - plane.point).dot(plane.normal); }
  bool removes(const sim::Vec3d& x) const {
    return above(x) > 0 || (is_layer && above(x) <= -cell_size);
  }
};

/// The cut and the end of the scale of a change that is shown.
struct StageLook {
  StageCut cut;
  double largest = 0;
};

/// Adds the arrows of the particles next to the plane, at most one in a cell, and the legend before
/// those of the slice.
void add_stage_change(const Snapshot& snapshot, const StageLook& look, render::Frame& frame);

}  // namespace neve::app::picture

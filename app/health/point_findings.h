#pragma once
/// Findings about bodies from point files, whose distances and masses were not chosen for this
/// scene.

#include <vector>

#include "app/health/finding.h"
#include "app/setup/seed_scene.h"

namespace neve::app::health {

bool is_from_points(const sim::seeding::Body& body);

/// Number of particles in a full cell of edge `cell_size` (m).
double particles_in_cell(const sim::seeding::Body& body, double cell_size);

/// Points that are too far apart for the cells, or needlessly close.
/// @param coarsening the N of --coarsen, for advice
void check_point_distance(const sim::seeding::Body& body, double cell_size, double coarsening,
                          std::vector<Finding>& findings);

/// Compares the points of all bodies with their materials: density, packing and thresholds.
void check_points(const scene::Scene& scene, const setup::SeededScene& seeded,
                  std::vector<Finding>& findings);

}  // namespace neve::app::health

#pragma once
/// Fields on the nodes of the grid at one moment, as pictures show them.

#include <map>
#include <memory>
#include <set>
#include <span>
#include <vector>

#include "app/scene/scene.h"
#include "sim/simulation.h"
#include "sim/types/grid_fields.h"

namespace neve::app::picture {

struct Snapshot;

/// Node fields that views show; `is_needed` also if the places of the nodes are enough.
struct FieldNeeds {
  bool is_needed = false;
  std::set<scene::ScalarField> scalars;
  std::set<scene::VectorField> vectors;
};
FieldNeeds field_needs(std::span<const scene::View> views);

/// Values are at 64 b + 16 i + 4 j + k, see render::NodeLattice. Light nodes (sim::health::
/// Law::light_node) carry absurd values and are treated as empty: zero everywhere.
struct FieldSamples {
  std::shared_ptr<const render::NodeLattice> lattice;
  std::vector<float> density;  ///< kg/m3, the node's mass over h^3
  std::map<scene::ScalarField, std::vector<float>> scalars;
  std::map<scene::VectorField, std::vector<Vec3f>> vectors;
};

/// The blocks of nodes as a picture has them.
std::shared_ptr<const render::NodeLattice> lattice_of(const sim::RasterizedNodes& nodes);

/// Rasterises the particles as they are. Fields that belong to a step (force, v_free, v_star,
/// v_new) are those of the step which follows, done on a copy.
/// @param particles of the same moment, with stress where a field wants it
FieldSamples sample_fields(const scene::Scene& scene, const sim::Simulation& simulation,
                           const Snapshot& particles, const FieldNeeds& needs);

}  // namespace neve::app::picture

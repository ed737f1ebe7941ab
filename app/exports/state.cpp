#include "app/exports/state.h"

#include <algorithm>

#include "sim/rasterize.h"

namespace neve::app::exports {

namespace {

bool has_attribute(const scene::Export& e, scene::ExportAttribute attribute) {
  return std::find(e.attributes.begin(), e.attributes.end(), attribute) != e.attributes.end();
}

bool has_stress(const scene::Export& e) {
  return has_attribute(e, scene::ExportAttribute::stress) ||
         has_attribute(e, scene::ExportAttribute::kirchhoff);
}

}  // namespace

bool has_grid(const scene::Export& e) {
  return e.format == scene::ExportFormat::vti || e.format == scene::ExportFormat::vdb;
}

std::vector<PlacedShape> placed_at(const std::vector<scene::Collider>& colliders, double time) {
  std::vector<PlacedShape> placed;
  for (const scene::Collider& collider : colliders)
    placed.push_back(
        {sim::shapes::pose_at(collider, time), sim::shapes::shape_time(collider, time)});
  return placed;
}

std::shared_ptr<const State> read_state(std::span<const scene::Export> exports,
                                        const std::vector<scene::Collider>& colliders,
                                        const sim::Simulation& simulation) {
  auto state = std::make_shared<State>();
  state->time = simulation.time();
  state->hash = simulation.state_hash();
  state->particles = simulation.particles();
  if (std::any_of(exports.begin(), exports.end(), has_stress))
    state->kirchhoff = simulation.kirchhoff();
  if (std::any_of(exports.begin(), exports.end(), has_grid))
    state->nodes = sim::rasterize(simulation);
  state->colliders = placed_at(colliders, state->time);
  return state;
}

}  // namespace neve::app::exports

#include "app/exports/state.h"

#include <algorithm>
#include <cstdint>
#include <numbers>

#include "sim/dust_grid.h"
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
    placed.push_back({collider.name, sim::shapes::pose_at(collider, time),
                      sim::shapes::shape_time(collider, time)});
  return placed;
}

std::shared_ptr<const State> state_of_dust(const State& state) {
  auto out = std::make_shared<State>();
  out->time = state.time;
  out->hash = state.hash;
  out->colliders = state.colliders;
  out->dust = state.dust;
  const sim::DustArrays& dust = state.dust;
  const std::size_t count = dust.x.size();
  sim::ParticleArrays& p = out->particles;
  p.x = dust.x;
  p.v = dust.v;
  p.m = dust.m;
  // A ball that reaches to the next nodes of its density.
  const double radius = 0.5 * dust.air_spacing;
  p.V0.assign(count, 4.0 / 3 * std::numbers::pi * radius * radius * radius);
  p.F_E.assign(count, sim::Mat3d::Identity());
  p.J_P.assign(count, 1.0);
  p.material.assign(count, 0);
  for (const std::uint64_t id : dust.id) p.id.push_back(static_cast<std::uint32_t>(id));
  out->nodes = sim::dust_nodes(dust);
  return out;
}

std::shared_ptr<const State> read_state(std::span<const scene::Export> exports,
                                        const std::vector<scene::Collider>& colliders,
                                        const sim::Simulation& simulation) {
  auto state = std::make_shared<State>();
  state->time = simulation.time();
  state->hash = simulation.state_hash();
  const auto has_dust = [](const scene::Export& e) { return e.dust; };
  if (std::any_of(exports.begin(), exports.end(), has_dust)) state->dust = simulation.dust();
  if (!exports.empty() && std::all_of(exports.begin(), exports.end(), has_dust)) {
    state->colliders = placed_at(colliders, state->time);
    return state;
  }
  state->particles = simulation.particles();
  if (std::any_of(exports.begin(), exports.end(), has_stress))
    state->kirchhoff = simulation.kirchhoff();
  if (std::any_of(exports.begin(), exports.end(), has_grid))
    state->nodes = sim::rasterize(simulation);
  state->colliders = placed_at(colliders, state->time);
  return state;
}

}  // namespace neve::app::exports

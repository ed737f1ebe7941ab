#include "app/exports/state.h"

#include <fmt/core.h>

#include <algorithm>
#include <cstdint>
#include <numbers>

#include "app/support/text.h"
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

std::string unknown_ages(const scene::Export& e, const State& state) {
  if (e.dust || !has_attribute(e, scene::ExportAttribute::age)) return "";
  for (const std::string& name : state.waiting) {
    const bool is_written =
        e.bodies.empty() || std::find(e.bodies.begin(), e.bodies.end(), name) != e.bodies.end();
    if (is_written)
      return fmt::format(
          "emitter.{} has waited for room by {} s: from then on the state does not say when its "
          "particles were born, and their age is not-a-number; give the emitter room with a lower "
          "rate",
          name, fixed_text(state.time, 3));
  }
  return "";
}

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
  out->nodes[{}] = sim::dust_nodes(dust);
  return out;
}

std::shared_ptr<const State> read_state(std::span<const scene::Export> exports,
                                        const Origins& origins,
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
  const std::vector<sim::seeding::EmitterStream::State> emitters = simulation.emitter_states();
  for (std::size_t k = 0; k < emitters.size(); ++k)
    if (emitters[k].waited > 0)
      state->waiting.push_back(origins.names()[origins.body_end().size() + k]);
  for (const scene::Export& e : exports) {
    if (e.dust) continue;
    if (has_grid(e) && !state->nodes.contains(e.bodies))
      state->nodes[e.bodies] =
          e.bodies.empty()
              ? sim::rasterize(simulation)
              : sim::rasterize_some(simulation, origins.rows_of(e.bodies, state->particles));
  }
  state->colliders = placed_at(colliders, state->time);
  return state;
}

}  // namespace neve::app::exports

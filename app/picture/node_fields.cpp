#include "app/picture/node_fields.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "app/picture/attributes.h"
#include "app/picture/field_sampler.h"
#include "app/picture/snapshot.h"
#include "app/picture/to_float.h"
#include "app/setup/auto_ranges.h"
#include "sim/health/limits.h"
#include "sim/rasterize.h"
#include "sim/staged.h"

namespace neve::app::picture {

namespace {

using sim::Vec3d;

double lightest_density(const scene::Scene& scene) {
  double density = std::numeric_limits<double>::infinity();
  for (const sim::Material& material : scene.materials)
    density = std::min(density, material.density);
  return density;
}

/// Fields that a mean over the particles around a node gives.
bool is_mean(scene::ScalarField field) {
  return field != scene::ScalarField::mass && field != scene::ScalarField::speed;
}

bool is_of_step(scene::VectorField field) {
  return field != scene::VectorField::velocity && field != scene::VectorField::momentum;
}

std::vector<std::vector<double>> particle_values(const scene::Scene& scene,
                                                 const Snapshot& snapshot,
                                                 const FieldNeeds& needs) {
  std::vector<std::vector<double>> values;
  for (const scene::ScalarField field : needs.scalars) {
    if (!is_mean(field)) continue;
    values.push_back(attribute_values(scene, setup::attribute_of(field), snapshot));
    // One broken particle of a diverged run must not hide the field around it.
    for (double& value : values.back())
      if (!std::isfinite(value)) value = 0;
  }
  return values;
}

const std::vector<Vec3d>& field_of_step(const sim::NodeFields& nodes, scene::VectorField field) {
  switch (field) {
    case scene::VectorField::force:
      return nodes.force;
    case scene::VectorField::v_free:
      return nodes.v_free;
    case scene::VectorField::v_star:
      return nodes.v_star;
    default:
      return nodes.v_new;
  }
}

void add_fields_of_step(const scene::Scene& scene, const sim::Simulation& simulation,
                        const FieldNeeds& needs, FieldSamples& out) {
  const double frame = 1 / scene.fps;
  const sim::StagedStep step = sim::staged_step(simulation, simulation.choose_dt(frame).dt);
  std::vector<std::optional<std::size_t>> places;
  for (const sim::Vec3i& node : step.nodes.node)
    places.push_back(node_index(*out.lattice, {node.x(), node.y(), node.z()}));
  for (const scene::VectorField field : needs.vectors) {
    if (!is_of_step(field)) continue;
    const std::vector<Vec3d>& values = field_of_step(step.nodes, field);
    std::vector<Vec3f>& list = out.vectors[field];
    list.resize(out.density.size());
    for (std::size_t n = 0; n < values.size(); ++n) {
      const std::optional<std::size_t> at = places[n];
      if (at && out.density[*at] > 0) list[*at] = to_float(values[n]);
    }
  }
}

void add_needs(const scene::View& view, FieldNeeds& needs) {
  const bool has_vectors = scene::has_layer(view, scene::Layer::arrows) ||
                           scene::has_layer(view, scene::Layer::streamlines);
  if (has_vectors) needs.vectors.insert(view.slice.field);
  if (scene::has_layer(view, scene::Layer::heatmap)) needs.scalars.insert(view.slice.scalar);
  if (scene::has_layer(view, scene::Layer::extremes) && !has_vectors &&
      !scene::has_layer(view, scene::Layer::smoke))
    needs.scalars.insert(view.slice.scalar);
  if (scene::has_layer(view, scene::Layer::blocks) || scene::has_layer(view, scene::Layer::smoke))
    needs.is_needed = true;
  if (scene::has_layer(view, scene::Layer::smoke) && view.smoke.field != scene::ScalarField::mass)
    needs.scalars.insert(view.smoke.field);
  needs.is_needed = needs.is_needed || !needs.vectors.empty() || !needs.scalars.empty();
}

template <class Value>
std::vector<Value> where_dense(const std::vector<float>& density, auto&& value_at) {
  std::vector<Value> list(density.size());
  for (std::size_t n = 0; n < list.size(); ++n)
    if (density[n] > 0) list[n] = value_at(n);
  return list;
}

}  // namespace

std::shared_ptr<const render::NodeLattice> lattice_of(const sim::RasterizedNodes& nodes) {
  auto lattice = std::make_shared<render::NodeLattice>();
  lattice->spacing = static_cast<float>(nodes.spacing);
  for (const sim::Vec3i& block : nodes.block)
    lattice->block.push_back({block.x(), block.y(), block.z()});
  return lattice;
}

FieldNeeds field_needs(std::span<const scene::View> views) {
  FieldNeeds needs;
  for (const scene::View& view : views) add_needs(view, needs);
  return needs;
}

FieldSamples sample_fields(const scene::Scene& scene, const sim::Simulation& simulation,
                           const Snapshot& snapshot, const FieldNeeds& needs) {
  FieldSamples out;
  if (!needs.is_needed) return out;
  const sim::RasterizedNodes nodes =
      sim::rasterize(simulation, particle_values(scene, snapshot, needs));
  out.lattice = lattice_of(nodes);
  const double volume = std::pow(nodes.spacing, 3);
  const double lightest =
      sim::health::limits_of(sim::health::Law::light_node).expected * lightest_density(scene);
  out.density.resize(nodes.mass.size());
  for (std::size_t n = 0; n < nodes.mass.size(); ++n)
    if (const double density = nodes.mass[n] / volume; density > lightest)
      out.density[n] = static_cast<float>(density);

  std::size_t mean = 0;
  for (const scene::ScalarField field : needs.scalars) {
    if (field == scene::ScalarField::mass) continue;
    out.scalars[field] = where_dense<float>(out.density, [&](std::size_t n) {
      return static_cast<float>(is_mean(field) ? nodes.mean[mean][n] : nodes.velocity[n].norm());
    });
    if (is_mean(field)) ++mean;
  }
  if (needs.scalars.contains(scene::ScalarField::mass))
    out.scalars[scene::ScalarField::mass] = out.density;
  bool has_step = false;
  for (const scene::VectorField field : needs.vectors) {
    has_step = has_step || is_of_step(field);
    if (is_of_step(field)) continue;
    out.vectors[field] = where_dense<Vec3f>(out.density, [&](std::size_t n) {
      const bool is_momentum = field == scene::VectorField::momentum;
      return to_float((is_momentum ? nodes.mass[n] : 1.0) * nodes.velocity[n]);
    });
  }
  if (has_step) add_fields_of_step(scene, simulation, needs, out);
  return out;
}

}  // namespace neve::app::picture

#include "app/view/session/stage_summary.h"

#include "app/setup/auto_ranges.h"

namespace neve::app::view::session {

namespace {

std::optional<std::size_t> nearest_row(const dump::Listing& listing, const sim::Vec3d& place) {
  std::optional<std::size_t> nearest;
  for (std::size_t row = 0; row < listing.place.size(); ++row)
    if (!nearest || (listing.place[row] - place).squaredNorm() <
                        (listing.place[*nearest] - place).squaredNorm())
      nearest = row;
  return nearest;
}

bool has_nodes(sim::Stage stage) {
  using enum sim::Stage;
  return stage == rasterize || (stage >= elastic_forces && stage <= implicit_solve);
}

/// Nodes have values in a step alone: before it, they are shown as the solve of it leaves them.
std::optional<sim::Stage> stage_of(bool is_node, const std::optional<sim::Stage>& stage) {
  return is_node ? std::optional(stage.value_or(sim::Stage::implicit_solve)) : stage;
}

/// All nodes or all particles, as they are after a stage.
dump::Listing listing_of(const dump::StepInspection& inside, bool is_node,
                         const std::optional<sim::Stage>& after) {
  if (after && has_nodes(*after) == is_node) return dump::list_stage(inside, *after);
  return is_node ? dump::list_stage(inside, sim::Stage::implicit_solve) : dump::list_state(inside);
}

}  // namespace

scene::View view_of_stage(const scene::Scene& scene, scene::View view, sim::Stage stage) {
  using enum sim::Stage;
  std::optional<scene::VectorField> field;
  if (stage == rasterize) field = scene::VectorField::velocity;
  if (stage == elastic_forces) field = scene::VectorField::force;
  if (stage == grid_velocities) field = scene::VectorField::v_free;
  if (stage == grid_collisions) field = scene::VectorField::v_star;
  if (stage == implicit_solve) field = scene::VectorField::v_new;
  if (!field) return view;
  view.slice.field = *field;
  view.slice.range = setup::automatic_range(scene, *field);
  return view;
}

StageSummary summarize_stage(const dump::StepInspection& inside, sim::Stage stage) {
  const dump::Listing listing = dump::list_stage(inside, stage);
  StageSummary summary;
  summary.stage = stage;
  summary.dt = inside.dt;
  summary.is_of_nodes = listing.is_of_nodes;
  summary.rows = listing.place.size();
  summary.negligible = listing.negligible_count();
  summary.seconds = inside.step.seconds;
  for (const dump::Quantity& quantity : listing.quantities)
    if (!dump::is_index(quantity))
      summary.quantities.push_back({quantity.name, quantity.unit, dump::extremes(listing, quantity),
                                    quantity.expected, quantity.why});
  return summary;
}

void show_after_stage(const dump::StepInspection& inside, sim::Stage stage,
                      picture::Snapshot& snapshot) {
  using enum sim::Stage;
  const sim::StagedStep& step = inside.step;
  if (stage >= deformation) {
    snapshot.particles.F_E = step.after.F_E;
    snapshot.particles.J_P = step.after.J_P;
  }
  if (stage >= particle_velocities) snapshot.particles.v = step.v_before_collision;
  if (stage >= particle_collisions) snapshot.particles.v = step.after.v;
  if (stage >= advection) snapshot.particles.x = step.after.x;
}

std::optional<ProbeReading> read_probe(const dump::StepInspection& inside,
                                       const dump::Probe& target,
                                       const std::optional<sim::Stage>& stage) {
  const bool is_node = std::holds_alternative<sim::Vec3d>(target);
  const std::optional<sim::Stage> after = stage_of(is_node, stage);
  const dump::Listing listing = listing_of(inside, is_node, after);
  std::optional<std::size_t> row;
  if (is_node)
    row = nearest_row(listing, std::get<sim::Vec3d>(target));
  else
    row = inside.step.after.index_of(std::get<std::size_t>(target));
  if (!row) return std::nullopt;
  ProbeReading reading{
      target, listing.place[*row], is_node, after ? name(*after) : "", inside.simulation.time(),
      {}};
  for (const dump::Quantity& quantity : listing.quantities) {
    const auto width = static_cast<std::size_t>(quantity.components);
    ProbeRow out{quantity.name,
                 quantity.unit,
                 {quantity.values.begin() + static_cast<std::ptrdiff_t>(*row * width),
                  quantity.values.begin() + static_cast<std::ptrdiff_t>((*row + 1) * width)},
                 quantity.magnitude(*row),
                 quantity.expected,
                 quantity.why,
                 quantity.is_outside_expected(*row)};
    reading.rows.push_back(std::move(out));
  }
  return reading;
}

HistogramReading read_histogram(const dump::StepInspection& inside, const FieldName& field,
                                const std::optional<sim::Stage>& stage) {
  HistogramReading reading;
  reading.field = field;
  for (const bool is_node : {false, true}) {
    const std::optional<sim::Stage> after = stage_of(is_node, stage);
    const dump::Listing listing = listing_of(inside, is_node, after);
    if (is_node == field.is_of_nodes) reading.after = after ? name(*after) : "";
    for (const dump::Quantity& quantity : listing.quantities) {
      if (dump::is_index(quantity)) continue;
      reading.fields.push_back({is_node, quantity.name});
      if (reading.fields.back() == field) reading.histogram = dump::histogram_of(listing, quantity);
    }
  }
  return reading;
}

}  // namespace neve::app::view::session

#include "app/dump/quantities.h"

#include <Eigen/LU>
#include <Eigen/SVD>
#include <algorithm>
#include <type_traits>
#include <utility>

#include "app/advice/suggest.h"
#include "app/health/expected.h"
#include "app/support/errors.h"
#include "sim/health/diagnostics.h"

namespace neve::app::dump {

namespace {

using sim::Mat3d;
using sim::Vec3d;

/// Numbers, vectors or tensors at all places.
template <class Value>
Quantity quantity(const char* name, const char* unit, const std::vector<Value>& values,
                  const std::optional<health::Expectation>& expected = std::nullopt) {
  constexpr int components = std::is_same_v<Value, Vec3d>   ? 3
                             : std::is_same_v<Value, Mat3d> ? 9
                                                            : 1;
  Quantity q{name, unit, components, {}, std::nullopt, ""};
  for (const Value& value : values)
    if constexpr (components == 1)
      q.values.push_back(value);
    else
      for (Eigen::Index k = 0; k < components; ++k)
        q.values.push_back(value(k / value.cols(), k % value.cols()));
  if (expected) {
    q.expected = expected->range;
    q.why = expected->why;
  }
  return q;
}

std::vector<double> determinants(const std::vector<Mat3d>& F) {
  std::vector<double> J;
  for (const Mat3d& f : F) J.push_back(f.determinant());
  return J;
}

/// The three singular values, as one vector; the expectation is that of each.
std::vector<Vec3d> singular_values(const std::vector<Mat3d>& F) {
  std::vector<Vec3d> s;
  for (const Mat3d& f : F)
    s.push_back(f.allFinite() ? Vec3d(f.jacobiSvd().singularValues())
                              : Vec3d::Constant(std::nan("")));
  return s;
}

/// Smallest and largest stretch apart, so that each can be compared with its limit.
void add_stretches(const std::vector<Mat3d>& F, const health::Expected& expected,
                   Listing& listing) {
  std::vector<double> least, greatest;
  for (const Vec3d& s : singular_values(F)) {
    least.push_back(s[2]);
    greatest.push_back(s[0]);
  }
  listing.quantities.push_back(quantity("stretch_min", "", least, expected.stretch()));
  listing.quantities.push_back(quantity("stretch_max", "", greatest, expected.stretch()));
}

void add_deformation(const sim::ParticleArrays& p, const health::Expected& expected,
                     Listing& listing) {
  listing.quantities.push_back(quantity("F_E", "", p.F_E));
  listing.quantities.push_back(quantity("J_E", "", determinants(p.F_E), expected.J_E()));
  add_stretches(p.F_E, expected, listing);
  listing.quantities.push_back(quantity("J_P", "", p.J_P, expected.J_P()));
}

std::vector<double> elastic_energies(const scene::Scene& scene, const sim::ParticleArrays& p) {
  std::vector<double> energies;
  for (std::size_t q = 0; q < p.x.size(); ++q)
    energies.push_back(p.V0[q] * sim::health::energy_density(p.material_of(q, scene.materials),
                                                             p.F_E[q], p.J_P[q]));
  return energies;
}

std::vector<double> current_volumes(const sim::ParticleArrays& p) {
  std::vector<double> volumes;
  for (std::size_t q = 0; q < p.x.size(); ++q)
    volumes.push_back(p.V0[q] * p.F_E[q].determinant() * p.J_P[q]);
  return volumes;
}

std::vector<double> ids(const sim::ParticleArrays& p) {
  std::vector<double> out(p.x.size());
  for (std::size_t q = 0; q < out.size(); ++q) out[q] = p.id_of(q);
  return out;
}

/// Fills factors up with ones: the state omits them while all are 1.
std::vector<double> factors(std::vector<double> of_particles, std::size_t count) {
  of_particles.resize(count, 1.0);
  return of_particles;
}

Listing particles_at(const sim::ParticleArrays& p) {
  Listing listing;
  listing.place = p.x;
  listing.quantities.push_back(quantity("id", "", ids(p)));
  listing.quantities.push_back(quantity("x", "m", p.x));
  return listing;
}

std::vector<Vec3d> difference(const std::vector<Vec3d>& a, const std::vector<Vec3d>& b) {
  std::vector<Vec3d> out;
  for (std::size_t k = 0; k < a.size(); ++k) out.push_back(a[k] - b[k]);
  return out;
}

Listing nodes_after(const StepInspection& inside, const health::Expected& expected,
                    sim::Stage stage) {
  const sim::NodeFields& n = inside.step.nodes;
  Listing listing;
  listing.is_of_nodes = true;
  std::vector<Vec3d> index;
  for (const sim::Vec3i& node : n.node) {
    index.push_back(node.cast<double>());
    listing.place.push_back(inside.scene.solver.cell_size * node.cast<double>());
  }
  for (const double mass : n.mass)
    listing.is_negligible.push_back(mass < expected.negligible_mass());
  auto& q = listing.quantities;
  q.push_back(quantity("node", "", index));
  q.push_back(quantity("mass", "kg", n.mass, expected.node_mass()));
  q.push_back(quantity("momentum", "kg m/s", n.momentum, expected.momentum()));
  q.push_back(quantity("v_old", "m/s", n.v_old, expected.speed()));
  const auto reached = [&](sim::Stage other) { return stage >= other; };
  if (reached(sim::Stage::elastic_forces))
    q.push_back(quantity("force", "N", n.force, expected.force()));
  if (reached(sim::Stage::grid_velocities)) {
    q.push_back(quantity("v_free", "m/s", n.v_free, expected.speed()));
    q.push_back(quantity("dv", "m/s", difference(n.v_free, n.v_old), expected.velocity_change()));
  }
  if (reached(sim::Stage::grid_collisions))
    q.push_back(quantity("v_star", "m/s", n.v_star, expected.speed()));
  if (reached(sim::Stage::implicit_solve)) {
    q.push_back(quantity("v_new", "m/s", n.v_new, expected.speed()));
    if (inside.scene.solver.is_implicit())
      q.push_back(quantity("dv_solve", "m/s", difference(n.v_new, n.v_star)));
  }
  return listing;
}

}  // namespace

std::size_t Listing::negligible_count() const {
  return static_cast<std::size_t>(std::count(is_negligible.begin(), is_negligible.end(), true));
}

double Quantity::magnitude(std::size_t row) const {
  const auto width = static_cast<std::size_t>(components);
  if (components == 1) return values[row];
  double sum = 0;
  for (std::size_t k = 0; k < width; ++k) sum += values[row * width + k] * values[row * width + k];
  return std::sqrt(sum);
}

bool Quantity::is_outside_expected(std::size_t row) const {
  const double found = magnitude(row);
  if (!std::isfinite(found)) return true;
  return expected && !(found >= expected->min && found <= expected->max);
}

Extremes extremes(const Listing& listing, const Quantity& quantity) {
  Extremes e;
  double sum = 0;
  std::size_t count = 0;
  for (std::size_t row = 0; row < quantity.rows(); ++row) {
    if (!listing.is_negligible.empty() && listing.is_negligible[row]) continue;
    e.outside_expected += quantity.is_outside_expected(row);
    const double found = quantity.magnitude(row);
    if (!std::isfinite(found)) continue;
    e.least = std::fmin(e.least, found);
    e.greatest = std::fmax(e.greatest, found);
    sum += found;
    ++count;
  }
  if (count > 0) e.mean = sum / static_cast<double>(count);
  return e;
}

std::string component_name(const Quantity& quantity, int component) {
  static constexpr const char* axes[] = {"x", "y", "z"};
  if (quantity.components == 1) return quantity.name;
  if (quantity.components == 3) return quantity.name + "_" + axes[component];
  return quantity.name + "_" + axes[component / 3] + axes[component % 3];
}

StepInspection inspect_step(const scene::Scene& scene, const sim::Simulation& simulation,
                            double remaining) {
  const sim::DtChoice choice = simulation.choose_dt(remaining);
  return {scene,
          simulation,
          choice.dt,
          choice.limit,
          sim::staged_step(simulation, choice.dt),
          simulation.particles()};
}

std::vector<record::ColliderForce> forces_in_step(const StepInspection& inside) {
  sim::AdvanceReport report;
  report.seconds = inside.dt;
  report.loads = inside.step.loads;
  return record::forces_of(report, inside.simulation.summary(), inside.scene.colliders);
}

Listing list_state(const StepInspection& inside) {
  const sim::ParticleArrays& p = inside.before;
  const health::Expected expected(inside.scene, p, inside.dt);
  Listing listing = particles_at(p);
  auto& q = listing.quantities;
  q.push_back(quantity("v", "m/s", p.v, expected.speed()));
  q.push_back(quantity("m", "kg", p.m));
  q.push_back(quantity("V0", "m3", p.V0, expected.volume()));
  q.push_back(quantity("volume", "m3", current_volumes(p)));
  add_deformation(p, expected, listing);
  q.push_back(quantity("kirchhoff", "Pa", inside.simulation.kirchhoff(), expected.stress()));
  q.push_back(quantity("elastic_energy", "J", elastic_energies(inside.scene, p)));
  q.push_back(quantity("C", "1/s", p.C));
  q.push_back(quantity("stiffness", "", factors(p.stiffness, p.x.size())));
  q.push_back(quantity("threshold", "", factors(p.threshold, p.x.size())));
  return listing;
}

Listing list_stage(const StepInspection& inside, sim::Stage stage) {
  using enum sim::Stage;
  const health::Expected expected(inside.scene, inside.before, inside.dt);
  if (stage == rasterize || (stage >= elastic_forces && stage <= implicit_solve))
    return nodes_after(inside, expected, stage);
  const sim::StagedStep& step = inside.step;
  Listing listing = particles_at(inside.before);
  auto& q = listing.quantities;
  switch (stage) {
    case volumes:
      q.push_back(quantity("m", "kg", step.after.m));
      q.push_back(quantity("V0", "m3", step.after.V0, expected.volume()));
      break;
    case deformation:
      q.push_back(quantity("grad_v", "1/s", step.grad_v, expected.strain_rate()));
      q.push_back(quantity("F_E_trial", "", step.F_E_trial));
      add_deformation(step.after, expected, listing);
      break;
    case particle_velocities:
      q.push_back(quantity("v_before", "m/s", inside.before.v, expected.speed()));
      q.push_back(quantity("v", "m/s", step.v_before_collision, expected.speed()));
      break;
    case particle_collisions:
      q.push_back(quantity("v_before", "m/s", step.v_before_collision, expected.speed()));
      q.push_back(quantity("v", "m/s", step.after.v, expected.speed()));
      break;
    default:  // advection, and the colliders that move with it
      q.push_back(quantity(
          "moved", "m", difference(step.after.x, inside.before.x),
          health::Expectation{{0, expected.speed().range.max * inside.dt}, "speed times dt"}));
      q.push_back(quantity("v", "m/s", step.after.v, expected.speed()));
  }
  return listing;
}

const std::vector<std::string>& quantity_names() {
  static const std::vector<std::string> names{
      "id",    "x",         "v",           "m",           "V0",        "volume",
      "F_E",   "J_E",       "stretch_min", "J_P",         "kirchhoff", "elastic_energy",
      "C",     "stiffness", "threshold",   "stretch_max", "node",      "mass",
      "v_old", "momentum",  "force",       "v_free",      "dv",        "v_star",
      "v_new", "moved",     "dv_solve",    "grad_v",      "F_E_trial", "v_before"};
  return names;
}

void keep_only(Listing& listing, const std::vector<std::string>& names) {
  if (names.empty()) return;
  std::vector<std::string> known;
  for (const Quantity& q : listing.quantities) known.push_back(q.name);
  std::vector<Quantity> kept;
  for (const std::string& name : names) {
    const auto found = std::find(known.begin(), known.end(), name);
    if (found == known.end()) {
      const advice::Entry* later = advice::entry_of("quantity of another stage", name);
      throw UsageError("--field", "there is no \"" + name + "\" here",
                       (later ? later->sentence + "; " : "") +
                           advice::suggest_one_of(name, {"attribute", known}));
    }
    kept.push_back(listing.quantities[static_cast<std::size_t>(found - known.begin())]);
  }
  listing.quantities = std::move(kept);
}

}  // namespace neve::app::dump

#pragma once
/// Quantities inside a step, with the ranges of a healthy run.

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "app/record/run_json.h"
#include "app/scene/scene.h"
#include "app/support/json.h"
#include "sim/simulation.h"
#include "sim/staged.h"

namespace neve::app::dump {

/// Numbers at nodes or particles: 1, 3 (a vector) or 9 (a tensor, row by row) each.
struct Quantity {
  std::string name, unit;  ///< the unit may be empty
  int components = 1;
  std::vector<double> values;
  /// Range of the magnitudes in a healthy run (the length of vectors, the Frobenius norm of
  /// tensors), and its reason.
  std::optional<scene::Range> expected;
  std::string why;

  std::size_t rows() const { return values.size() / static_cast<std::size_t>(components); }
  double magnitude(std::size_t row) const;
  /// Outside the expected range, or no number.
  bool is_outside_expected(std::size_t row) const;
};

/// Names of particles and nodes, not measures.
inline bool is_index(const Quantity& quantity) {
  return quantity.name == "id" || quantity.name == "node";
}

/// "v_x v_y v_z", "F_E_xx F_E_xy ..."
std::string component_name(const Quantity& quantity, int component);

/// An inspected step: the state before it and the results of its stages.
struct StepInspection {
  const scene::Scene& scene;
  const sim::Simulation& simulation;
  double dt;  ///< s
  sim::DtLimit limit;
  sim::StagedStep step;
  sim::ParticleArrays before;
};
StepInspection inspect_step(const scene::Scene& scene, const sim::Simulation& simulation,
                            double remaining);

/// Force, torque and pressure of the snow on each collider during the step; colliders without snow
/// are listed too.
std::vector<record::ColliderForce> forces_in_step(const StepInspection& inside);

/// Either nodes (place and index known) or particles (id order).
struct Listing {
  bool is_of_nodes = false;
  std::vector<sim::Vec3d> place;  ///< m
  /// Nodes below Expected::negligible_mass(), whose velocities are meaningless; empty: none.
  std::vector<bool> is_negligible;
  std::size_t negligible_count() const;
  std::vector<Quantity> quantities;
};

/// The particles before the step: x, v, F_E, J_E, J_P, stretches, stress, energy, volume, C.
Listing list_state(const StepInspection& inside);

/// Results of a stage, with those of earlier stages on the same points: nodes up to implicit_solve,
/// then particles.
Listing list_stage(const StepInspection& inside, sim::Stage stage);

/// Names of the quantities of all stages and of the state before the step.
const std::vector<std::string>& quantity_names();

/// Magnitudes of one quantity in a few numbers, without those of light nodes.
struct Extremes {
  double least = NAN, greatest = NAN, mean = NAN;  ///< not-a-number: there is nothing to measure
  std::size_t outside_expected = 0;                ///< with those that are not finite
};
Extremes extremes(const Listing& listing, const Quantity& quantity);

/// Keeps the named ones.
/// @throws UsageError with the nearest name
void keep_only(Listing& listing, const std::vector<std::string>& names);

/// One line per quantity: least and greatest magnitude, expected range, number outside.
std::vector<std::string> summary_lines(const Listing& listing);

/// The lines above behind '#', a header line, one line per node or particle; tabs between columns.
std::string to_table(const Listing& listing, const std::vector<std::string>& heading);

/// VTK XML PolyData (.vtp), raw little-endian float64: points with all quantities as arrays.
std::string to_vtk(const Listing& listing);

/// Quantity, value and expected range of one row.
std::vector<std::string> probe_lines(const Listing& listing, std::size_t row);

Json summary_json(const Listing& listing);
Json probe_json(const Listing& listing, std::size_t row);

}  // namespace neve::app::dump

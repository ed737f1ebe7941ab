/// One step and 200 steps against an independent double-precision reference of the method.
///
/// Tolerances are the ones stated with the vectors: double 1e-10 of the largest value of a field
/// for a step (the reference itself moves by 1e-13 when its particles are permuted), float 2e-4
/// (24-bit state, stress by differences of numbers near 1); of semi-implicit steps 1e-9 and 1e-3,
/// since the solve multiplies them. Trajectories: see the comment at their test.

#include <gtest/gtest.h>

#include <cstdio>

#include "sim/staged.h"
#include "tests/oracle/vectors.h"
#include "tests/support/simd_levels.h"

namespace {

using namespace oracle;
using namespace neve::sim;
using namespace neve::test;

struct Tolerance {
  double field, mass_cut;
};

struct Counter {
  int compared = 0, unknown = 0;
  ~Counter() { std::printf("%d compared, %d of laws that are not here\n", compared, unknown); }
};

void compare_field(const std::string& what, const RelativeError& error, double tolerance) {
  EXPECT_LE(error.value(), tolerance) << what;
}

/// Node fields as momenta, so that nodes that carry 1e-20 of the mass weigh nothing.
void compare_nodes(const Json& expected, const NodeFields& found, const Vec3i& first_node,
                   const Tolerance& tolerance) {
  std::map<std::array<int, 3>, std::size_t> index;
  for (std::size_t q = 0; q < found.node.size(); ++q) {
    const Vec3i n = found.node[q] - first_node;
    index[{n[0], n[1], n[2]}] = q;
  }
  double heaviest = 0;
  for (const Json& m : expected["mass"]) heaviest = std::max(heaviest, m.get<double>());
  RelativeError mass, momentum, force, v_old, v_free, v_star, v_new;
  std::size_t missing = 0, seen = 0;
  for (std::size_t q = 0; q < expected["mass"].size(); ++q) {
    const double m = expected["mass"][q].get<double>();
    if (m <= tolerance.mass_cut * heaviest) continue;
    const auto at = index.find(expected["node"][q].get<std::array<int, 3>>());
    if (at == index.end()) {
      ++missing;
      continue;
    }
    ++seen;
    const std::size_t f = at->second;
    mass.add(m, found.mass[f]);
    momentum.add_all(vec3(expected["momentum"][q]), found.momentum[f]);
    force.add_all(vec3(expected["force"][q]), found.force[f]);
    v_old.add_all(m * vec3(expected["v_old"][q]), found.mass[f] * found.v_old[f]);
    v_free.add_all(m * vec3(expected["v_free"][q]), found.mass[f] * found.v_free[f]);
    v_star.add_all(m * vec3(expected["v_star"][q]), found.mass[f] * found.v_star[f]);
    v_new.add_all(m * vec3(expected["v_new"][q]), found.mass[f] * found.v_new[f]);
  }
  EXPECT_EQ(missing, 0u) << "nodes that the reference has";
  EXPECT_GT(seen, 0u);
  compare_field("node mass", mass, tolerance.field);
  compare_field("node momentum", momentum, tolerance.field);
  compare_field("node force", force, tolerance.field);
  compare_field("v_old", v_old, tolerance.field);
  compare_field("v_free", v_free, tolerance.field);
  compare_field("v_star", v_star, tolerance.field);
  compare_field("v_new", v_new, tolerance.field);
}

void compare_state(const Json& expected, const ParticleArrays& found, const Material& material,
                   bool has_C, const Tolerance& tolerance) {
  RelativeError x, v, V0, F_E, J_P, C;
  const std::vector<double> from_alpha =
      has_alpha(material) ? plastic_volumes(expected, material) : std::vector<double>();
  for (std::size_t p = 0; p < found.x.size(); ++p) {
    x.add_all(vec3(expected["x"][p]), found.x[p]);
    v.add_all(vec3(expected["v"][p]), found.v[p]);
    V0.add(expected["volume0"][p].get<double>(), found.V0[p]);
    F_E.add_all(strain_of(material, mat3(expected["FE"][p])), strain_of(material, found.F_E[p]));
    J_P.add(has_alpha(material) ? from_alpha[p] : expected["JP"][p].get<double>(), found.J_P[p]);
    C.add_all(mat3(expected["C"][p]), found.C[p]);
  }
  compare_field("x", x, tolerance.field);
  compare_field("v", v, tolerance.field);
  compare_field("V0", V0, tolerance.field);
  compare_field("F_E", F_E, tolerance.field);
  compare_field("J_P", J_P, tolerance.field);
  if (has_C) compare_field("C", C, tolerance.field);
}

void compare_steps(Precision precision, const Tolerance& explicit_tolerance,
                   const Tolerance& implicit_tolerance) {
  Counter counter;
  for (const fs::path& path : entries("step_", ".json")) {
    SCOPED_TRACE(path.filename().string());
    const Json vector = read_json(path);
    if (!is_known(vector["scene"]["material"])) {
      ++counter.unknown;
      continue;
    }
    const Setup s = setup(vector["scene"], precision);
    ++counter.compared;
    const Tolerance& tolerance = s.settings.is_implicit() ? implicit_tolerance : explicit_tolerance;
    Simulation simulation(s.settings, {s.material}, s.colliders,
                          particles(vector["before"], s.material), 1);
    const std::uint64_t hash_before = simulation.state_hash();
    const StagedStep staged = staged_step(simulation, s.dt);
    EXPECT_EQ(simulation.state_hash(), hash_before) << "looking changed the state";
    compare_nodes(vector["grid"], staged.nodes, s.first_node, tolerance);
    const bool has_C = s.settings.transfer != Transfer::flip;
    const Json& after = vector["after"];
    compare_state(after, staged.after, s.material, has_C, tolerance);
    RelativeError grad_v, trial, before_collision;
    for (std::size_t p = 0; p < staged.grad_v.size(); ++p) {
      grad_v.add_all(mat3(after["grad_v"][p]), staged.grad_v[p]);
      trial.add_all(mat3(after["FE_trial"][p]), staged.F_E_trial[p]);
      before_collision.add_all(vec3(after["v_before_collision"][p]), staged.v_before_collision[p]);
    }
    compare_field("grad v", grad_v, tolerance.field);
    compare_field("trial F_E", trial, tolerance.field);
    compare_field("v before collision", before_collision, tolerance.field);

    simulation.step(s.dt);
    EXPECT_EQ(simulation.warnings().solves_cut_short + simulation.warnings().solves_given_up, 0u);
    compare_state(after, simulation.particles(), s.material, has_C, tolerance);
    // APIC and MLS: the fused driver adds dt f to the momentum, the staged one keeps them apart.
    if (!has_C) {
      EXPECT_EQ(simulation.state_hash(), staged.state_hash) << "the two drivers differ";
    }
  }
  EXPECT_GT(counter.compared, 0) << "no vector in " << folder();
}

TEST(OracleStep, OracleStepAgreesInDoubleThroughBothDrivers) {
  at_every_simd_level([] { compare_steps(Precision::real64, {1e-10, 1e-12}, {1e-9, 1e-12}); });
}

TEST(OracleStep, OracleStepAgreesInFloatThroughBothDrivers) {
  at_every_simd_level([] { compare_steps(Precision::single, {2e-4, 1e-6}, {1e-3, 1e-6}); });
}

/// m, m/s and dimensionless: absolute, at any of the first 200 steps. The runs are not chaotic:
/// moving the start by 1e-12 m moves the end by less than 5e-12 m, a state rounded to float every
/// step moves it by 2e-7 m; so these are some hundred times above rounding, far below any change of
/// method.
struct TrajectoryTolerance {
  double x, v, F;
};

void compare_snapshot(const fs::path& path, const ParticleArrays& found, const Material& material,
                      const TrajectoryTolerance& tolerance) {
  const auto table = read_csv(path);
  const auto column = [&](const std::string& name, std::size_t p) { return table.at(name)[p]; };
  RelativeError x, v, F, J_P;
  static const char* const axis[] = {"x", "y", "z"};
  for (std::size_t p = 0; p < found.x.size(); ++p) {
    Mat3d F_E, F_P;
    for (int a = 0; a < 3; ++a) {
      x.add(column(axis[a], p), found.x[p][a]);
      v.add(column(std::string("v") + axis[a], p), found.v[p][a]);
      for (int b = 0; b < 3; ++b) {
        const std::string entry = std::to_string(a) + std::to_string(b);
        F_E(a, b) = column("FE" + entry, p);
        F_P(a, b) = column("FP" + entry, p);
      }
    }
    F.add_all(strain_of(material, F_E), strain_of(material, found.F_E[p]));
    J_P.add(laws::counts_volume(material) ? F_P.determinant()
                                          : std::exp(column("alpha", p) - alpha_at_rest(material)),
            found.J_P[p]);
  }
  EXPECT_LE(x.worst(), tolerance.x) << "x";
  EXPECT_LE(v.worst(), tolerance.v) << "v";
  EXPECT_LE(F.worst(), tolerance.F) << "F_E";
  EXPECT_LE(J_P.worst(), 3 * tolerance.F) << "J_P, three factors";
}

void compare_trajectories(Precision precision, const TrajectoryTolerance& tolerance) {
  Counter counter;
  for (const fs::path& path : entries("traj_", "")) {
    SCOPED_TRACE(path.filename().string());
    const Json scene = read_json(path / "scene.json");
    if (!is_known(scene["scene"]["material"])) {
      ++counter.unknown;
      continue;
    }
    const Setup s = setup(scene["scene"], precision);
    ++counter.compared;
    Simulation simulation(s.settings, {s.material}, s.colliders,
                          particles(scene["particles"], s.material), 1);
    const auto curves = read_csv(path / "curves.csv");
    // One for every step, where they differ.
    const auto dts = scene.value("dts", std::vector<double>());
    const auto dt = [&](std::size_t step) { return dts.empty() ? s.dt : dts.at(step); };
    for (const int snapshot : scene["snapshots"].get<std::vector<int>>()) {
      while (simulation.steps() < static_cast<std::size_t>(snapshot))
        simulation.step(dt(simulation.steps()));
      SCOPED_TRACE("step " + std::to_string(snapshot));
      char name[32];
      std::snprintf(name, sizeof name, "step_%04d.csv", snapshot);
      compare_snapshot(path / name, simulation.particles(), s.material, tolerance);
      const Summary sums = simulation.summary();
      const auto row = static_cast<std::size_t>(snapshot) - 1;
      const double scale = curves.at("kinetic")[0] + curves.at("elastic")[row];
      EXPECT_NEAR(sums.kinetic_energy, curves.at("kinetic")[row], 20 * tolerance.v * scale);
      EXPECT_NEAR(sums.elastic_energy, curves.at("elastic")[row], 20 * tolerance.v * scale);
      EXPECT_NEAR(sums.angular_momentum[2], curves.at("Lz")[row], 20 * tolerance.v * scale);
    }
    EXPECT_FALSE(simulation.divergence()) << simulation.divergence()->sentence;
    const auto V0 = read_csv(path / "volume0.csv").at("volume0");
    RelativeError volumes;
    const ParticleArrays end = simulation.particles();
    for (std::size_t p = 0; p < V0.size(); ++p) volumes.add(V0[p], end.V0[p]);
    compare_field("V0", volumes, precision == Precision::real64 ? 1e-12 : 1e-5);
  }
  EXPECT_GT(counter.compared, 0) << "no trajectory in " << folder();
}

TEST(OracleTrajectory, OracleTrajectoryAgreesInDouble) {
  at_every_simd_level([] { compare_trajectories(Precision::real64, {1e-10, 1e-8, 1e-9}); });
}

TEST(OracleTrajectory, OracleTrajectoryAgreesInFloat) {
  at_every_simd_level([] { compare_trajectories(Precision::single, {1e-5, 5e-4, 1e-4}); });
}

}  // namespace

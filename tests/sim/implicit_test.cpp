/// The semi-implicit step: the equation it solves, what it keeps, and what it does where it fails.

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <limits>

#include "sim/checks/self_test_bodies.h"
#include "sim/health/diagnostics.h"
#include "sim/kernels/held.h"
#include "sim/laws/list.h"
#include "sim/staged.h"
#include "tests/support/simd_levels.h"
#include "tests/support/snow.h"

namespace {

using namespace neve;
using namespace neve::sim;
using namespace neve::test;
using sim::checks::self_test::cell_size;
using sim::checks::self_test::weight_gradient;

/// Snow in two materials, strained and moving.
ParticleArrays strained(std::size_t count) {
  ParticleArrays p = sim::checks::self_test::small_ball();
  p.x.resize(count), p.v.resize(count), p.m.resize(count), p.V0.resize(count);
  disturb(p, 0.03, 1.0);
  for (std::size_t q = 0; q < count; ++q) p.material.push_back(static_cast<int>(q % 5));
  return p;
}

std::vector<Material> all_models() {
  std::vector<Material> materials(5);
  materials[1].model = laws::model::corotated;
  materials[1].youngs_modulus = 4e5;
  materials[2].model = laws::model::neo_hookean;
  materials[3].model = laws::model::cam_clay;
  materials[4].model = laws::model::sand;
  return materials;
}

SolverSettings implicit_settings(const checks::SelfTestCase& test, double beta) {
  SolverSettings s = sim::checks::self_test::settings_of(test);
  s.beta = beta;
  s.solve_tolerance = 1e-14;
  s.solve_iterations = 500;
  return s;
}

/// v_new of (I + beta dt^2 M^-1 H) v_new = v_star, with H put together column by column from
/// differences of the stress and from weights by their definition.
std::vector<Vec3d> solved_densely(const checks::SelfTestCase& test, const StagedStep& step,
                                  const ParticleArrays& p, const std::vector<Material>& materials,
                                  double beta_dt_squared) {
  constexpr double e = 1e-5;
  const NodeFields& nodes = step.nodes;
  const auto count = static_cast<Eigen::Index>(3 * nodes.mass.size());
  Eigen::MatrixXd A = Eigen::MatrixXd::Identity(count, count);
  Eigen::VectorXd b(count);
  for (std::size_t q = 0; q < p.x.size(); ++q) {
    const Material& material = materials[static_cast<std::size_t>(p.material[q])];
    std::vector<std::size_t> reached;
    std::vector<Vec3d> gradient;
    for (std::size_t i = 0; i < nodes.mass.size(); ++i) {
      const Vec3d d = sim::checks::self_test::place(nodes.node[i]) - p.x[q];
      if (d.cwiseAbs().maxCoeff() >= 2 * checks::self_test::cell_size) continue;
      reached.push_back(i);
      gradient.push_back(checks::self_test::weight_gradient(test.kernel, test.transfer, d));
    }
    const auto P = [&](const Mat3d& G, double by) {
      return health::first_piola(material, (Mat3d::Identity() + by * G) * p.F_E[q], p.J_P[q]);
    };
    for (std::size_t j = 0; j < reached.size(); ++j)
      for (int c = 0; c < 3; ++c) {
        const Mat3d G = checks::self_test::cell_size * Vec3d::Unit(c) * gradient[j].transpose();
        const Mat3d dP = (P(G, e) - P(G, -e)) / (2 * e * checks::self_test::cell_size);
        const Mat3d D = p.V0[q] * dP * p.F_E[q].transpose();
        for (std::size_t i = 0; i < reached.size(); ++i)
          A.block<3, 1>(static_cast<Eigen::Index>(3 * reached[i]),
                        static_cast<Eigen::Index>(3 * reached[j]) + c) +=
              beta_dt_squared / nodes.mass[reached[i]] * (D * gradient[i]);
      }
  }
  for (std::size_t i = 0; i < nodes.mass.size(); ++i)
    b.segment<3>(static_cast<Eigen::Index>(3 * i)) = nodes.v_star[i];
  const Eigen::VectorXd v = A.partialPivLu().solve(b);
  std::vector<Vec3d> out;
  for (std::size_t i = 0; i < nodes.mass.size(); ++i)
    out.push_back(v.segment<3>(static_cast<Eigen::Index>(3 * i)));
  return out;
}

/// Largest difference of momenta over the largest momentum.
double momentum_error(const NodeFields& nodes, const std::vector<Vec3d>& expected) {
  double worst = 0, largest = 0;
  for (std::size_t i = 0; i < nodes.mass.size(); ++i) {
    worst = std::max(worst, nodes.mass[i] * (nodes.v_new[i] - expected[i]).norm());
    largest = std::max(largest, nodes.mass[i] * expected[i].norm());
  }
  return worst / largest;
}

TEST(ImplicitSolve, ImplicitSolveAgreesWithADenseSolve) {
  // dt is 4 times what explicit steps would take.
  constexpr double dt = 4e-3, beta = 1;
  const ParticleArrays p = strained(12);
  for (const checks::SelfTestCase& test : checks::all_self_test_cases()) {
    const bool is_as_flip = test.transfer != Transfer::flip && test.transfer != Transfer::mls;
    if (is_as_flip && test.kernel == Kernel::quadratic) continue;
    const Simulation simulation(implicit_settings(test, beta), all_models(), {}, p, 1);
    const StagedStep step = staged_step(simulation, dt);
    const auto expected = solved_densely(test, step, p, all_models(), beta * dt * dt);
    double change = 0;
    for (std::size_t i = 0; i < expected.size(); ++i)
      change = std::max(change, (step.nodes.v_new[i] - step.nodes.v_star[i]).norm());
    EXPECT_GT(change, 0.1) << "the solve has nothing to do";
    // Differences of the stress are good to 1e-9 of the moduli; float solves to 1e-6.
    EXPECT_LE(momentum_error(step.nodes, expected),
              test.precision == Precision::real64 ? 1e-7 : 3e-4)
        << static_cast<int>(test.transfer) << static_cast<int>(test.kernel);
  }
}

TEST(ImplicitSolve, ImplicitSolveKeepsMomentum) {
  // Forces cancel whatever moves: sum grad_w = 0.
  for (const checks::SelfTestCase& test : checks::all_self_test_cases()) {
    const Simulation simulation(implicit_settings(test, 1), all_models(), {}, strained(150), 1);
    const StagedStep step = staged_step(simulation, 5e-3);
    Vec3d change(0, 0, 0);
    double size = 0;
    for (std::size_t i = 0; i < step.nodes.mass.size(); ++i) {
      change += step.nodes.mass[i] * (step.nodes.v_new[i] - step.nodes.v_star[i]);
      size += step.nodes.mass[i] * (step.nodes.v_new[i] - step.nodes.v_star[i]).norm();
    }
    EXPECT_LE(change.norm() / size, test.precision == Precision::real64 ? 1e-12 : 1e-5);
  }
}

TEST(ImplicitSolve, ImplicitSolveOfSmallBetaIsTheExplicitStep) {
  const checks::SelfTestCase test{Kernel::cubic, Transfer::flip, Precision::real64};
  Simulation explicit_run(implicit_settings(test, 0), all_models(), {}, strained(150), 1);
  Simulation implicit_run(implicit_settings(test, 1e-12), all_models(), {}, strained(150), 1);
  explicit_run.step(1e-4);
  implicit_run.step(1e-4);
  const ParticleArrays a = explicit_run.particles(), b = implicit_run.particles();
  for (std::size_t q = 0; q < a.x.size(); ++q) EXPECT_LE((a.v[q] - b.v[q]).norm(), 1e-11);
}

TEST(ImplicitSolve, ImplicitSolveEndsWithinItsToleranceAndSaysSo) {
  const checks::SelfTestCase test{Kernel::cubic, Transfer::mls, Precision::single};
  SolverSettings s = implicit_settings(test, 1);
  s.time_step = TimeStep::fixed;
  s.dt = 5e-3;
  int before = 0;
  for (const double tolerance : {1e-2, 1e-4, 1e-6}) {
    s.solve_tolerance = tolerance;
    Simulation simulation(s, all_models(), {}, strained(150), 1);
    const AdvanceReport report = simulation.advance_to(s.dt);
    ASSERT_TRUE(report.solve);
    EXPECT_LE(report.solve->residual, tolerance);
    EXPECT_GT(report.solve->residual, 0.01 * tolerance) << "took more iterations than it needed";
    EXPECT_GT(report.solve->iterations, before);
    before = report.solve->iterations;
    EXPECT_EQ(simulation.warnings().solves_cut_short, 0u);
  }
  s.solve_iterations = before / 2;
  Simulation simulation(s, all_models(), {}, strained(150), 1);
  const AdvanceReport report = simulation.advance_to(s.dt);
  EXPECT_EQ(report.solve->iterations, before / 2);
  EXPECT_GT(report.solve->residual, s.solve_tolerance);
  EXPECT_EQ(simulation.warnings().solves_cut_short, 1u);
  s.beta = 0;
  Simulation explicit_run(s, all_models(), {}, strained(150), 1);
  EXPECT_FALSE(explicit_run.advance_to(s.dt).solve);
}

/// The tolerance is that of the motion within the snow. Measured by the whole velocity, the
/// residual of snow that flies at 1000 m/s would be within any tolerance before the first
/// iteration.
TEST(ImplicitSolve, SnowThatFliesIsSolvedAsWellAsSnowAtRest) {
  const checks::SelfTestCase test{Kernel::cubic, Transfer::mls, Precision::real64};
  SolverSettings s = implicit_settings(test, 1);
  s.gravity = {0, 0, 0};
  s.solve_tolerance = 1e-3;
  const auto report_of = [&](double speed) {
    ParticleArrays particles = strained(150);
    for (Vec3d& v : particles.v) v += Vec3d(speed, 0, -speed);
    Simulation simulation(s, all_models(), {}, particles, 1);
    simulation.step(5e-3);
    return simulation.last_solve();
  };
  const SolveReport rest = report_of(0), flying = report_of(1000);
  EXPECT_GT(rest.iterations, 3);
  EXPECT_EQ(flying.iterations, rest.iterations);
  EXPECT_NEAR(flying.residual, rest.residual, 1e-6 * rest.residual);
}

TEST(ImplicitSolve, ImplicitSolveThatFailsIsReplacedByExplicitSteps) {
  // One iteration at fifty times the explicit step is worse than no motion at all, and so it is at
  // half and at a quarter of that. c dt/h may be 0.5.
  const checks::SelfTestCase test{Kernel::cubic, Transfer::flip, Precision::single};
  SolverSettings s = implicit_settings(test, 1);
  s.solve_iterations = 1;
  // Snow that stiffens little meanwhile.
  std::vector<Material> models = all_models();
  models[3] = Material{};
  Simulation failing(s, models, {}, strained(150), 1);
  constexpr double dt = 0.02;
  failing.step(dt);
  EXPECT_EQ(failing.warnings().solves_given_up, 1u + 2u + 4u);
  EXPECT_GT(failing.steps(), 20u);
  EXPECT_NEAR(failing.time(), dt, 1e-12);
  // Each of them is as long as sound allows when it begins; snow that hardens in it adds a little.
  EXPECT_LT(failing.warnings().worst_acoustic_cfl, 1.1 * s.acoustic_cfl);
  EXPECT_GT(failing.warnings().worst_acoustic_cfl, 0.5 * s.acoustic_cfl);
  s.beta = 0;
  s.max_dt = s.strain_limit = 1;  // speed and sound alone
  Simulation by_force(s, models, {}, strained(150), 1);
  for (int quarter = 0; quarter < 4; ++quarter)
    for (double left = dt / 4; left > 0;) {
      const double part = left / std::ceil(left / by_force.choose_dt(1).dt);
      by_force.step(part);
      left -= part;
    }
  EXPECT_EQ(failing.state_hash(), by_force.state_hash());
  s.beta = 1;
  s.dt = s.max_dt = dt;
  Simulation reporting(s, models, {}, strained(150), 1);
  const AdvanceReport report = reporting.advance_to(dt);
  ASSERT_TRUE(report.solve);
  EXPECT_GT(report.solve->given_up, 0u);
  EXPECT_TRUE(std::isnan(report.solve->residual)) << "no solve was taken";
  EXPECT_EQ(report.limit(), DtLimit::acoustic);  // of the steps that were taken
}

TEST(ImplicitSolve, AFrameOfSolvesGivenUpHasNoResidualWhateverFollows) {
  SolveReport given_up;
  given_up.solves = given_up.given_up = 1;
  given_up.residual = std::numeric_limits<double>::quiet_NaN();
  SolveReport frame = given_up;
  frame.add({});  // a step without snow
  EXPECT_TRUE(std::isnan(frame.residual));
  SolveReport solved;
  solved.solves = 1;
  frame.add(solved);
  EXPECT_EQ(frame.residual, 0);
  // Snow that is at rest takes no iteration.
  solved.add(given_up);
  EXPECT_EQ(solved.residual, 0);
  EXPECT_EQ(solved.given_up, 1u);
}

/// A step that is too long for the iterations is taken in two halves.
TEST(ImplicitSolve, ASolveThatIsCutShortHalvesItsStep) {
  const checks::SelfTestCase test{Kernel::cubic, Transfer::flip, Precision::single};
  SolverSettings s = implicit_settings(test, 1);
  constexpr double dt = 4e-3;
  const auto steps_with = [&](int iterations) {
    s.solve_iterations = iterations;
    s.solve_tolerance = 1e-2;
    Simulation simulation(s, all_models(), {}, strained(150), 1);
    simulation.step(dt);
    EXPECT_NEAR(simulation.time(), dt, 1e-12);
    EXPECT_LE(simulation.last_solve().residual, 0.1) << "of what was used";
    return simulation.steps();
  };
  EXPECT_EQ(steps_with(100), 1u);
  std::size_t steps = 1;
  for (int iterations = 12; steps == 1 && iterations > 1; --iterations)
    steps = steps_with(iterations);
  EXPECT_EQ(steps, 2u);
}

TEST(ImplicitSolve, ImplicitSolveOfCrushedBodiesLeavesNumbers) {
  // H is indefinite: crushed bodies buckle. dt is up to a hundred times the explicit one.
  for (const double crushed : {0.9, 0.5, 0.3})
    for (const Model model : {laws::model::snow, laws::model::corotated, laws::model::neo_hookean,
                              laws::model::cam_clay, laws::model::sand})
      for (const double dt : {1e-3, 8e-3, 5e-2}) {
        const checks::SelfTestCase test{Kernel::cubic, Transfer::flip, Precision::single};
        SolverSettings s = implicit_settings(test, 1);
        s.solve_tolerance = 1e-4;
        s.solve_iterations = 50;
        std::vector<Material> materials(1);
        materials[0].model = model;
        ParticleArrays p = sim::checks::self_test::small_ball();
        sim::checks::self_test::Numbers number(3);
        for (Vec3d& v : p.v) {
          v = number.vector();
          p.F_E.push_back(crushed * Mat3d::Identity() + 0.05 * number.matrix());
        }
        Simulation simulation(s, materials, {}, p, 1);
        const NodeFields nodes = staged_step(simulation, dt).nodes;
        double before = 0, after = 0;
        for (std::size_t i = 0; i < nodes.mass.size(); ++i) {
          before += nodes.mass[i] * nodes.v_star[i].squaredNorm();
          after += nodes.mass[i] * nodes.v_new[i].squaredNorm();
        }
        EXPECT_LE(after, 4.001 * before);
        simulation.step(dt);
        const ParticleArrays q = simulation.particles();
        for (std::size_t k = 0; k < q.x.size(); ++k)
          ASSERT_TRUE(q.x[k].allFinite() && q.v[k].allFinite() && q.F_E[k].allFinite());
      }
}

SolverSettings impact_settings(double beta, double dt) {
  SolverSettings s;
  s.cell_size = 0.02;
  s.beta = beta;
  s.time_step = TimeStep::fixed;
  s.dt = dt;
  return s;
}

Simulation impact(const SolverSettings& s, double speed) {
  const ParticleArrays p = ball_of_snow({0, 0.09, 0}, 0.07, 0.01, {0, -speed, 0});
  return Simulation(s, {Material{}}, {plane({0, 0.005, 0}, {0, 1, 0}, 0.5)}, p, 1);
}

TEST(ImplicitStep, ImplicitStepHoldsAtTenTimesTheExplicitStep) {
  // c = 19.7 m/s at rest, so 0.5 ms has c dt/h = 0.5; the impact hardens the snow besides.
  for (const double dt : {2.5e-3, 5e-3}) {
    SolverSettings settings = impact_settings(1, dt);
    settings.solve_iterations = 100;  // springs at contacts take twice as many as a free body
    Simulation held = impact(settings, 2);
    const double start = held.summary().kinetic_energy;
    const AdvanceReport report = held.advance_to(0.1);
    EXPECT_FALSE(held.divergence()) << held.divergence()->sentence;
    EXPECT_EQ(held.warnings().solves_given_up + held.warnings().solves_cut_short, 0u);
    EXPECT_LE(report.solve->residual, settings.solve_tolerance);
    const Summary s = held.summary();
    EXPECT_LT(s.kinetic_energy, 0.2 * start);
    EXPECT_GT(s.min_J_P, 0.75);
    EXPECT_GT(s.centre_of_mass[1], 0.04) << "it lies on the floor";
    Simulation lost = impact(impact_settings(0, dt), 2);
    lost.advance_to(0.1);
    EXPECT_TRUE(lost.divergence());
  }
}

double mean_J_P(const Simulation& simulation) {
  const ParticleArrays p = simulation.particles();
  double sum = 0;
  for (const double J_P : p.J_P) sum += J_P;
  return sum / static_cast<double>(p.J_P.size());
}

TEST(ImplicitStep, ImplicitStepEndsWhereSmallExplicitStepsDo) {
  for (const ContactAt contact_at : {ContactAt::nodes, ContactAt::particles}) {
    SolverSettings explicit_steps = impact_settings(0, 1e-4);
    SolverSettings implicit_steps = impact_settings(1, 1e-3);
    explicit_steps.contact_at = implicit_steps.contact_at = contact_at;
    Simulation small = impact(explicit_steps, 1), large = impact(implicit_steps, 1);
    small.advance_to(0.1);
    large.advance_to(0.1);
    // c dt/h is 0.1 and 1: some of the impact is taken as elastic that yields in small steps.
    EXPECT_NEAR(large.summary().centre_of_mass[1], small.summary().centre_of_mass[1], 0.005);
    EXPECT_NEAR(mean_J_P(large), mean_J_P(small), 0.03);
  }
}

/// Several normals of several colliders, against the space that they span.
TEST(Held, HeldDirectionsAreThoseThatNormalsSpan) {
  using V = Lanes<double, 4>;
  const auto lanes = [](const Vec3d& x) {
    return neve::Vec3<V>{all<V>(x[0]), all<V>(x[1]), all<V>(x[2])};
  };
  const Vec3d a = Vec3d(1, 2, -1).normalized(), b = Vec3d(0.3, -1, 0.2).normalized();
  const Vec3d c = Vec3d(-0.5, 0.1, 2).normalized(), x(0.7, -0.4, 1.3);
  const std::vector<std::vector<Vec3d>> cases{
      {},       {a}, {a, a}, {a, (a + 5e-4 * b).normalized()}, {a, b}, {a, b, (a + b).normalized()},
      {a, b, c}};
  for (const std::vector<Vec3d>& normals : cases) {
    kernels::Held<V> held;
    Eigen::MatrixXd span(3, 0);
    for (const Vec3d& n : normals) {
      const auto every = all<V>(0.0) <= all<V>(0.0);
      held.add({lanes(x), every, all<V>(1.0) < all<V>(0.0), lanes(n)});
      Vec3d rest = n;
      for (Eigen::Index k = 0; k < span.cols(); ++k) rest -= span.col(k) * span.col(k).dot(rest);
      if (rest.norm() < 1e-3) continue;
      span.conservativeResize(3, span.cols() + 1);
      span.rightCols(1) = rest.normalized();
    }
    const Vec3d expected = x - span * (span.transpose() * x);
    EXPECT_EQ(held.count[2], static_cast<double>(span.cols()));
    const Quad<double> node{held.axis.x[2], held.axis.y[2], held.axis.z[2], held.count[2]};
    const Quad<double> found = kernels::free_part(node, Quad<double>{x[0], x[1], x[2], 0});
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(found[k], expected[k], 1e-14);
  }
}

TEST(ImplicitStep, SoundDoesNotLimitIt) {
  SolverSettings s = impact_settings(1, 0);
  s.time_step = TimeStep::adaptive;
  s.max_dt = 5e-3;
  const auto acoustic = static_cast<std::size_t>(DtLimit::acoustic);
  Simulation simulation = impact(s, 2);
  const AdvanceReport report = simulation.advance_to(0.1);
  EXPECT_FALSE(simulation.divergence()) << simulation.divergence()->sentence;
  EXPECT_EQ(report.ruled[acoustic], 0u);
  EXPECT_TRUE(std::isinf(simulation.step_limits().dt[acoustic]));
  s.beta = 0;
  EXPECT_GT(impact(s, 2).advance_to(0.1).steps, 10 * report.steps);
  // At beta below 1/2 sound still limits steps, to 1/sqrt(1 - 2 beta) times the explicit ones.
  const double by_force = impact(s, 2).step_limits().dt[acoustic];
  s.beta = 0.375;
  s.acoustic_cfl = 0.1;  // far from where looking ahead shortens steps
  EXPECT_NEAR(impact(s, 2).step_limits().dt[acoustic], 2 * 0.1 / 0.5 * by_force, 0.1 * by_force);
}

TEST(ImplicitStep, SameBitsAtAnyNumberOfThreadsAndAfterARestart) {
  for (const Transfer transfer : {Transfer::flip, Transfer::mls, Transfer::asflip}) {
    SolverSettings s = impact_settings(0.7, 1e-3);
    s.transfer = transfer;
    s.collide_after_solve = true;
    s.cell_size = 0.01;
    const auto start = [&](int threads) {
      ParticleArrays p = ball_of_snow({0, 0.09, 0}, 0.07, 0.005, {0, -4, 0});
      EXPECT_GT(p.x.size(), 8000u) << "too few for several threads";
      return Simulation(s, {Material{}}, {plane({0, 0.005, 0}, {0, 1, 0}, 0.5)}, p, threads);
    };
    Simulation one = start(1), three = start(3);
    one.advance_to(0.01);
    three.advance_to(0.01);
    ASSERT_FALSE(one.divergence()) << one.divergence()->sentence;
    EXPECT_EQ(one.state_hash(), three.state_hash());
    Simulation again = start(2);
    again.restore(one.save());
    one.advance_to(0.015);
    again.advance_to(0.015);
    EXPECT_EQ(one.state_hash(), again.state_hash());
    EXPECT_EQ(one.save(), again.save());
  }
}

TEST(ImplicitStep, DriversAgree) {
  for (const checks::SelfTestCase& test : checks::all_self_test_cases()) {
    SolverSettings s = implicit_settings(test, 0.8);
    s.solve_tolerance = 1e-6;
    s.collide_after_solve = true;
    s.gravity = {0, -9.81, 0};
    const shapes::Collider floor =
        plane({0, -1.03 * checks::self_test::cell_size, 0}, {0.1, 1, 0}, 0.3);
    Simulation simulation(s, all_models(), {floor}, strained(160), 1);
    const StagedStep staged = staged_step(simulation, 3e-3);
    simulation.step(3e-3);
    if (test.transfer == Transfer::flip) {
      EXPECT_EQ(simulation.state_hash(), staged.state_hash);
    }
    const ParticleArrays fast = simulation.particles();
    const double tolerance = test.precision == Precision::real64 ? 1e-9 : 1e-3;
    for (std::size_t q = 0; q < fast.x.size(); ++q)
      EXPECT_LE((fast.v[q] - staged.after.v[q]).norm(), tolerance);
  }
}

TEST(CollideAfterSolve, CollisionAfterTheSolveKeepsNodesOutOfColliders) {
  const checks::SelfTestCase test{Kernel::cubic, Transfer::flip, Precision::real64};
  const double height = -0.53 * checks::self_test::cell_size;
  const auto fastest_into = [&](bool collides) {
    SolverSettings s = implicit_settings(test, 1);
    s.contact_at = ContactAt::nodes;
    s.collide_after_solve = collides;
    const Simulation simulation(s, all_models(), {plane({0, height, 0}, {0, 1, 0}, 0)},
                                strained(160), 1);
    const NodeFields nodes = staged_step(simulation, 4e-3).nodes;
    double fastest = 0;
    for (std::size_t i = 0; i < nodes.node.size(); ++i)
      if (checks::self_test::cell_size * nodes.node[i][1] <= height)
        fastest = std::max(fastest, -nodes.v_new[i][1]);
    return fastest;
  };
  // Nodes that were leaving are not held: the solve can draw them in.
  EXPECT_GT(fastest_into(false), 1e-3);
  EXPECT_LE(fastest_into(true), 0);
}

TEST(ImplicitStep, SolveCanBeSkipped) {
  const checks::SelfTestCase test{Kernel::cubic, Transfer::flip, Precision::real64};
  SolverSettings s = implicit_settings(test, 1);
  s.bypass = {Stage::implicit_solve};
  Simulation skipped(s, all_models(), {}, strained(150), 1);
  const NodeFields nodes = staged_step(skipped, 1e-3).nodes;
  for (std::size_t i = 0; i < nodes.node.size(); ++i) EXPECT_EQ(nodes.v_new[i], nodes.v_star[i]);
  EXPECT_FALSE(skipped.advance_to(1e-3).solve);
}

}  // namespace

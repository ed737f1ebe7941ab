/// A restored simulation continues bit for bit; bytes that are no state are refused.

#include <gtest/gtest.h>

#include "sim/simulation.h"
#include "tests/support/snow.h"

namespace {

using namespace neve;
using namespace neve::sim;
using namespace neve::test;

struct SaveCase {
  Transfer transfer;
  Precision precision;
};

Simulation simulate(const SolverSettings& settings, const ParticleArrays& particles, int threads) {
  shapes::Collider ball;
  ball.name = "ball";
  ball.shape.form = shapes::Sphere{{0.05, 0.02, 0.03}, 0.05};
  ball.angular_velocity = {0, 3, 1};
  ball.velocity = {0.1, 0.2, 0};
  Material stiff;
  stiff.name = "stiff";
  stiff.model = Model::corotated;
  return Simulation(settings, {Material{}, stiff}, {plane({0, 0.013, 0}, {0, 1, 0}, 0.5), ball},
                    particles, threads);
}

ParticleArrays two_materials() {
  ParticleArrays p = ball_of_snow({0.01, 0.11, -0.02}, 0.07, 0.01, {0.3, -4, 0.1});
  p.V0.assign(p.x.size(), 0.0);
  p.material.resize(p.x.size());
  for (std::size_t q = 0; q < p.x.size(); ++q) p.material[q] = p.x[q].x() > 0.05;
  return p;
}

class Save : public testing::TestWithParam<SaveCase> {};

TEST_P(Save, ARestoredRunContinuesBitForBit) {
  SolverSettings settings;
  settings.transfer = GetParam().transfer;
  settings.precision = GetParam().precision;
  const ParticleArrays particles = two_materials();
  // Before the first step, within the sorting interval, just before and just after a sort.
  for (const int steps : {0, 7, 32, 45}) {
    Simulation whole = simulate(settings, particles, 2);
    for (int k = 0; k < steps; ++k) whole.step(whole.choose_dt(1).dt);
    const std::vector<std::uint8_t> bytes = whole.save();

    Simulation again = simulate(settings, {}, 1);
    again.restore(bytes);
    EXPECT_EQ(again.state_hash(), whole.state_hash());
    EXPECT_EQ(again.save(), bytes);
    EXPECT_EQ(again.steps(), whole.steps());
    const AdvanceReport a = whole.advance_to(whole.time() + 0.02);
    const AdvanceReport b = again.advance_to(again.time() + 0.02);
    EXPECT_GT(a.steps, 33u) << "no sort was passed";
    EXPECT_EQ(a.steps, b.steps);
    EXPECT_EQ(a.dt_min, b.dt_min);
    EXPECT_EQ(whole.state_hash(), again.state_hash()) << steps;
    // Counters, limits, energy budget and storage order too.
    EXPECT_EQ(whole.save(), again.save()) << steps;
  }
}

INSTANTIATE_TEST_SUITE_P(All, Save,
                         testing::Values(SaveCase{Transfer::flip, Precision::single},
                                         SaveCase{Transfer::apic, Precision::single},
                                         SaveCase{Transfer::mls, Precision::real64},
                                         SaveCase{Transfer::aflip, Precision::real64},
                                         SaveCase{Transfer::asflip, Precision::single}));

TEST(SavedState, DamagedBytesAreRefusedAndNothingChanges) {
  Simulation simulation = simulate({}, two_materials(), 1);
  simulation.step(1e-4);
  const std::vector<std::uint8_t> good = simulation.save();
  const std::uint64_t hash = simulation.state_hash();
  const auto refused = [&](std::vector<std::uint8_t> bytes) {
    EXPECT_THROW(simulation.restore(bytes), SavedStateError);
    EXPECT_EQ(simulation.state_hash(), hash);
    EXPECT_EQ(simulation.save(), good);
  };
  refused({});
  refused({good.begin(), good.begin() + 100});
  refused({good.begin(), good.end() - 1});
  std::vector<std::uint8_t> bytes = good;
  bytes[0] ^= 1;
  refused(bytes);
  bytes = good;
  bytes[16] ^= 1;  // the count
  refused(bytes);
  bytes = good;
  bytes[23] ^= 0x80;  // a count that overflows
  refused(bytes);
  SolverSettings other;
  other.precision = Precision::real64;
  Simulation in_double = simulate(other, {}, 1);
  EXPECT_THROW(in_double.restore(good), SavedStateError);
}

/// Interrupted within a frame, saved, restored: the steps of the rest of the frame, the last one
/// too, which ends on it exactly, are those of the run that was not interrupted.
TEST(SavedState, AnInterruptedFrameContinuesBitForBit) {
  static int left = 0;
  const auto stop = [] { return --left == 0; };
  Simulation whole = simulate({}, two_materials(), 1);
  Simulation first = simulate({}, two_materials(), 1);
  whole.advance_to(1.0 / 24);
  whole.advance_to(2.0 / 24);
  first.advance_to(1.0 / 24);
  std::size_t steps = first.steps();
  for (const int count : {1, 40, 13}) {
    left = count;
    first.advance_to(2.0 / 24, stop);
    EXPECT_EQ(first.steps(), steps + static_cast<std::size_t>(count));
    steps = first.steps();
    Simulation next = simulate({}, {}, 1);
    next.restore(first.save());
    first = std::move(next);
  }
  first.advance_to(2.0 / 24);
  EXPECT_EQ(first.steps(), whole.steps());
  EXPECT_EQ(first.save(), whole.save());
}

TEST(SavedState, SavedStateOfNoParticlesIsRestored) {
  Simulation empty = simulate({}, {}, 1);
  Simulation again = simulate({}, two_materials(), 1);
  again.restore(empty.save());
  EXPECT_EQ(again.particle_count(), 0u);
  again.step(1e-3);
}

}  // namespace

/// A restored simulation continues bit for bit; bytes that are no state are refused.

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstring>
#include <limits>

#include "sim/kernels/particles.h"
#include "sim/laws/list.h"
#include "sim/simulation.h"
#include "sim/state/progress.h"
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
  stiff.model = laws::model::corotated;
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
  // States are saved before the first step, within the sorting interval, and around a sort.
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

/// Saved states with one number replaced.
class ForgedState : public testing::Test {
 protected:
  using Record = kernels::Particle<float>;
  static constexpr std::size_t progress_at = 64,
                               records_at = progress_at + sizeof(engine::Progress);

  ForgedState() {
    for (int k = 0; k < 3; ++k) simulation.step(simulation.choose_dt(1).dt);
    good = simulation.save();
  }

  template <class T>
  std::vector<std::uint8_t> with(std::size_t place, T value) const {
    std::vector<std::uint8_t> bytes = good;
    std::memcpy(bytes.data() + place, &value, sizeof value);
    return bytes;
  }
  template <class T>
  std::vector<std::uint8_t> with_progress(std::size_t member, T value) const {
    return with(progress_at + member, value);
  }
  template <class T>
  std::vector<std::uint8_t> with_particle(std::size_t index, std::size_t member, T value) const {
    return with(records_at + index * sizeof(Record) + member, value);
  }

  /// Returns the refusal of restore_healthy; "" where it takes the bytes.
  std::string refusal(const std::vector<std::uint8_t>& bytes) {
    try {
      simulation.restore_healthy(bytes);
    } catch (const SavedStateError& error) {
      EXPECT_EQ(simulation.save(), good) << "a refused state left a trace";
      return error.what();
    }
    return "";
  }
  void expect_refused(const std::vector<std::uint8_t>& bytes, const std::string& name) {
    const std::string sentence = refusal(bytes);
    EXPECT_NE(sentence.find(name), std::string::npos) << name << ": " << sentence;
  }

  static ParticleArrays few_particles() {
    ParticleArrays p = ball_of_snow({0.01, 0.04, -0.02}, 0.02, 0.01, {0.3, -4, 0.1});
    p.material.resize(p.x.size());
    for (std::size_t q = 0; q < p.x.size(); ++q) p.material[q] = q % 2;
    return p;
  }

  Simulation simulation = simulate({}, few_particles(), 1);
  std::vector<std::uint8_t> good;
};

TEST_F(ForgedState, TheStateAsItWasIsTaken) {
  EXPECT_EQ(refusal(good), "");
}

TEST_F(ForgedState, AShockPressureIsNotNegative) {
  // A change of a material finds it; behind it is the length of the dust alone.
  Material softer, stiff;
  softer.youngs_modulus /= 2;
  stiff.model = laws::model::corotated;
  simulation.apply({}, {softer, stiff}, {});
  good = simulation.save();
  EXPECT_EQ(refusal(good), "");
  expect_refused(with(good.size() - sizeof(std::uint64_t) - sizeof(float), -1.0f),
                 "a shock pressure");
}

TEST_F(ForgedState, PlacesInMemoryAreRefused) {
  const auto expect_never_taken = [&](const std::vector<std::uint8_t>& bytes, const char* name) {
    expect_refused(bytes, name);
    EXPECT_THROW(simulation.restore(bytes), SavedStateError) << name;
  };
  std::int32_t kind = 0, id = 0;
  std::memcpy(&kind, good.data() + records_at + offsetof(Record, kind), sizeof kind);
  std::memcpy(&id, good.data() + records_at + offsetof(Record, id), sizeof id);
  const std::int32_t law = kind & ~0xff0000;
  for (const std::int32_t model : {64, 255, 3, (kind >> 16 & 0xff) == 1 ? 0 : 1})
    expect_never_taken(with_particle(0, offsetof(Record, kind), law | model << 16), "model");
  expect_never_taken(with_particle(0, offsetof(Record, kind), kind | 0x42000000), "flags");
  expect_never_taken(with_particle(0, offsetof(Record, kind), (kind & ~0xffff) | 2), "material");
  expect_never_taken(with_particle(0, offsetof(Record, id), -1), "id");
  expect_never_taken(with_particle(0, offsetof(Record, id), 1 << 30), "id");
  expect_never_taken(with_particle(1, offsetof(Record, id), id), "two particles with id");
  expect_never_taken(with_particle(0, offsetof(Record, cell), 1 << 30), "lattice");
  const std::size_t next_id = offsetof(engine::Progress, next_id);
  expect_never_taken(with_progress(next_id, std::uint64_t{1}), "next_id");
  expect_never_taken(with_progress(next_id, ~std::uint64_t{0}), "next_id");
}

/// The state claims so many particles that left: a list with a place for each would take gigabytes.
TEST_F(ForgedState, IdsOfParticlesThatLeftCostNoMemory) {
  std::vector<std::uint8_t> bytes =
      with_progress(offsetof(engine::Progress, next_id), std::uint64_t{2'147'483'647});
  const ParticleArrays before = simulation.particles();
  simulation.restore_healthy(bytes);
  const ParticleArrays after = simulation.particles();
  ASSERT_EQ(after.id.size(), before.x.size());
  for (std::size_t q = 0; q < before.x.size(); ++q) {
    EXPECT_EQ(after.id[q], q);
    EXPECT_EQ(after.x[q], before.x[q]);
  }
  EXPECT_EQ(simulation.kirchhoff().size(), before.x.size());
}

TEST_F(ForgedState, NumbersThatNoHealthyRunHasAreRefused) {
  using engine::Progress;
  const double nan = std::nan(""), infinite = std::numeric_limits<double>::infinity();
  for (const double value : {nan, -1.0, -1e308, infinite}) {
    expect_refused(with_progress(offsetof(Progress, time), value), "time");
    expect_refused(with_progress(offsetof(Progress, colliders_time), value), "colliders_time");
    expect_refused(with_progress(offsetof(Progress, last_dt), value), "last_dt");
    expect_refused(with_progress(offsetof(Progress, rest_dt), value), "rest_dt");
    expect_refused(with_progress(offsetof(Progress, dt_scale), value), "dt_scale");
    expect_refused(with_progress(offsetof(Progress, frame.done), value), "frame.done");
    expect_refused(with_progress(offsetof(Progress, limits.max_speed), value), "max_speed");
    expect_refused(with_progress(offsetof(Progress, flow.emitted_mass), value), "emitted_mass");
  }
  expect_refused(with_progress(offsetof(Progress, dt_scale), 0.0), "dt_scale");
  expect_refused(with_progress(offsetof(Progress, limits.max_speed), 1e300), "limits with dt");
  expect_refused(with_progress(offsetof(Progress, energy.start), nan), "energy.start");
  for (const std::size_t place : {offsetof(Progress, steps), offsetof(Progress, flow.emitted),
                                  offsetof(Progress, steps_since_sink_check)})
    EXPECT_NE(refusal(with_progress(place, ~std::uint64_t{0})), "") << place;
  const float no_number = std::nanf("");
  expect_refused(with_particle(5, offsetof(Record, offset), no_number), "offset");
  expect_refused(with_particle(5, offsetof(Record, offset), 1e30f), "offset");
  expect_refused(with_particle(5, offsetof(Record, m), 0.0f), " m ");
  expect_refused(with_particle(5, offsetof(Record, J_P), -1.0f), "J_P");
  expect_refused(with_particle(5, offsetof(Record, V0), -1.0f), "V0");
  expect_refused(with_particle(5, offsetof(Record, F_E), no_number), "F_E");
}

/// A state with any word replaced is refused, or the run continues in bounded time.
TEST_F(ForgedState, NoWordOfAStateCrashesOrHangs) {
  const std::uint64_t words[] = {0,
                                 1,
                                 ~std::uint64_t{0},
                                 std::uint64_t{1} << 63,
                                 0x7ff8000000000000,
                                 0x7fefffffffffffff,
                                 500'000'000,
                                 2'147'483'647};
  int taken = 0;
  const std::size_t end = records_at + 3 * sizeof(Record);
  for (std::size_t place = 0; place + 8 <= good.size(); place += place < end ? 4 : 404)
    for (const std::uint64_t word : words) {
      try {
        simulation.restore_healthy(with(place, word));
      } catch (const SavedStateError&) {
        continue;
      }
      ++taken;
      simulation.advance_to(simulation.time() + 1e-4, {}, simulation.steps() + 2);
      simulation.particles();
      simulation.restore(good);
    }
  EXPECT_GT(taken, 100);
}

TEST(SavedState, SavedStateOfNoParticlesIsRestored) {
  Simulation empty = simulate({}, {}, 1);
  Simulation again = simulate({}, two_materials(), 1);
  again.restore(empty.save());
  EXPECT_EQ(again.particle_count(), 0u);
  again.step(1e-3);
}

}  // namespace

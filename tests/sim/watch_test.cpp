/// The run-time watch: silent in right runs, changes nothing, names what is wrong.

#include "sim/checks/watch.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "sim/checks/places.h"
#include "sim/laws/list.h"
#include "tests/support/clay_sample.h"
#include "tests/support/elastic.h"
#include "tests/support/snow.h"

namespace {

using namespace neve::sim;
using namespace neve::test;

/// A snowball that hits a sticky floor at 5 m/s.
struct Drop {
  SolverSettings settings;
  std::vector<Material> materials{Material{}};
  ParticleArrays particles = ball_of_snow({0, 0.16, 0}, 0.14, 0.03, {0.5, -5, 0});
  std::vector<shapes::Collider> floor{plane({0, 0, 0}, {0, 1, 0}, 0.5, shapes::Contact::sticky)};

  explicit Drop(Precision precision = Precision::single) {
    settings.cell_size = 0.05;
    settings.precision = precision;
  }
  Simulation simulation() const { return {settings, materials, floor, particles, 1}; }
  checks::Watch watch() const { return {settings, materials}; }
};

const checks::WatchRecord& record_of(const checks::Watch& watch, checks::WatchCheck check) {
  return watch.records()[static_cast<std::size_t>(check)];
}

bool has(const std::vector<std::string>& sentences, const std::string& part) {
  for (const std::string& sentence : sentences)
    if (sentence.find(part) != std::string::npos) return true;
  return false;
}

TEST(Watch, WatchIsSilentInARightRun) {
  for (const Precision precision : {Precision::single, Precision::real64})
    for (const Kernel kernel : {Kernel::cubic, Kernel::quadratic})
      for (const Transfer transfer :
           {Transfer::flip, Transfer::apic, Transfer::mls, Transfer::aflip, Transfer::asflip}) {
        Drop drop(precision);
        drop.settings.kernel = kernel;
        drop.settings.transfer = transfer;
        Simulation simulation = drop.simulation();
        checks::Watch watch = drop.watch();
        for (int frame = 0; frame <= 20; ++frame) {
          if (frame > 0) simulation.advance_to(0.005 * frame);
          for (const std::string& sentence : watch.look(simulation)) ADD_FAILURE() << sentence;
        }
        EXPECT_EQ(watch.looks(), 21u);
        EXPECT_FALSE(watch.has_errors());
      }
}

TEST(Watch, ChangesNoBitOfTheRun) {
  const Drop drop;
  Simulation watched = drop.simulation(), alone = drop.simulation();
  checks::Watch watch = drop.watch();
  for (int step = 0; step < 60; ++step) {
    const std::uint64_t before = watched.state_hash();
    watch.look(watched);
    ASSERT_EQ(watched.state_hash(), before);
    watched.step(2e-4);
    alone.step(2e-4);
    ASSERT_EQ(watched.state_hash(), alone.state_hash()) << step;
  }
  EXPECT_EQ(watched.save(), alone.save());
}

TEST(Watch, WatchSeesAStepThatIsTooLongBeforeItIsTaken) {
  Drop drop;
  drop.settings.time_step = TimeStep::fixed;
  drop.settings.dt = 1.0 / 240;
  checks::Watch watch = drop.watch();
  const auto sentences = watch.look(drop.simulation());
  EXPECT_TRUE(watch.has_errors());
  EXPECT_TRUE(has(sentences, "step 0: the acoustic CFL c dt/h is 1.")) << sentences.size();
  EXPECT_TRUE(has(sentences, "at most 0.5 is expected"));
  // 0.5 h / c with c = 19.7 m/s, the sound speed of the paper's snow.
  EXPECT_TRUE(has(sentences, "use dt = 0.00127 s, or adaptive steps"));
  EXPECT_EQ(record_of(watch, checks::WatchCheck::acoustic_cfl).times, 1u);
  EXPECT_EQ(record_of(watch, checks::WatchCheck::acoustic_cfl).first_step, 0u);
}

TEST(Watch, WatchReportsALawOnceAndCountsIt) {
  Drop drop;
  drop.settings.time_step = TimeStep::fixed;
  drop.settings.dt = 1.0 / 1200;
  Simulation simulation = drop.simulation();
  checks::Watch watch = drop.watch();
  std::size_t said = 0;
  double worst = 0;
  for (int step = 0; step < 40; ++step) {
    if (has(watch.look(simulation), "acoustic CFL")) ++said;
    worst = std::max(worst, watch.measure(simulation)[checks::WatchCheck::acoustic_cfl]);
    simulation.step(drop.settings.dt);
  }
  const checks::WatchRecord& record = record_of(watch, checks::WatchCheck::acoustic_cfl);
  EXPECT_EQ(said, 1u);
  EXPECT_GT(record.times, 1u);
  EXPECT_GT(record.first_step, 0u);
  EXPECT_EQ(record.worst, worst);
}

/// A state with one particle spoilt.
std::vector<std::string> look_at(const Drop& drop) {
  checks::Watch watch = drop.watch();
  return watch.look(drop.simulation());
}

TEST(Watch, WatchNamesTheBrokenLawOfAState) {
  Drop lost;
  lost.particles.v[7][1] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(has(look_at(lost), "particles that are not finite is 1"));

  Drop inverted;
  inverted.materials[0].model = laws::model::corotated;
  inverted.particles.F_E.assign(inverted.particles.x.size(), Mat3d::Identity());
  inverted.particles.F_E[7](0, 0) = -0.5;
  EXPECT_TRUE(has(look_at(inverted), "det F_E is -0.5"));

  Drop packed;
  packed.particles.J_P.assign(packed.particles.x.size(), 1);
  packed.particles.J_P[7] = 0.15;
  EXPECT_TRUE(has(look_at(packed), "smallest J_P is 0.15"));
  EXPECT_TRUE(has(look_at(packed), "hardening"));

  Drop torn;
  torn.particles.J_P.assign(torn.particles.x.size(), 1);
  torn.particles.J_P[7] = 6000;
  EXPECT_TRUE(has(look_at(torn), "largest J_P is 6e+03"));

  Drop fast;
  fast.particles.v[7] = {25, 0, 0};
  EXPECT_TRUE(has(look_at(fast), "speed relative to sound is 1.2"));
}

TEST(Watch, WatchDoesNotBlameTheSolverForSkippedStages) {
  Drop drop;
  disturb(drop.particles, 0.01, 1);
  EXPECT_TRUE(look_at(drop).empty());
  drop.settings.bypass = {Stage::grid_velocities};
  EXPECT_TRUE(look_at(drop).empty());
}

TEST(Watch, WatchLooksAtTheFirstStepsAndThenRarely) {
  std::vector<std::size_t> due;
  for (std::size_t step = 0; step < 1000; ++step)
    if (checks::is_watch_due(step)) due.push_back(step);
  EXPECT_EQ(due, (std::vector<std::size_t>{0, 1, 2, 4, 8, 16, 32, 64, 128, 256, 512, 768}));
}

TEST(Watch, WatchIsSilentInAnEmptyScene) {
  Drop drop;
  drop.particles = {};
  EXPECT_TRUE(look_at(drop).empty());
}

struct Move {
  Transfer transfer;
  Advect advect;
};

/// A ball of five cells in radius that breaks on a floor, 0.3 s after its start.
double believed_volume_after_impact(const Move& move, bool& is_said) {
  SolverSettings s;
  s.cell_size = 0.03;
  s.transfer = move.transfer;
  s.advect = move.advect;
  Material dry;
  dry.youngs_modulus = 2e5;
  dry.critical_compression = 0.03;
  dry.critical_stretch = 0.005;
  Simulation simulation(s, {dry}, {plane({0, 0, 0}, {0, 1, 0}, 0.5)},
                        ball_of_snow({0, 0.16, 0}, 0.15, 0.015, {0.4, -4, 0}), 1);
  simulation.advance_to(0.3);
  EXPECT_FALSE(simulation.divergence());
  checks::Watch watch(s, {dry});
  is_said = has(watch.look(simulation), "volume that F believes in");
  return checks::believed_volume(simulation.particles(), {dry}, 1u << 30);
}

/// The paper's line parts F from the places; whatever moves by the grid's velocity, and ASFLIP in
/// compressed snow, does not.
TEST(Places, SnowIsWhereFSaysUnlessItMovesByWhatDoesNotStrainIt) {
  bool is_said = false;
  for (const Move& move :
       {Move{Transfer::flip, Advect::pic}, Move{Transfer::apic, Advect::particle},
        Move{Transfer::mls, Advect::particle}, Move{Transfer::aflip, Advect::particle},
        Move{Transfer::asflip, Advect::particle}}) {
    EXPECT_NEAR(believed_volume_after_impact(move, is_said), 1, 0.1) << name(move.transfer);
    EXPECT_FALSE(is_said) << name(move.transfer);
  }
  EXPECT_GT(believed_volume_after_impact({Transfer::flip, Advect::particle}, is_said), 1.2);
  EXPECT_TRUE(is_said);
}

/// Packed, loose and thin snow has 1 to a percent on a lattice; pieces too few to tell have 1.
TEST(Places, BelievedVolumeIsOneWhereSnowIsWhereFSays) {
  for (const double stretch : {0.5, 1.0, 1.3}) {
    ParticleArrays p = lattice({0, 0, 0}, Vec3d::Constant(0.2), {16, 16, 16}, 400);
    const Simulation simulation(SolverSettings{}, {Material{}}, {}, p, 1);
    p = simulation.particles();
    for (std::size_t q = 0; q < p.x.size(); ++q) {
      p.x[q][1] *= stretch;
      p.J_P[q] = stretch;
    }
    EXPECT_NEAR(checks::believed_volume(p, {Material{}}, 1u << 30), 1, 0.02) << stretch;
    for (double& J_P : p.J_P) J_P *= 1.5;
    EXPECT_NEAR(checks::believed_volume(p, {Material{}}, 1u << 30), 1.5, 0.03) << stretch;
    EXPECT_EQ(checks::believed_volume(p, {Material{}}, 0), 1) << "all were born";
    Material isochoric = clay();
    isochoric.own[laws::cam_clay::flow] = laws::cam_clay::isochoric;
    EXPECT_EQ(checks::believed_volume(p, {isochoric}, 1u << 30), 1) << "its J_P is no volume";
  }
  const ParticleArrays few = lattice({0, 0, 0}, Vec3d::Constant(0.02), {2, 2, 2}, 400);
  const Simulation simulation(SolverSettings{}, {Material{}}, {}, few, 1);
  EXPECT_EQ(checks::believed_volume(simulation.particles(), {Material{}}, 1u << 30), 1);
}

}  // namespace

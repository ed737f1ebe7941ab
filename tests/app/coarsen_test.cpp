// The same scene with larger cells.
#include "app/scene/coarsen.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "app/health/expected.h"
#include "app/health/softness.h"
#include "app/record/picture_record.h"
#include "app/scene/names.h"
#include "app/scene/read.h"
#include "app/setup/auto_ranges.h"
#include "app/setup/plan.h"
#include "app/setup/seed_scene.h"
#include "app/support/errors.h"
#include "sim/laws/cam_clay.h"
#include "sim/laws/threshold_cell.h"
#include "sim/types/time_step.h"

namespace neve::app {
namespace {

app::scene::Scene coarse_ball(const std::string& solver = "") {
  return app::scene::read_scene_text(
      "[solver]\ncell_size = 0.02\n" + solver +
          "[[body]]\nname = \"ball\"\n"
          "shape = { sphere = { center = [0, 0.3, 0], radius = 0.15 } }\n",
      "ball.toml");
}

std::string message_of(app::scene::Scene scene, double factor) {
  try {
    app::scene::coarsen(scene, factor);
  } catch (const app::UsageError& error) {
    return error.what();
  }
  return "";
}

TEST(Coarsen, CellsAndLongestStepsGrowParticlesPerCellStay) {
  app::scene::Scene scene = coarse_ball("dt = 1e-4\n");
  app::scene::coarsen(scene, 2);
  EXPECT_EQ(scene.solver.cell_size, 0.04);
  EXPECT_EQ(scene.solver.dt, 2e-4);
  EXPECT_EQ(scene.solver.max_dt, 2e-3);
  EXPECT_EQ(scene.bodies[0].particles_per_cell, 8);
  EXPECT_EQ(scene.solver.flip_ratio, 0.95);
}

TEST(Coarsen, SettingsAreThoseThatTheFileHasAndSetTakes) {
  app::scene::Scene scene = coarse_ball("dt = 1e-4\nflip_reference_dt = 0\n");
  const double ratio = scene.solver.flip_ratio;
  app::scene::coarsen(scene, 3);
  app::scene::refine_settings(scene, 3);
  EXPECT_DOUBLE_EQ(scene.solver.cell_size, 0.02);
  EXPECT_DOUBLE_EQ(scene.solver.dt, 1e-4);
  EXPECT_DOUBLE_EQ(scene.solver.max_dt, 1e-3);
  EXPECT_NEAR(scene.solver.flip_ratio, ratio, 1e-11);
  EXPECT_EQ(app::scene::setting_text("solver.dt", 6e-4, 1), "solver.dt = 0.0006");
  EXPECT_EQ(app::scene::setting_text("solver.dt", 6e-4, 3),
            "solver.dt = 0.0002 (--coarsen 3 makes it 0.0006)");
}

TEST(Coarsen, CoarseningLeavesAnEighthOfTheParticlesAndAllOfTheMass) {
  app::scene::Scene coarse = coarse_ball();
  app::scene::coarsen(coarse, 2);
  const sim::ParticleArrays all = app::setup::seed_scene(coarse_ball()).particles,
                            few = app::setup::seed_scene(coarse).particles;
  // Cells on the surface are in or out by chance, about 6 h^2 of them per 10 h^2 of surface.
  EXPECT_NEAR(static_cast<double>(few.x.size()), static_cast<double>(all.x.size()) / 8,
              0.03 * static_cast<double>(all.x.size()) / 8);
  const auto mass = [](const sim::ParticleArrays& p) {
    double sum = 0;
    for (const double m : p.m) sum += m;
    return sum;
  };
  EXPECT_NEAR(mass(few), mass(all), 1e-9 * mass(all));
}

/// Share of a difference to the grid's velocity that FLIP keeps over the same time.
double kept(const sim::SolverSettings& s, double dt, int steps) {
  return std::pow(sim::flip_share(s, dt), steps);
}

TEST(Coarsen, CoarseningKeepsTheDampingPerSecond) {
  for (const char* reference : {"flip_reference_dt = 5e-4\n", "flip_reference_dt = 0\n"}) {
    const app::scene::Scene full = coarse_ball(reference);
    app::scene::Scene coarse = full;
    app::scene::coarsen(coarse, 3);
    EXPECT_NEAR(kept(coarse.solver, 3e-4, 10), kept(full.solver, 1e-4, 30), 1e-11) << reference;
  }
}

TEST(Coarsen, ThresholdsOfSnowAreThoseOfTheCellsThatTheSceneHad) {
  app::scene::Scene scene = coarse_ball();
  EXPECT_EQ(app::scene::coarsen(scene, 4), std::vector<std::string>{"solver.threshold_cell=0.02"});
  EXPECT_EQ(scene.solver.threshold_cell, 0.02);
  EXPECT_EQ(scene.materials[0].critical_stretch, 0.0075) << "the number that the scene has";
  const sim::Material in_cells = sim::laws::in_cells(scene.materials[0], scene.solver);
  EXPECT_DOUBLE_EQ(in_cells.critical_stretch, 0.0075 / 2);
  EXPECT_DOUBLE_EQ(in_cells.critical_compression, 0.025 / std::sqrt(2));
  EXPECT_EQ(app::scene::coarsened_words(scene, 4),
            ", coarsened 4x, thresholds for cells of 0.02 m");
  EXPECT_TRUE(app::scene::coarsen(scene, 2).empty());
  EXPECT_EQ(scene.solver.threshold_cell, 0.02) << "a copy of a copy is a copy";
}

/// One place has the factors: who asks for what a scene with threshold_cell does gets what the
/// scene with the scaled numbers does.
TEST(Coarsen, EveryoneSeesThresholdsAsTheyAreInTheCells) {
  const app::scene::Scene scene = app::scene::read_scene_text(
      "[solver]\ncell_size = 0.02\nthreshold_cell = 0.0002\n"
      "[[body]]\nshape = { sphere = { center = [0, 0.05, 0], radius = 0.05 } }\n"
      "velocity = [0, -4, 0]\n[[collider]]\nshape = { plane = { normal = [0, 1, 0] } }\n",
      "ball.toml");
  app::scene::Scene scaled = scene;
  scaled.materials = sim::laws::in_cells(scene.materials, scene.solver);
  scaled.solver.threshold_cell = 0;
  ASSERT_NE(scaled.materials[0].critical_stretch, scene.materials[0].critical_stretch);
  const app::setup::SeededScene seeded = app::setup::seed_scene(scene);
  sim::Simulation simulation = app::setup::make_simulation(scene, seeded.particles, 1),
                  same = app::setup::make_simulation(scaled, seeded.particles, 1);
  for (sim::Simulation* each : {&simulation, &same}) each->advance_to(0.01);  // into the floor
  EXPECT_EQ(simulation.state_hash(), same.state_hash());
  for (const auto color :
       {app::scene::ColorBy::J_E, app::scene::ColorBy::von_mises, app::scene::ColorBy::pressure})
    EXPECT_EQ(app::setup::automatic_range(scene, color, 100).max,
              app::setup::automatic_range(scaled, color, 100).max)
        << app::scene::name(color);
  const sim::ParticleArrays state = simulation.particles();
  EXPECT_EQ(app::health::Expected(scene, state, 1e-4).stretch().range.max,
            app::health::Expected(scaled, state, 1e-4).stretch().range.max);
  const double advised =
      app::health::stiffness_that_holds(scene.materials[0], scene.solver, 0.25, 600);
  EXPECT_EQ(advised,
            app::health::stiffness_that_holds(scaled.materials[0], scaled.solver, 0.25, 600));
  EXPECT_NE(advised,
            app::health::stiffness_that_holds(scene.materials[0], scaled.solver, 0.25, 600))
      << "the advice depends on the threshold";
}

TEST(Coarsen, CamClayKeepsItsCrackEnergyByItsCohesion) {
  app::scene::Scene clay = coarse_ball("[material.snow]\nmodel = \"cam_clay\"\n");
  app::scene::coarsen(clay, 4);
  const sim::Material in_cells = sim::laws::in_cells(clay.materials[0], clay.solver);
  EXPECT_DOUBLE_EQ(in_cells.own[sim::laws::cam_clay::cohesion],
                   clay.materials[0].own[sim::laws::cam_clay::cohesion] / 2);
  EXPECT_EQ(in_cells.consolidation_pressure, clay.materials[0].consolidation_pressure);
  EXPECT_EQ(in_cells.critical_stretch, clay.materials[0].critical_stretch);
}

TEST(Coarsen, ThresholdsAreLeftAloneWhereCellsAreNotCoarsenedOrThereAreNone) {
  EXPECT_EQ(sim::laws::in_cells(coarse_ball().materials[0], coarse_ball().solver).critical_stretch,
            0.0075);
  app::scene::Scene chosen = coarse_ball("threshold_cell = 0.03\n");
  app::scene::coarsen(chosen, 2);
  EXPECT_EQ(chosen.solver.threshold_cell, 0.03);
  app::scene::Scene sand = coarse_ball("[material.snow]\nmodel = \"sand\"\n");
  app::scene::coarsen(sand, 2);
  EXPECT_EQ(sand.solver.threshold_cell, 0);
  EXPECT_EQ(app::scene::coarsened_words(sand, 2), ", coarsened 2x");
}

TEST(Coarsen, FinerCellsAreToughByTheSameRule) {
  const app::scene::Scene fine = app::scene::read_scene_text(
      "[solver]\ncell_size = 0.01\nthreshold_cell = 0.04\n"
      "[[body]]\nshape = { sphere = { center = [0, 0.3, 0], radius = 0.15 } }\n",
      "fine.toml");
  EXPECT_DOUBLE_EQ(sim::laws::in_cells(fine.materials[0], fine.solver).critical_stretch, 0.015);
  EXPECT_THROW(app::scene::read_scene_text(
                   "[solver]\ncell_size = 0.01\nthreshold_cell = 100000\n"
                   "[[body]]\nshape = { sphere = { center = [0, 0.3, 0], radius = 0.15 } }\n",
                   "too_fine.toml"),
               app::scene::toml::SceneError)
      << "critical_compression would be above 1";
}

TEST(Coarsen, LumpsStayWhereTheyAreAndSeedsDrawThemAnew) {
  app::scene::Scene full =
      coarse_ball("[material.snow]\nvariation = { thresholds = 1, size = 0.06 }\n");
  app::scene::Scene coarse = full, other = full;
  app::scene::coarsen(coarse, 2);
  other.seed = 2;
  const auto particles = [](const app::scene::Scene& scene) {
    return app::setup::seed_scene(scene).particles;
  };
  const sim::ParticleArrays few = particles(coarse), all = particles(full), anew = particles(other);
  // Mean difference of log factors between each coarse particle and the nearest fine one, 0.008 m
  // away: a seventh of a lump. Their standard deviation is sqrt(ln 2) = 0.83.
  const auto apart = [&](const sim::ParticleArrays& fine) {
    double sum = 0;
    for (std::size_t p = 0; p < few.x.size(); p += 10) {
      std::size_t nearest = 0;
      for (std::size_t q = 1; q < fine.x.size(); ++q)
        if ((fine.x[q] - few.x[p]).squaredNorm() < (fine.x[nearest] - few.x[p]).squaredNorm())
          nearest = q;
      sum += std::abs(std::log(few.threshold[p] / fine.threshold[nearest]));
    }
    return sum * 10 / static_cast<double>(few.x.size());
  };
  EXPECT_LT(apart(all), 0.25);
  EXPECT_GT(apart(anew), 0.5);
}

TEST(Coarsen, AFactorOfOneChangesNothing) {
  app::scene::Scene scene = coarse_ball();
  app::scene::coarsen(scene, 1);
  EXPECT_EQ(app::scene::write_scene(scene), app::scene::write_scene(coarse_ball()));
}

TEST(Coarsen, FractionsAreTidy) {
  app::scene::Scene scene = coarse_ball();
  scene.solver.cell_size = 0.018;
  app::scene::coarsen(scene, 1.5);
  EXPECT_EQ(scene.solver.cell_size, 0.027);
}

TEST(Coarsen, TheResultIsASceneThatReadsBack) {
  app::scene::Scene scene = coarse_ball("flip_reference_dt = 0\n");
  app::scene::coarsen(scene, 2.5);
  EXPECT_EQ(app::scene::write_scene(
                app::scene::read_scene_text(app::scene::write_scene(scene), "coarse.toml")),
            app::scene::write_scene(scene));
}

TEST(Coarsen, CoarseningRefusesInvalidFactors) {
  for (const double factor : {0.0, -2.0, 0.5, std::numeric_limits<double>::quiet_NaN(),
                              std::numeric_limits<double>::infinity()})
    EXPECT_NE(message_of(coarse_ball(), factor).find("at least 1"), std::string::npos) << factor;
}

TEST(Coarsen, CoarseningRefusesToEmptyABodyAndNamesALimit) {
  // 4/3 pi 0.15^3 m3 of 8 per 0.02^3 m3 are 14137 particles, 24.18 cubed.
  const std::string message = message_of(coarse_ball(), 25);
  EXPECT_NE(message.find("no particle of body ball"), std::string::npos) << message;
  EXPECT_NE(message.find("at most 24.17 leaves one"), std::string::npos) << message;
  EXPECT_EQ(message_of(coarse_ball(), 24.17), "");
}

TEST(Coarsen, CoarseningRefusesStepsOutOfRange) {
  const std::string message = message_of(coarse_ball("max_dt = 0.5\n"), 4);
  EXPECT_NE(message.find("solver.max_dt would become 2"), std::string::npos) << message;
}

TEST(Coarsen, PicturesRecordTheFactorAndOldOnesDoNotNeedIt) {
  app::record::PictureRecord record;
  record.coarsening = 1.5;
  EXPECT_EQ(app::record::to_png_text(record).at("neve:coarsen"), "1.5");
  EXPECT_EQ(app::record::to_json(record)["coarsen"], 1.5);
}

}  // namespace
}  // namespace neve::app

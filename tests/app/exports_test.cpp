/// Exports: limits of formats, mistakes in [[export]], axes of files.

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>
#include <variant>

#include "app/exports/encode.h"
#include "app/exports/series.h"
#include "app/scene/read.h"
#include "app/setup/seed_scene.h"
#include "app/support/errors.h"

namespace {

using namespace neve;
using app::scene::ExportAttribute;
using app::scene::ExportFormat;

app::scene::Scene scene_with(const std::string& exports) {
  return app::scene::read_scene_text(
      "[[body]]\nname = \"ball\"\nshape = { sphere = { radius = 0.1 } }\n" + exports, "scene");
}

std::string error_of_export(const std::string& exports) {
  try {
    scene_with(exports);
  } catch (const app::scene::toml::SceneError& error) {
    return error.what();
  }
  return "";
}

app::scene::Export spec_of(ExportFormat format, std::vector<ExportAttribute> attributes) {
  app::scene::Export e;
  e.format = format;
  e.attributes = std::move(attributes);
  return e;
}

/// @return the hint, "" where it holds
std::string refusal(ExportFormat format, ExportAttribute attribute, double particles) {
  const auto e = spec_of(format, {attribute});
  try {
    app::exports::check_capacity(e, app::exports::empty_table(scene_with(""), e, {}), particles);
  } catch (const app::LimitError& error) {
    EXPECT_EQ(error.code, app::exit_refused);
    return error.hint;
  }
  return "";
}

TEST(Exports, MoreParticlesThanAFormatHoldsAreRefused) {
  constexpr double many = 4294967296;
  for (const auto format : {ExportFormat::bgeo, ExportFormat::npz})
    EXPECT_NE(refusal(format, ExportAttribute::J_P, many).find("use ply or vtp"),
              std::string::npos);
  for (const auto format : {ExportFormat::ply, ExportFormat::vtp, ExportFormat::csv})
    EXPECT_EQ(refusal(format, ExportAttribute::J_P, many), "");
  EXPECT_EQ(refusal(ExportFormat::bgeo, ExportAttribute::F_E, 2147483647), "");
  EXPECT_NE(refusal(ExportFormat::bgeo, ExportAttribute::F_E, 2147483648.0), "");
  // All arrays of a file are in 4 GiB: places of three doubles, which are always there, and with
  // them tensors of nine floats (60 bytes, 71.6 million) or numbers of four bytes (153.4 million).
  EXPECT_EQ(refusal(ExportFormat::npz, ExportAttribute::F_E, 71.5e6), "");
  EXPECT_NE(refusal(ExportFormat::npz, ExportAttribute::F_E, 71.6e6), "");
  EXPECT_EQ(refusal(ExportFormat::npz, ExportAttribute::id, 153.3e6), "");
  EXPECT_NE(refusal(ExportFormat::npz, ExportAttribute::id, 153.4e6), "");
}

TEST(Exports, AGridAroundSnowThatIsFarApartIsRefused) {
  const app::scene::Scene scene = scene_with("");
  const auto e = spec_of(ExportFormat::vti, {});
  app::exports::State state;
  sim::RasterizedNodes& nodes = state.nodes[{}];
  nodes.spacing = 0.1;
  nodes.block = {{-2, 0, 0}, {5, 1, 3}};
  nodes.mass.assign(128, 1.0);
  nodes.velocity.assign(128, sim::Vec3d(1, 2, 3));
  const app::exports::Table none;
  const std::string small = app::exports::encode_vti({scene, e, state, none});
  EXPECT_NE(small.find("WholeExtent=\"0 31 0 7 0 15\" Origin=\"-0.8 0 0\" Spacing=\"0.1 0.1 0.1\""),
            std::string::npos)
      << small.substr(0, 400);
  nodes.block = {{-100000, -100000, -100000}, {100000, 100000, 100000}};
  try {
    app::exports::encode_vti({scene, e, state, none});
    FAIL() << "was written";
  } catch (const app::LimitError& error) {
    EXPECT_NE(error.hint.find("[[sink]]"), std::string::npos);
  }
}

TEST(Exports, AxesKeepTheirHandedness) {
  app::scene::Export e;
  e.up = app::scene::UpAxis::z;
  e.scale = 100;
  const app::exports::Axes axes(e);
  EXPECT_EQ(axes.scaled({1, 2, 3}), sim::Vec3d(100, -300, 200));
  EXPECT_EQ(axes.direction({1, 0, 0}).cross(axes.direction({0, 1, 0})), axes.direction({0, 0, 1}));
  sim::Mat3d a;
  a << 1, 2, 3, 4, 5, 6, 7, 8, 9;
  const sim::Vec3d v(0.3, -2, 5);
  EXPECT_EQ(axes.tensor(a) * axes.direction(v), axes.direction(a * v));
}

/// Frame 7 of 25 a second is at 7.000000000000001 frames, where USD shows the clip before.
TEST(Exports, EndsOfFramesAreWholeNumbers) {
  for (const double fps : {24.0, 24000 / 1001.0, 25.0, 30.0, 50.0, 60.0, 100.0}) {
    app::scene::Scene scene = scene_with("");
    scene.fps = fps;
    for (int frame = 0; frame < 3000; ++frame)
      ASSERT_EQ(app::exports::time_in_frames(scene, frame / fps), frame) << fps;
    EXPECT_NEAR(app::exports::time_in_frames(scene, 7.25 / fps), 7.25, 1e-12);
  }
}

TEST(Exports, FoldersAreCalledLikeTheExportOrItsFormat) {
  const app::scene::Scene scene =
      scene_with("[[export]]\nformat = \"vtp\"\n[[export]]\nname = \"fine\"\nformat = \"vtp\"\n");
  ASSERT_EQ(scene.exports.size(), 2u);
  EXPECT_EQ(app::scene::folder_of(scene.exports[0]), "vtp");
  EXPECT_EQ(app::scene::folder_of(scene.exports[1]), "fine");
  EXPECT_EQ(app::exports::series_name(scene.exports[1]), "fine.pvd");
  EXPECT_EQ(app::exports::file_name(scene.exports[1], 24), "0024.vtp");
}

TEST(Exports, MistakesInASceneAreLocated) {
  EXPECT_NE(error_of_export("[[export]]\nformat = \"vpt\"\n").find("did you mean \"vtp\"?"),
            std::string::npos);
  EXPECT_NE(error_of_export("[[export]]\nattributes = [\"speed\"]\n").find("\"kirchhoff\""),
            std::string::npos);
  EXPECT_NE(error_of_export("[[export]]\nbodies = [\"bal\"]\n").find("did you mean \"ball\"?"),
            std::string::npos);
  EXPECT_NE(error_of_export("[[export]]\nformat = \"csv\"\nsurface = true\n").find("use ply, vtp"),
            std::string::npos);
  EXPECT_NE(error_of_export("[[export]]\nformat = \"obj\"\n").find("add --surface"),
            std::string::npos);
  EXPECT_NE(error_of_export("[[export]]\nsurface = true\nsurface_cell = 0.0\n").find("0.2"),
            std::string::npos);
  const std::string twice = error_of_export("[[export]]\n[[export]]\n");
  EXPECT_NE(twice.find("exports/ply"), std::string::npos) << twice;
  const std::string emitters =
      "[[emitter]]\nname = \"a\"\nshape = { sphere = { radius = 0.1 } }\nrate = 1\nvelocity = [0, "
      "-1, 0]\n"
      "[[emitter]]\nname = \"b\"\nshape = { sphere = { radius = 0.1 } }\nrate = 1\nvelocity = [0, "
      "-1, 0]\n";
  EXPECT_EQ(error_of_export(emitters + "[[export]]\n"), "");
  const std::string age = error_of_export(emitters + "[[export]]\nattributes = [\"age\"]\n");
  EXPECT_NE(age.find("which of several emitters"), std::string::npos) << age;
}

TEST(Exports, AgeOfEmittedSnowIsTheTimeSinceItsBirth) {
  const app::scene::Scene scene = scene_with(
      "[[emitter]]\nname = \"hose\"\nshape = { sphere = { radius = 0.1 } }\nrate = 2\nstart = 0.5\n"
      "velocity = [0, -1, 0]\n");
  const app::exports::Origins origins(scene, {10});
  EXPECT_EQ(origins.body_of(9), 0);
  EXPECT_EQ(origins.body_of(10), 1);
  EXPECT_EQ(origins.birth_of(9), 0);
  const double h = scene.solver.cell_size, mass = 400 * h * h * h / 8;
  EXPECT_NEAR(origins.birth_of(10), 0.5 + 0.5 * mass / 2, 1e-12);
  EXPECT_NEAR(origins.birth_of(13), 0.5 + 3.5 * mass / 2, 1e-12);
}

/// Loose snow is less dense, so its particles weigh less and come more often.
TEST(Exports, AgeOfLooseEmittedSnowFollowsItsOwnPeriod) {
  const app::scene::Scene scene = scene_with(
      "[[emitter]]\nname = \"hose\"\nshape = { sphere = { radius = 0.1 } }\nrate = 2\nJ_P = 1.6\n"
      "velocity = [0, -1, 0]\n");
  const double h = scene.solver.cell_size, mass = 400 / 1.6 * h * h * h / 8;
  EXPECT_NEAR(app::exports::Origins(scene, {10}).birth_of(13), 3.5 * mass / 2, 1e-12);
}

/// Two balls so near each other that they share nodes.
TEST(Exports, AGridIsOfTheBodiesThatAreNamed) {
  app::scene::Scene scene = app::scene::read_scene_text(
      "[solver]\ntransfer = \"flip\"\n"
      "[[body]]\nname = \"left\"\nshape = { sphere = { radius = 0.1 } }\nvelocity = [1, 0, 0]\n"
      "[[body]]\nname = \"right\"\nshape = { sphere = { center = [0.2, 0, 0], radius = 0.1 } }\n"
      "velocity = [-1, 0, 0]\n"
      "[[export]]\nformat = \"vdb\"\n[[export]]\nformat = \"vti\"\nbodies = [\"left\"]\n",
      "scene");
  const app::setup::SeededScene seeded = app::setup::seed_scene(scene);
  const sim::Simulation simulation = app::setup::make_simulation(scene, seeded.particles, 1);
  const auto state = app::exports::read_state(
      scene.exports, app::exports::Origins(scene, seeded.body_end), scene.colliders, simulation);
  const sim::ParticleArrays& p = state->particles;
  const auto left = p.m.begin() + static_cast<std::ptrdiff_t>(seeded.body_end[0]);
  const sim::RasterizedNodes &all = state->nodes.at({}), &some = state->nodes.at({"left"});
  // Sums of single precision.
  EXPECT_NEAR(std::accumulate(all.mass.begin(), all.mass.end(), 0.0),
              std::accumulate(p.m.begin(), p.m.end(), 0.0), 1e-4);
  EXPECT_NEAR(std::accumulate(some.mass.begin(), some.mass.end(), 0.0),
              std::accumulate(p.m.begin(), left, 0.0), 1e-4);
  for (std::size_t n = 0; n < some.mass.size(); ++n)
    if (some.mass[n] > 0) {
      EXPECT_EQ(some.velocity[n].x(), 1);
    }
}

/// An emitter over a floor that is nearer than its snow is deep.
TEST(Exports, AgesThatTheStateDoesNotSayAreNotANumber) {
  const app::scene::Scene scene = scene_with(
      "[solver]\ncell_size = 0.05\n"
      "[[emitter]]\nname = \"hose\"\nshape = { box = { center = [1, 0.1, 0], size = [0.2, 0.2, "
      "0.2] } }\n"
      "rate = 16\nvelocity = [0, -0.5, 0]\n"
      "[[collider]]\nshape = { plane = {} }\n"
      "[[export]]\nformat = \"npz\"\nattributes = [\"age\"]\n"
      "[[export]]\nformat = \"csv\"\nattributes = [\"age\"]\nbodies = [\"ball\"]\n");
  const app::setup::SeededScene seeded = app::setup::seed_scene(scene);
  const app::exports::Origins origins(scene, seeded.body_end);
  sim::Simulation simulation = app::setup::make_simulation(scene, seeded.particles, 1);
  const app::exports::Carried carried;
  /// Ages that are numbers, and others.
  const auto count = [&](std::size_t k) {
    const app::scene::Export& e = scene.exports[k];
    const auto state = app::exports::read_state({&e, 1}, origins, scene.colliders, simulation);
    const app::exports::Table table = app::exports::make_table(scene, e, origins, carried, *state);
    const auto unknown = std::visit(
        [](const auto& ages) {
          return static_cast<std::size_t>(std::count_if(
              ages.begin(), ages.end(), [](auto a) { return std::isnan(static_cast<double>(a)); }));
        },
        table.find(app::scene::ExportAttribute::age)->numbers);
    EXPECT_EQ(unknown > 0, !app::exports::unknown_ages(e, *state).empty());
    return std::pair(table.rows - unknown, unknown);
  };
  simulation.advance_to(0.01);
  EXPECT_EQ(count(0).second, 0u);
  while (simulation.emitter_states().front().waited == 0 && simulation.time() < 1)
    simulation.advance_to(simulation.time() + 0.05);
  ASSERT_GT(simulation.emitter_states().front().waited, 0);
  EXPECT_EQ(count(1).second, 0u);
  EXPECT_EQ(count(0).first, seeded.particles.x.size());
  EXPECT_EQ(count(0).second, simulation.particle_count() - seeded.particles.x.size());
}

}  // namespace

/// Expected ranges and the numbers of healthy steps.

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "app/health/expected.h"
#include "app/scene/read.h"
#include "app/setup/seed_scene.h"

namespace neve::app {
namespace {

constexpr const char* coarse_cube = R"(
[solver]
cell_size = 0.1
[[body]]
name = "cube"
shape = { box = { center = [0, 0.2, 0], size = [0.3, 0.3, 0.3] } }
)";

// The sharp corners of a cube of three cells: the worst that the paper's estimate does.
TEST(ExpectedVolume, VolumesHaveRoomForEstimatesAtCornersOnlyIfEstimated) {
  const app::scene::Scene scene = app::scene::read_scene_text(coarse_cube, "cube.toml");
  sim::Simulation simulation =
      app::setup::make_simulation(scene, app::setup::seed_scene(scene).particles, 1);
  const sim::ParticleArrays state = simulation.particles();
  const app::scene::Range expected = app::health::Expected(scene, state, 1e-4).volume().range;
  const double share = state.m.front() / scene.materials[0].density;
  EXPECT_DOUBLE_EQ(expected.max, 8 * *std::max_element(state.m.begin(), state.m.end()) /
                                     scene.materials[0].density);
  const auto [least, most] = std::minmax_element(state.V0.begin(), state.V0.end());
  EXPECT_GT(*most, 2 * share) << "the corners are why there is room";
  EXPECT_LT(*most, expected.max);
  EXPECT_GT(*least, expected.min);
  const app::scene::Scene given =
      app::scene::read_scene_text(std::string(coarse_cube) + "volumes = \"given\"\n", "cube.toml");
  EXPECT_DOUBLE_EQ(app::health::Expected(given, state, 1e-4).volume().range.max,
                   3 * expected.max / 8);
}

/// Snow that flies in particles is as loose as it may be (a trial found it red). Snow that is
/// packed to a tenth of its volume is what should look wrong.
TEST(ExpectedPlasticVolume, SprayIsExpectedAndCrushedSnowIsNot) {
  const app::scene::Scene scene = app::scene::read_scene_text(coarse_cube, "cube.toml");
  sim::Simulation simulation =
      app::setup::make_simulation(scene, app::setup::seed_scene(scene).particles, 1);
  const app::scene::Range expected =
      app::health::Expected(scene, simulation.particles(), 1e-4).J_P().range;
  EXPECT_EQ(expected.max, scene.materials[0].max_J_P);
  EXPECT_GT(expected.min, 0.1);
}

}  // namespace
}  // namespace neve::app

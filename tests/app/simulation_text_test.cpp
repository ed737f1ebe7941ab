/// Parts of a scene on which its states depend.

#include <gtest/gtest.h>

#include "app/run/identity.h"
#include "app/scene/read.h"
#include "tests/cli/run_neve.h"

namespace neve::app {
namespace {

std::string text_with(const std::string& address, const std::string& value) {
  return run::simulation_text(
      scene::read_scene_text(test::tiny_scene, "scene.toml", "", {{address, value}}));
}

TEST(SimulationText, HasAllThatStatesDependOn) {
  const std::string plain = text_with("seed", "1");
  for (const auto& [address, value] :
       std::vector<std::pair<const char*, const char*>>{{"seed", "2"},
                                                        {"fps", "30"},
                                                        {"solver.gravity", "[0, -5, 0]"},
                                                        {"solver.transfer", "apic"},
                                                        {"material.snow.hardening", "3"},
                                                        {"body.ball.velocity", "[0, -1, 0]"},
                                                        {"collider.floor.friction", "0.9"}})
    EXPECT_NE(text_with(address, value), plain) << address;
  for (const auto& [address, value] : std::vector<std::pair<const char*, const char*>>{
           {"title", "Other"},
           {"frames", "9"},
           {"camera.fov", "20"},
           {"light.intensity", "2"},
           {"output.size", "[64, 36]"},
           {"view.particles.particles.color_by", "speed"},
           {"collider.floor.style", "wire"}})
    EXPECT_EQ(text_with(address, value), plain) << address;
}

}  // namespace
}  // namespace neve::app

/// Files of a diverged run are the same for any number of threads: where numbers are not finite,
/// sums, ranges, light and smoke have a defined answer.

#include <algorithm>

#include "app/support/errors.h"
#include "tests/cli/run_neve.h"

namespace neve::test {
namespace {

/// A random scene: fixed steps that are far too long, smoke, and a slice with an automatic range.
const char* const scene_that_explodes = R"(
frames = 1
fps = 28.014282071829005
[solver]
kernel = "quadratic"
advect = "pic"
separation_min = 1.0
separation_max = 7.675513545475623e-08
strain_limit = 630.0657523742566
collide_after_solve = true
push_out = true
on_divergence = "ignore"
cell_size = 0.05
time_step = "fixed"
dt = 2.0094042280914244e-05
[material.snow]
model = "corotated"
density = 42.476686625761445
youngs_modulus = 395020010602.5481
hardening = 0.9559322913238588
critical_stretch = 100.0
max_J_P = 16430.10751412055
max_hardening = 15451212101.882784
[[body]]
name = "rod"
shape = { cylinder = { center = [-0.27, 0.4, 0.02], radius = 0.0786, height = 0.109 } }
velocity = [5.67, -5.31, -5.5]
J_P = 1.5
volumes = "given"
[[body]]
name = "log"
shape = { cylinder = { center = [-0.03, 0.22, 0.14], radius = 0.18, height = 0.3 } }
velocity = [6.9, -7.2, -0.15]
[[collider]]
shape = { plane = { point = [0, -0.03, 0], normal = [-0.438, 0.589, 0.539] } }
contact = "slip"
velocity = [3.2, -3.7, 6]
[camera]
follow = "log"
[light]
[[view]]
name = "view0"
size = [36, 53]
smoke = { colormap = "coolwarm" }
slice = { scalar = "speed", colormap = "magma", range = "auto", scalar_colormap = "coolwarm" }
[output]
size = [86, 54]
background = "transparent"
)";

/// Every picture of a folder, by name.
std::map<std::string, std::string> pictures_in(const std::filesystem::path& folder) {
  std::map<std::string, std::string> pictures;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    if (entry.path().extension() == ".png")
      pictures[entry.path().filename().string()] = read_text(entry.path());
  return pictures;
}

TEST_F(Cli, PicturesOfADivergenceAreTheSameForAnyNumberOfThreads) {
  folder.write("scene.toml", scene_that_explodes);
  std::map<std::string, std::string> first;
  for (const char* threads : {"1", "2", "3"}) {
    const std::string out = std::string("out") + threads;
    const auto result = neve({"render", "scene.toml", "--out", out, "--threads", threads});
    EXPECT_EQ(result.exit_code, 5) << result.errors;
    const auto pictures = pictures_in(folder / out);
    EXPECT_TRUE(pictures.contains("diverged_view0.png"));
    EXPECT_TRUE(pictures.contains("diverged_culprit_slice.png"));
    if (first.empty()) first = pictures;
    for (const auto& [name, bytes] : first)
      EXPECT_TRUE(pictures.contains(name) && pictures.at(name) == bytes)
          << name << " differs with " << threads << " threads";
  }
  // No frame makes them again: the one before was drawn, or a view that no scene has was missed.
  for (const char* picture : {"out1/diverged_view0.png", "out1/diverged_culprit_slice.png"}) {
    const auto again = neve({"render", picture});
    EXPECT_EQ(again.exit_code, app::exit_invalid_scene) << again.errors;
    EXPECT_TRUE(contains(again.errors, "is a picture of a divergence")) << again.errors;
    EXPECT_TRUE(contains(neve({"info", picture}).output, "step        "));
  }
}

}  // namespace
}  // namespace neve::test

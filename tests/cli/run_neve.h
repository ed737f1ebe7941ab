#pragma once
/// Runs the real program on small scenes.

#include <gtest/gtest.h>

#include <map>
#include <string>
#include <vector>

#include "app/output/process.h"
#include "app/support/json.h"
#include "tests/support/temporary_folder.h"

namespace neve::test {

/// About 300 particles that fall on a floor for a sixth of a second; drawn in 160x90.
inline const char* const tiny_scene = R"(
title = "Tiny « névé »"
frames = 4
[solver]
cell_size = 0.04
[[body]]
name = "ball"
shape = { sphere = { center = [0, 0.12, 0], radius = 0.08 } }
velocity = [0, -2, 0]
[[collider]]
name = "floor"
shape = { plane = { point = [0, 0, 0], normal = [0, 1, 0] } }
[[view]]
name = "particles"
[output]
size = [160, 90]
)";

/// Steps far too long for snow as stiff as ice: explodes at once.
inline const char* const exploding_scene = R"(
frames = 8
[solver]
cell_size = 0.02
time_step = "fixed"
dt = 2e-3
[material.snow]
model = "corotated"
youngs_modulus = 5e7
[[body]]
shape = { sphere = { center = [0, 0.08, 0], radius = 0.08 } }
velocity = [0, -8, 0]
[[collider]]
shape = { plane = { point = [0, 0, 0], normal = [0, 1, 0] } }
[[view]]
name = "particles"
[output]
size = [160, 90]
)";

/// The same of the tiny scene, as a run of a sweep file.
inline const char* const exploding_run = R"([[run]]
label = "explodes"
"solver.time_step" = "fixed"
"solver.dt" = 2e-3
"material.snow.youngs_modulus" = 5e7
"material.snow.model" = "corotated"
"body.ball.velocity" = [0, -8, 0]
)";

/// A folder to run in, with the tiny scene as scene.toml.
class Cli : public testing::Test {
 protected:
  Cli() { folder.write("scene.toml", tiny_scene); }

  app::output::ProcessResult neve(const std::vector<std::string>& arguments) {
    return app::output::run_process(NEVE_BINARY, arguments, folder.path());
  }

  app::Json json_of(const std::string& file) {
    return app::parse_json(std::string_view(read_text(folder / file)));
  }

  /// Hashes of the frames of the run in a folder.
  std::map<int, std::string> hashes(const std::string& out) {
    std::map<int, std::string> all;
    const app::Json run = json_of(out + "/run.json");
    for (const app::Json& frame : run["frames"])
      all[frame["frame"].get<int>()] = frame["state_hash"].get<std::string>();
    return all;
  }

  bool exists(const std::string& file) { return std::filesystem::exists(folder / file); }

  TemporaryFolder folder;
};

inline bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

}  // namespace neve::test

/// Bodies from point files as a user meets them: rendered, checked, coarsened, resumed, refused.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <sstream>
#include <string>

#include "tests/cli/run_neve.h"

namespace neve::test {
namespace {

/// A block of 10x10x10 points 2 cm apart that falls at 1 m/s; eight in a cell of the scene.
/// @param mass  kg of a point; 3.2e-3 is snow of 400 kg/m3
/// @param distance  of neighbours, m
std::string block_csv(double mass, double distance = 0.02) {
  std::string text = "x,y,z,vx,vy,vz,mass,volume\n";
  for (int k = 0; k < 1000; ++k) {
    char row[128];
    std::snprintf(row, sizeof row, "%g,%g,%g,0,-1,0,%g,8e-6\n", distance * (k % 10),
                  distance * (k / 10 % 10), distance * (k / 100), mass);
    text += row;
  }
  return text;
}

constexpr const char* block_scene = R"(
frames = 2
[solver]
cell_size = 0.04
[[view]]
name = "particles"
[[body]]
name = "block"
shape = { points = { file = "points/block.csv", center = [0, 0.05, 0] } }
[[collider]]
name = "floor"
shape = { plane = { point = [0, 0, 0], normal = [0, 1, 0] } }
[output]
size = [160, 90]
)";

class PointFiles : public Cli {
 protected:
  PointFiles() {
    folder.write("scene.toml", block_scene);
    folder.write("points/block.csv", block_csv(3.2e-3));
  }

  app::output::ProcessResult render(const std::vector<std::string>& more = {}) {
    std::vector<std::string> words{"render", "scene.toml", "--out", "out"};
    words.insert(words.end(), more.begin(), more.end());
    return neve(words);
  }

  /// Address and text of the warnings.
  std::string warnings() {
    const auto result = neve({"check", "scene.toml", "--json"});
    EXPECT_EQ(result.exit_code, 0) << result.errors;
    std::string all;
    const app::Json json = app::parse_json(std::string_view(result.output));
    for (const app::Json& finding : json["findings"])
      if (finding["severity"] == "warning")
        all += finding["address"].get<std::string>() + ": " + finding["what"].get<std::string>() +
               "\n";
    return all;
  }
};

TEST_F(PointFiles, ParticlesHaveThePositionsVelocitiesAndMassesOfTheFile) {
  ASSERT_EQ(render({"--frames", "0-0"}).exit_code, 0);
  const app::Json frame = json_of("out/run.json")["frames"][0];
  EXPECT_EQ(frame["particles"], 1000);
  // Momenta are kept as numbers of 32 bits.
  EXPECT_NEAR(frame["momentum"][1].get<double>(), -3.2, 1e-5);
  EXPECT_NEAR(frame["max_speed"].get<double>(), 1, 1e-6);
  EXPECT_NEAR(frame["centre_of_mass"][0].get<double>(), 0.09, 1e-6);
  EXPECT_NEAR(frame["centre_of_mass"][1].get<double>(), 0.14, 1e-6);
}

TEST_F(PointFiles, CoarsenedPointsKeepTheirMass) {
  ASSERT_EQ(render({"--frames", "0-0", "--coarsen", "2"}).exit_code, 0);
  const app::Json frame = json_of("out/run.json")["frames"][0];
  EXPECT_EQ(frame["particles"], 125);
  EXPECT_NEAR(frame["momentum"][1].get<double>(), -3.2, 1e-5);
}

TEST_F(PointFiles, LimitsCountPointsAndIgnoreParticlesPerCell) {
  const auto refused = render({"--set", "limits.particles=999"});
  EXPECT_EQ(refused.exit_code, 8);
  EXPECT_TRUE(contains(refused.errors, "1000 particles")) << refused.errors;
  EXPECT_EQ(render({"--set", "limits.particles=1000", "--set", "body.block.particles_per_cell=500",
                    "--frames", "0-0"})
                .exit_code,
            0);
}

TEST_F(PointFiles, PointFilesAreToldApartByTheirBytes) {
  ASSERT_EQ(render({"--frames", "0-1"}).exit_code, 0);
  EXPECT_EQ(render({"--frames", "0-2", "--resume"}).exit_code, 0);
  const auto again = neve({"render", "out/particles/0001.png", "--out", "again"});
  EXPECT_EQ(again.exit_code, 0) << again.errors;
  folder.write("points/block.csv", block_csv(3.3e-3));
  const auto resumed = render({"--resume"});
  EXPECT_EQ(resumed.exit_code, 2) << resumed.errors;
  EXPECT_TRUE(contains(resumed.errors, "a different run")) << resumed.errors;
  const auto changed = neve({"render", "out/particles/0001.png", "--out", "again"});
  EXPECT_NE(changed.exit_code, 0);
  EXPECT_TRUE(contains(changed.errors, "block.csv")) << changed.errors;
}

TEST_F(PointFiles, APictureOfAMovedProjectFindsItsFiles) {
  namespace fs = std::filesystem;
  ASSERT_EQ(render().exit_code, 0);
  fs::create_directory(folder / "moved");
  for (const char* part : {"points", "out"}) fs::rename(folder / part, folder / "moved" / part);
  const auto again = neve({"render", "moved/out/particles/0002.png", "--out", "again"});
  ASSERT_EQ(again.exit_code, 0) << again.errors;
  EXPECT_EQ(json_of("again/run.json")["frames"].back()["state_hash"],
            json_of("moved/out/run.json")["frames"].back()["state_hash"]);
  // Its name alone does not make a file the one that the picture used.
  folder.write("moved/points/block.csv", block_csv(3.3e-3));
  const auto changed = neve({"render", "moved/out/particles/0002.png", "--out", "changed"});
  EXPECT_NE(changed.exit_code, 0);
  EXPECT_TRUE(contains(changed.errors, "block.csv")) << changed.errors;
  fs::rename(folder / "moved/points/block.csv", folder / "moved/other.csv");
  const auto lost = neve({"render", "moved/out/particles/0002.png", "--out", "lost"});
  EXPECT_EQ(lost.exit_code, 6);
  EXPECT_TRUE(contains(lost.errors, "put it back, or beside the picture")) << lost.errors;
  EXPECT_FALSE(exists("lost"));
}

TEST_F(PointFiles, MistakesAreToldWithFileAndLine) {
  folder.write("points/block.csv", "x,y,z,volume\n0,0,0,8e-6\n0,zero,0,8e-6\n");
  const auto render_result = render();
  EXPECT_EQ(render_result.exit_code, 3);
  EXPECT_TRUE(contains(render_result.errors, "points/block.csv:3: \"zero\" is not a number"))
      << render_result.errors;
  EXPECT_FALSE(exists("out"));
  folder.write("points/block.csv", "x,y,z\n0,0,0\n");
  const auto spacing = neve({"check", "scene.toml"});
  EXPECT_EQ(spacing.exit_code, 3);
  EXPECT_TRUE(contains(spacing.errors, "give spacing")) << spacing.errors;
}

TEST_F(PointFiles, PointFilesAreExaminedByTheirDistanceAndMass) {
  EXPECT_EQ(warnings(), "");
  folder.write("points/block.csv", block_csv(3.2));  // in grams
  EXPECT_TRUE(
      contains(warnings(), "body.block.shape.points: the points of block have a density of"))
      << warnings();
  std::string far = block_scene;
  far.replace(far.find("cell_size = 0.04"), 16, "cell_size = 0.02");
  folder.write("points/block.csv", block_csv(3.2e-3));
  folder.write("scene.toml", far);
  EXPECT_TRUE(contains(warnings(), "body.block.shape.points: the points of block are 1 in a cell"))
      << warnings();
  // The points are in centimetres; the masses and volumes of the file fit them.
  folder.write("points/block.csv", block_csv(3.2e-3, 2));
  folder.write("scene.toml", block_scene);
  EXPECT_TRUE(contains(warnings(), "shape.points: the points of block are too far apart"))
      << warnings();
}

/// The thinning to type is that of the file: --coarsen 2 multiplies it by eight.
TEST_F(PointFiles, AdviceOnThinningIsTheNumberToType) {
  const auto advice = [&](const std::vector<std::string>& more) {
    std::vector<std::string> words{"check", "scene.toml", "--set", "solver.cell_size=0.1"};
    words.insert(words.end(), more.begin(), more.end());
    return neve(words).output;
  };
  for (const std::vector<std::string>& more : {std::vector<std::string>{},
                                               {"--coarsen", "2"},
                                               {"--set", "body.block.shape.points.thinning=2"}})
    EXPECT_TRUE(contains(advice(more), " has 8, or thinning = 15.6")) << advice(more);
}

/// Points outside of the range of their material came to its end in their first step that yields.
TEST_F(PointFiles, PackingOfPointsOutsideTheRangeOfTheirMaterialIsSaid) {
  std::istringstream block(block_csv(3.2e-3));
  std::string packed, line;
  for (int k = 0; std::getline(block, line); ++k)
    packed += line + (k == 0 ? ",J_P\n" : k % 10 == 0 ? ",5\n" : ",2\n");
  folder.write("points/block.csv", packed);
  EXPECT_EQ(warnings(), "");
  folder.write("scene.toml", block_scene + std::string("[material.snow]\nmax_J_P = 4\n"));
  const std::string told = warnings();
  EXPECT_TRUE(
      contains(told, "100 of 1000 points have a J_P above 4, as large as 5: snow makes it 4"))
      << told;
}

/// The file has factors of thresholds that no material may have.
TEST_F(PointFiles, ThresholdsWithWhichSnowNeverYieldsAreSaid) {
  std::istringstream block(block_csv(3.2e-3));
  std::string varied, line;
  for (int k = 0; std::getline(block, line); ++k)
    varied += line + (k == 0 ? ",threshold\n" : k % 10 == 0 ? ",20\n" : ",2\n");
  folder.write("points/block.csv", varied);
  folder.write("scene.toml", block_scene + std::string("[material.snow]\n"
                                                       "critical_compression = 0.08\n"));
  EXPECT_TRUE(contains(warnings(),
                       "100 of 1000 points never yield in compression: their "
                       "threshold, up to 20, times critical_compression, 0.08"))
      << warnings();
}

TEST_F(PointFiles, SettingsThatTheFileTakesThePlaceOfAreSaid) {
  std::string text = block_scene;
  const std::string shape = "center = [0, 0.05, 0] } }\n";
  text.replace(text.find(shape), shape.size(),
               "center = [0, 0.05, 0], spacing = 0.01 } }\nparticles_per_cell = 4\n");
  folder.write("scene.toml", text);
  const std::string told = warnings();
  EXPECT_TRUE(contains(told,
                       "body.block.shape.points.spacing: spacing has no effect: the file has "
                       "the volume of each point"))
      << told;
  EXPECT_TRUE(contains(told, "body.block.particles_per_cell: particles_per_cell has no effect"))
      << told;
}

/// Velocities in the file take a block to a wall, or away from it.
TEST_F(PointFiles, FlightsKnowTheVelocitiesInTheFile) {
  std::string text = block_scene;
  text.replace(text.find("frames = 2"), 10, "frames = 6");
  text.replace(text.find("shape = { plane"), std::string::npos,
               "shape = { box = { center = [1.3, 0, 0], size = [0.2, 3, 3] } }\n");
  folder.write("scene.toml", text);
  const auto thrown = [&](const std::string& velocity) {
    std::string block = block_csv(3.2e-3);
    const std::string down = ",0,-1,0,";
    for (std::size_t at = 0; (at = block.find(down, at)) != std::string::npos;)
      block.replace(at, down.size(), velocity);
    folder.write("points/block.csv", block);
    return warnings();
  };
  EXPECT_EQ(thrown(",8,0,0,"), "");
  const std::string away = thrown(",-8,0,0,");
  EXPECT_TRUE(contains(away, "block meets nothing until the scene ends")) << away;
}

constexpr const char* moving_scene = R"(
frames = 6
[solver]
cell_size = 0.04
transfer = "mls"
[[view]]
name = "particles"
[[body]]
name = "ball"
shape = { sphere = { center = [0, 0.1, 0], radius = 0.08 } }
velocity = [1, -3, 0]
[[collider]]
name = "floor"
shape = { plane = { point = [0, 0, 0], normal = [0, 1, 0] } }
[output]
size = [160, 90]
)";

/// The scene that continues from a file of its third frame.
std::string continued(const std::string& file) {
  std::string text = moving_scene;
  const std::string before =
      "{ sphere = { center = [0, 0.1, 0], radius = 0.08 } }\n"
      "velocity = [1, -3, 0]";
  return text.replace(text.find(before), before.size(), "{ points = { file = \"" + file + "\" } }");
}

/// Attributes with which a state continues.
constexpr const char* state = "x,v,m,V0,J_P,F_E,C";

TEST_F(PointFiles, AnExportedStateContinuesAsIfNothingHadHappened) {
  folder.write("moving.toml", moving_scene);
  for (const char* format : {"ply", "csv"}) {
    const std::string out = std::string("all_") + format;
    ASSERT_EQ(neve({"export", "moving.toml", "--format", format, "--attributes", state, "--out",
                    out, "-q"})
                  .exit_code,
              0);
    const std::string files = out + "/" + format + "/";
    folder.write("continued.toml", continued(files + "0003." + format));
    const auto again = neve({"export", "continued.toml", "--format", format, "--attributes", state,
                             "--frames", "0-3", "--out", "again", "-q"});
    ASSERT_EQ(again.exit_code, 0) << again.errors;
    const std::string first =
        read_text(folder / ("again/" + std::string(format) + "/0000." + format));
    if (std::string(format) == "csv") {
      EXPECT_EQ(first, read_text(folder / (files + "0003.csv")));
    }
    EXPECT_GT(first.size(), 10000u);
  }
  // Three frames later both have moved alike; steps are not the same ones.
  const auto mean_height = [&](const std::string& file) {
    std::istringstream lines(read_text(folder / file));
    std::string line;
    std::getline(lines, line);
    double sum = 0, count = 0, x = 0, y = 0;
    while (std::getline(lines, line) && std::sscanf(line.c_str(), "%lf,%lf", &x, &y) == 2)
      sum += y, ++count;
    return sum / count;
  };
  EXPECT_NEAR(mean_height("again/csv/0003.csv"), mean_height("all_csv/csv/0006.csv"), 1e-4);
}

/// Bodies lay on their side, a hundred times as large.
TEST_F(PointFiles, AStateInOtherAxesAndUnitsContinuesAsItWas) {
  folder.write("moving.toml", moving_scene);
  struct Way {
    std::string out, format;
    std::vector<std::string> flags;
  };
  for (const auto& [out, format, flags] :
       {Way{"plain", "ply", {}}, Way{"turned", "ply", {"--up", "z"}},
        Way{"turned_text", "csv", {"--up", "z"}},
        Way{"scaled", "ply", {"--up", "z", "--scale", "100"}}}) {
    std::vector<std::string> words{"export",       "moving.toml", "--format", format,
                                   "--attributes", state,         "--frames", "3-3",
                                   "--out",        out,           "-q"};
    words.insert(words.end(), flags.begin(), flags.end());
    ASSERT_EQ(neve(words).exit_code, 0);
    folder.write(out + ".toml", continued(out + "/" + format + "/0003." + format));
    ASSERT_EQ(neve({"export", out + ".toml", "--format", "csv", "--attributes", state, "--frames",
                    "0-1", "--out", out + "_again", "-q"})
                  .exit_code,
              0);
  }
  for (const char* turned : {"turned_again/csv", "turned_text_again/csv"})
    for (const char* frame : {"0000.csv", "0001.csv"})
      EXPECT_EQ(read_text(folder / turned / frame), read_text(folder / "plain_again/csv" / frame));
  // A hundred times a number and a hundredth of it may differ in the last digit.
  const auto numbers = [&](const std::string& file) {
    std::string text = read_text(folder / file);
    text.erase(0, text.find('\n') + 1);
    std::ranges::replace(text, '\n', ',');
    std::vector<double> list;
    std::istringstream words(text);
    for (std::string word; std::getline(words, word, ',');) list.push_back(std::stod(word));
    return list;
  };
  const std::vector<double> plain = numbers("plain_again/csv/0000.csv"),
                            scaled = numbers("scaled_again/csv/0000.csv");
  ASSERT_EQ(plain.size(), scaled.size());
  ASSERT_GT(plain.size(), 1000u);
  for (std::size_t k = 0; k < plain.size(); ++k)
    EXPECT_NEAR(scaled[k], plain[k], 1e-6 * (1 + std::abs(plain[k]))) << k;
}

/// Its masses got the factors of `variation` a second time, and nobody could write the others.
TEST_F(PointFiles, VariedSnowContinuesAsItIs) {
  const std::string varied =
                        "[material.snow]\nvariation = { density = 0.2, youngs_modulus = 0.3, "
                        "thresholds = 0.3 }\n",
                    attributes = std::string(state) + ",stiffness,threshold";
  folder.write("moving.toml", moving_scene + varied);
  const auto exported = [&](const char* scene, const std::string& frame) {
    const auto done = neve({"export", scene, "--format", "csv", "--attributes", attributes,
                            "--frames", frame + "-" + frame, "--out", scene + frame, "-q"});
    EXPECT_EQ(done.exit_code, 0) << done.errors;
    return read_text(folder / (scene + frame + "/csv/000" + frame + ".csv"));
  };
  const std::string before = exported("moving.toml", "3");
  folder.write("of_export.toml", continued("moving.toml3/csv/0003.csv") + varied);
  EXPECT_TRUE(exported("of_export.toml", "0") == before);
  ASSERT_EQ(neve({"dump", "moving.toml", "--at", "0.125", "--out", "state.txt"}).exit_code, 0);
  folder.write("of_dump.toml", continued("state.txt") + varied);
  EXPECT_TRUE(exported("of_dump.toml", "0") == before);
  // Factors that the file does not have are drawn.
  folder.write("points/block.csv", block_csv(3.2e-3));
  folder.write("block.toml", block_scene + varied);
  const std::string block = exported("block.toml", "0");
  EXPECT_FALSE(contains(block, ",1,1\n"));
  EXPECT_TRUE(contains(block, ",0.0032"));
}

TEST_F(PointFiles, ADumpContinuesToTheBit) {
  folder.write("moving.toml", moving_scene);
  ASSERT_EQ(neve({"dump", "moving.toml", "--at", "0.125", "--out", "state.txt"}).exit_code, 0);
  folder.write("continued.toml", continued("state.txt"));
  const auto exported = [&](const char* scene, const std::string& frame) {
    const auto done = neve({"export", scene, "--format", "csv", "--attributes", state, "--frames",
                            frame + "-" + frame, "--out", "out", "--replace", "-q"});
    EXPECT_EQ(done.exit_code, 0) << done.errors;
    return read_text(folder / ("out/csv/000" + frame + ".csv"));
  };
  const std::string before = exported("moving.toml", "3");
  EXPECT_GT(before.size(), 10000u);
  EXPECT_TRUE(exported("continued.toml", "0") == before);
}

}  // namespace
}  // namespace neve::test

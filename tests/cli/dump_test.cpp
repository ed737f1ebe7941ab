/// neve dump: numbers inside a step, and that looking changes nothing.

#include <algorithm>
#include <cmath>
#include <cstring>
#include <set>
#include <sstream>

#include "app/dump/quantities.h"
#include "app/output/atomic_file.h"
#include "tests/cli/run_neve.h"

namespace neve::test {
namespace {

class Dump : public Cli {
 protected:
  app::Json json(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), {"dump", "scene.toml"});
    arguments.push_back("--json");
    const auto result = neve(arguments);
    EXPECT_EQ(result.exit_code, 0) << result.errors;
    return app::parse_json(std::string_view(result.output));
  }
};

const app::Json& quantity(const app::Json& dump, const std::string& name) {
  for (const app::Json& q : dump["quantities"])
    if (q["name"] == name) return q;
  throw std::logic_error("no quantity " + name);
}

TEST_F(Dump, AHealthyStepIsAsExpected) {
  // The ball is early in flight: gravity alone changes the velocities of nodes.
  const app::Json dump = json({"--at", "0.01s", "--stage", "grid_velocities", "--set",
                               "body.ball.shape.sphere.center=[0,0.5,0]"});
  EXPECT_GT(dump["nodes"].get<int>(), 50);
  for (const char* name : {"mass", "momentum", "v_old", "force", "v_free", "dv"}) {
    EXPECT_EQ(quantity(dump, name)["outside"], 0) << name << dump.dump(1);
    EXPECT_TRUE(quantity(dump, name).contains("expected")) << name;
  }
  EXPECT_NEAR(quantity(dump, "dv")["greatest"].get<double>(), 9.81 * dump["dt"].get<double>(),
              // Snow in flight is free of stress but for rounding in float.
              1e-4 * 9.81 * dump["dt"].get<double>() + 1e-6);
  // Density at the start is that of the material; jitter moves nodes inside by some tenths.
  const double full = 400 * std::pow(0.04, 3);
  EXPECT_GT(quantity(dump, "mass")["greatest"].get<double>(), 0.7 * full);
  EXPECT_LT(quantity(dump, "mass")["greatest"].get<double>(), 1.5 * full);
}

/// A ball that has just hit a ball: two light nodes beside the pressed snow were red.
TEST_F(Dump, OfNothingThereIsNoLeastValue) {
  folder.write("scene.toml", R"(frames = 4
[solver]
cell_size = 0.04
[[emitter]]
name = "later"
start = 0.1
rate = 1000
shape = { sphere = { center = [0, 0.5, 0], radius = 0.08 } }
)");
  const app::Json dump = json({"--at", "0"});
  EXPECT_TRUE(quantity(dump, "m")["least"].is_null()) << dump;
  EXPECT_TRUE(quantity(dump, "m")["greatest"].is_null());
}

TEST_F(Dump, LightNodesBesidePressedSnowAreAsExpected) {
  const auto result = neve({"dump", NEVE_SOURCE_DIR "/scenes/snowball_on_sphere.toml", "--coarsen",
                            "2", "--at", "0.084", "--stage", "grid_velocities", "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  const app::Json dump = app::parse_json(std::string_view(result.output));
  EXPECT_EQ(quantity(dump, "dv")["outside"], 0) << quantity(dump, "dv");
  EXPECT_GT(quantity(dump, "dv")["greatest"].get<double>(), 0.3) << "it hits hard";
}

/// The ball lies on the floor after half a second: the floor carries its weight, on the mean of
/// some steps to a fifth, because it still quivers.
TEST_F(Dump, TheForceOnTheFloorIsTheWeightOfTheSnow) {
  std::string times;
  for (int k = 0; k < 20; ++k) times += (k > 0 ? "," : "") + std::to_string(0.5 + 0.003 * k) + "s";
  const app::Json list = json({"--at", times, "--set", "frames=20"});
  double force = 0;
  ASSERT_EQ(list.size(), 20u);
  for (const app::Json& dump : list) {
    ASSERT_EQ(dump["forces"].size(), 1u);
    EXPECT_EQ(dump["forces"][0]["collider"], "floor");
    force += dump["forces"][0]["force"][1].get<double>() / 20;
  }
  const double weight = 400 * 4.0 / 3 * 3.14159 * std::pow(0.08, 3) * 9.81;
  EXPECT_NEAR(force, -weight, 0.2 * weight);
  const auto text = neve({"dump", "scene.toml", "--at", "0.5s", "--set", "frames=20"});
  EXPECT_TRUE(contains(text.output, "# snow on floor in the next step: force ")) << text.errors;
}

TEST_F(Dump, DumpShowsAStateThatTheRunPassesThrough) {
  ASSERT_EQ(neve({"render", "scene.toml", "--quiet"}).exit_code, 0);
  const app::Json run = json_of("out/scene/run.json");
  for (const int frame : {0, 2, 4}) {
    const auto& record = run["frames"][static_cast<std::size_t>(frame)];
    const app::Json dump = json({"--at", std::to_string(record["time"].get<double>()) + "s"});
    // to_string cuts after six digits, a little before the frame: one step earlier at most.
    if (dump["time"].get<double>() == record["time"].get<double>())
      EXPECT_EQ(dump["state_hash"], record["state_hash"]) << frame;
    else
      EXPECT_NEAR(dump["time"].get<double>(), record["time"].get<double>(), 2e-3);
  }
  // A sixth of a second to the last digit is the last frame.
  EXPECT_EQ(json({"--at", "0.16666666666666666"})["state_hash"], run["frames"][4]["state_hash"]);
}

TEST_F(Dump, StagesFollowEachOther) {
  const auto greatest = [&](const char* stage, const char* name) {
    return quantity(json({"--at", "0.05", "--stage", stage}), name)["greatest"].get<double>();
  };
  EXPECT_GT(greatest("elastic_forces", "force"), 0);
  EXPECT_GT(greatest("grid_collisions", "v_star"), 0);
  EXPECT_GT(greatest("deformation", "grad_v"), 0);
  EXPECT_GT(greatest("particle_velocities", "v"), 0);
  EXPECT_GT(greatest("particle_collisions", "v"), 0);
  EXPECT_GT(greatest("advection", "moved"), 0);
  EXPECT_GT(greatest("volumes", "V0"), 0);
}

TEST_F(Dump, ASkippedStageLeavesNothing) {
  const app::Json dump = json(
      {"--at", "0.05", "--stage", "elastic_forces", "--set", "solver.bypass=[\"elastic_forces\"]"});
  EXPECT_EQ(quantity(dump, "force")["greatest"], 0);
}

TEST_F(Dump, ProbesAParticleAndAPlace) {
  const app::Json dump = json({"--probe", "17", "--probe", "0,0.12,0"});
  ASSERT_EQ(dump["probes"].size(), 2u);
  EXPECT_EQ(dump["probes"][0]["id"]["value"], 17);
  EXPECT_EQ(dump["probes"][0]["v"]["value"][1], -2);
  EXPECT_FALSE(dump["probes"][0]["J_P"]["strange"]);
  const app::Json& x = dump["probes"][1]["x"]["value"];
  // Eight particles in a cell of 4 cm: one is within a cell.
  EXPECT_LT(std::hypot(x[0].get<double>(), x[1].get<double>() - 0.12, x[2].get<double>()), 0.04);
  const auto text = neve({"dump", "scene.toml", "--probe", "17"});
  EXPECT_TRUE(contains(text.output, "expected")) << text.output;
}

TEST_F(Dump, ATableHasOneLineForEach) {
  const auto result = neve({"dump", "scene.toml", "--field", "id", "--field", "v", "--quiet"});
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  std::istringstream lines(result.output);
  std::string line;
  std::size_t comments = 0, rows = 0;
  // The names come first, for numpy.genfromtxt(file, names=True).
  std::getline(lines, line);
  EXPECT_EQ(line, "id\tv_x\tv_y\tv_z");
  while (std::getline(lines, line)) {
    if (line.starts_with("#")) {
      ++comments;
    } else {
      EXPECT_EQ(line, std::to_string(rows) + "\t0\t-2\t0");
      ++rows;
    }
  }
  EXPECT_GT(comments, 3u);
  EXPECT_EQ(static_cast<int>(rows), json({})["particles"].get<int>());
}

TEST_F(Dump, TensorsHaveTheirRowsAsInExports) {
  const auto dumped =
      neve({"dump", "scene.toml", "--at", "0.05", "--field", "id", "--field", "F_E", "--quiet"});
  ASSERT_EQ(dumped.exit_code, 0) << dumped.errors;
  const auto exported = neve({"export", "scene.toml", "--at", "0.05", "--format", "csv",
                              "--attributes", "id,F_E", "--out", "e", "--quiet"});
  ASSERT_EQ(exported.exit_code, 0) << exported.errors;
  const auto bytes = app::output::read_file(folder / "e" / "csv" / "0000.csv");
  std::istringstream rows(dumped.output), others(std::string(bytes.begin(), bytes.end()));
  std::size_t compared = 0;
  for (std::string row, other; std::getline(rows, row);) {
    if (row.starts_with("#")) continue;
    ASSERT_TRUE(std::getline(others, other));
    std::ranges::replace(row, '\t', ',');
    EXPECT_TRUE(other.ends_with(row)) << row << " is not in " << other;
    ++compared;
  }
  EXPECT_GT(compared, 10u);
}

/// The offsets of a .vtp and the sizes in front of its blocks have to agree with each other.
TEST_F(Dump, VtkBlocksAreWhereTheHeaderSays) {
  ASSERT_EQ(neve({"dump", "scene.toml", "--stage", "grid_collisions", "--format", "vtk", "--out",
                  "nodes.vtp"})
                .exit_code,
            0);
  const auto bytes = app::output::read_file(folder / "nodes.vtp");
  const std::string text(bytes.begin(), bytes.end());
  const std::size_t data = text.find("encoding=\"raw\">\n_") + 17;
  std::size_t arrays = 0, next = 0, points = 0;
  std::sscanf(text.c_str() + text.find("NumberOfPoints=\"") + 16, "%zu", &points);
  EXPECT_GT(points, 50u);
  for (std::size_t at = text.find("<DataArray"); at < data; at = text.find("<DataArray", at + 1)) {
    std::size_t components = 0, offset = 0;
    std::sscanf(text.c_str() + text.find("NumberOfComponents=\"", at) + 20, "%zu", &components);
    std::sscanf(text.c_str() + text.find("offset=\"", at) + 8, "%zu", &offset);
    EXPECT_EQ(offset, next);
    std::uint64_t size = 0;
    ASSERT_LE(data + offset + sizeof size, text.size());
    std::memcpy(&size, text.data() + data + offset, sizeof size);
    EXPECT_EQ(size, 8 * components * points);
    next = offset + sizeof size + size;
    ++arrays;
  }
  EXPECT_GE(arrays, 9u);
  EXPECT_TRUE(text.substr(data + next).starts_with("\n</AppendedData>"));
}

TEST_F(Dump, WritesSeveralTimesIntoNumberedFiles) {
  ASSERT_EQ(
      neve({"dump", "scene.toml", "--at", "0,0.05", "--format", "vtk", "--out", "s.vtp"}).exit_code,
      0);
  ASSERT_EQ(
      neve({"dump", "scene.toml", "--at", "0.05", "--format", "vtk", "--out", "one.vtp"}).exit_code,
      0);
  EXPECT_TRUE(exists("s_0000.vtp"));
  EXPECT_EQ(read_text(folder / "s_0001.vtp"), read_text(folder / "one.vtp"));
  EXPECT_EQ(neve({"dump", "scene.toml", "--at", "0.1,0.05"}).exit_code, 2);
  const auto piped = neve({"dump", "scene.toml", "--at", "0,0.05", "--format", "vtk"});
  EXPECT_EQ(piped.exit_code, 2);
  EXPECT_TRUE(contains(piped.errors, "one time in a file")) << piped.errors;
}

TEST_F(Dump, MistakesAreExplained) {
  const auto wrong = [&](std::vector<std::string> arguments, const std::string& hint) {
    arguments.insert(arguments.begin(), {"dump", "scene.toml"});
    const auto result = neve(arguments);
    EXPECT_EQ(result.exit_code, 2) << hint;
    EXPECT_TRUE(contains(result.errors, hint)) << result.errors;
  };
  wrong({"--stage", "elastic_force"}, "did you mean elastic_forces?");
  wrong({"--at", "soon"}, "as in --at 0.25s");
  wrong({"--at", "-1"}, "as in --at 0.25s");
  wrong({"--probe", "1,2"}, "--probe 0,0.5,0");
  wrong({"--probe", "1000000"}, "expected 0 to");
  wrong({"--probe", "3", "--stage", "rasterize"}, "nodes have no id");
  wrong({"--field", "vv"}, "expected id, x, v");
  wrong({"--format", "csv"}, "table or vtk");
}

TEST_F(Dump, AFieldWithoutItsFlagIsKnown) {
  const auto wrong = [&](std::vector<std::string> arguments, const std::string& hint) {
    arguments.insert(arguments.begin(), "dump");
    const auto result = neve(arguments);
    EXPECT_EQ(result.exit_code, 2) << hint;
    EXPECT_TRUE(contains(result.errors, hint)) << result.errors;
  };
  const std::string right = "--field names the quantity: --field J_P --histogram";
  for (const char* field : {"J_P", "j_p", "J_PP", "Jp"}) {
    wrong({"scene.toml", "--histogram", field}, right);
    wrong({"scene.toml", std::string("--histogram=") + field}, right);
    wrong({"--histogram", field}, right);
    wrong({"scene.toml", field}, "J_P is a quantity: --field J_P");
  }
  wrong({"scene.toml", "--histogram", "humidity"}, ", as in --field J_P --histogram");
  wrong({"J_P"}, "J_P is a quantity: --field J_P");
  wrong({"scene.toml", "--stage", "J_P"}, "J_P is a quantity: --field J_P");
  wrong({"scene.toml", "--probe", "v_star"}, "v_star is a quantity: --field v_star");
  wrong({"scene.toml", "--format", "mass"}, "mass is a quantity: --field mass");
  wrong({"scene.toml", "--quantity", "mass"}, "did you mean --field?");
  wrong({"scene.toml", "other"}, "neve dump --help lists its arguments");
}

TEST_F(Dump, ATimeAfterTheEndIsRefusedByAllThatTakeOne) {
  const auto refused = [&](const std::vector<std::string>& arguments, const std::string& message) {
    const auto result = neve(arguments);
    EXPECT_EQ(result.exit_code, 2) << arguments[0];
    EXPECT_TRUE(contains(result.errors, message)) << result.errors;
  };
  const std::string scene = "--at: 0.5 s is after the end of the scene, 0.167 s (frame 4); ";
  const std::string longer = scene + "expected an earlier time; --set frames=12 makes it longer";
  refused({"dump", "scene.toml", "--at", "0,0.5"}, longer);
  refused({"export", "scene.toml", "--format", "ply", "--at", "0.5"}, longer);
  refused({"strip", "scene.toml", "--at", "0.1,0.5"}, longer);
  EXPECT_EQ(neve({"dump", "scene.toml", "--at", "0.167"}).exit_code, 0);  // as the end is written
  refused({"dump", "scene.toml", "--at", "2"}, "; frame 2 is at 0.08333333333333333 s");
  EXPECT_EQ(neve({"dump", "scene.toml", "--at", "0.5", "--set", "frames=12"}).exit_code, 0);
  // A run that was made longer than its scene ends at its own end.
  const std::vector<std::string> render{"render", "scene.toml", "--out", "a", "--no-movie"};
  ASSERT_EQ(neve(render).exit_code, 0);
  const std::string run = "--at: 0.25 s is after the end of the run, 0.167 s (frame 4); ";
  const std::string more = run + "expected an earlier time; neve render a --resume --frames 0-6";
  const std::vector<std::string> dump{"dump", "a", "--at", "0.25"};
  refused(dump, more);
  folder.write("none.json", "[]");
  refused({"view", "a", "--at", "0.25", "--replay", "none.json"}, more);
  ASSERT_EQ(neve({"render", "a", "--resume", "--frames", "0-6", "--no-movie"}).exit_code, 0);
  const auto seen = neve(dump);
  EXPECT_EQ(seen.exit_code, 0) << seen.errors;
  EXPECT_TRUE(contains(seen.errors, "continues from the checkpoint")) << seen.errors;
}

TEST_F(Dump, EveryQuantityOfEveryStageIsKnownByName) {
  std::set<std::string> listed;
  const auto add = [&](const app::Json& dump) {
    for (const app::Json& q : dump["quantities"]) listed.insert(q["name"].get<std::string>());
  };
  add(json({}));
  for (const char* stage : sim::stage_names)
    add(json({"--stage", stage, "--set", "solver.beta=1"}));
  const std::vector<std::string>& names = app::dump::quantity_names();
  EXPECT_EQ(listed, std::set<std::string>(names.begin(), names.end()));
}

TEST_F(Dump, ABrokenStateIsShownToo) {
  folder.write("explode.toml", exploding_scene);
  const auto result = neve({"dump", "explode.toml", "--at", "0.3", "--json"});
  EXPECT_EQ(result.exit_code, 5) << result.errors;
  EXPECT_TRUE(contains(result.errors, "this is its last state")) << result.errors;
  EXPECT_TRUE(app::parse_json(std::string_view(result.output)).contains("quantities"));
}

TEST_F(Dump, ARunIsDumpedFromTheMomentsThatItKeeps) {
  ASSERT_EQ(neve({"render", "scene.toml", "--no-movie", "--keep-states", "--out", "a"}).exit_code,
            0);
  const std::string third = hashes("a")[3];
  const auto dump = [&](const std::string& origin, const std::string& at) {
    const auto result = neve({"dump", origin, "--at", at, "--json"});
    EXPECT_EQ(result.exit_code, 0) << result.errors;
    app::Json json = app::parse_json(std::string_view(result.output));
    return std::pair(result.errors, json);
  };
  const auto [said, at_frame] = dump("a", "0.125");
  EXPECT_TRUE(contains(said, "continues from the checkpoint of frame 3")) << said;
  EXPECT_EQ(at_frame["state_hash"], third);
  // Between two frames the steps are those of the run; a picture is of the same run.
  auto [unsaid, fresh] = dump("scene.toml", "0.14");
  EXPECT_FALSE(contains(unsaid, "continues from")) << unsaid;
  for (const char* origin : {"a", "a/particles/0002.png"}) {
    app::Json other = dump(origin, "0.14").second;
    for (app::Json* json : {&fresh, &other}) json->erase("scene");
    EXPECT_EQ(other, fresh) << origin;
  }
  const auto set = neve({"dump", "a", "--set", "seed=2"});
  EXPECT_EQ(set.exit_code, 2);
  EXPECT_TRUE(contains(set.errors, "a run has the scene it was made from")) << set.errors;
}

/// The values at the end of a frame were those of the step before.
TEST_F(Dump, TheNextStepHasTheValuesThatCurvesGiveIt) {
  folder.write("scene.toml", std::string(tiny_scene) + R"(
[[curve]]
parameter = "solver.dt"
interpolation = "step"
keyframes = [{ time = 0, value = 1e-3 }, { time = 0.125, value = 5e-4 }]
)");
  const auto dump = [&](const std::string& at, std::vector<std::string> words) {
    words.insert(words.begin(), {"--at", at, "--set", "solver.time_step=fixed"});
    return json(words);
  };
  EXPECT_NEAR(dump("0.1", {})["dt"], 1e-3, 1e-6);
  EXPECT_NEAR(dump("0.125", {})["dt"], 5e-4, 1e-6);
  EXPECT_NEAR(dump("0.125", {"--stage", "grid_velocities"})["dt"], 5e-4, 1e-6);
}

TEST_F(Dump, HistogramsCountAllNodesOrParticles) {
  const app::Json dump = json({"--at", "0.05s", "--histogram"});
  ASSERT_FALSE(dump["histograms"].empty());
  for (const app::Json& histogram : dump["histograms"]) {
    std::size_t count = histogram["zeros"].get<std::size_t>();
    for (const app::Json& bin : histogram["counts"]) count += bin.get<std::size_t>();
    EXPECT_EQ(count, dump["particles"].get<std::size_t>()) << histogram;
    EXPECT_EQ(histogram["edges"].size(), histogram["counts"].size() + 1);
    EXPECT_NE(histogram["name"], "id");
  }
  const auto text = neve({"dump", "scene.toml", "--at", "0.05s", "--histogram", "--field", "J_P"});
  EXPECT_TRUE(contains(text.output, "J_P: 5 % below")) << text.output;
  EXPECT_TRUE(contains(text.output, "####")) << text.output;
  EXPECT_EQ(neve({"dump", "scene.toml", "--histogram", "--probe", "3"}).exit_code, 2);
  EXPECT_EQ(
      neve({"dump", "scene.toml", "--histogram", "--format", "vtk", "--out", "f.vtp"}).exit_code,
      2);
}

}  // namespace
}  // namespace neve::test

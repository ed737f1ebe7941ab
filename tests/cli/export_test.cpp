/// neve export: every format holds the state to the bit, all times are of one simulation.

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <numbers>
#include <numeric>
#include <sstream>

#include "app/output/atomic_file.h"
#include "app/output/folder_lock.h"
#include "tests/cli/run_neve.h"
#include "tests/support/child.h"
#include "tests/support/needs.h"
#include "tests/support/python.h"

namespace neve::test {
namespace {

constexpr const char* all_attributes =
    "id,x,v,m,V0,density,J_E,J_P,F_E,stress,kirchhoff,C,material,body,radius,age";

/// Two bodies of two materials, a spinning one with APIC so that C is not zero, and a post that
/// moves.
constexpr const char* pair_scene = R"(
frames = 6
[solver]
cell_size = 0.04
transfer = "apic"
[material.snow]
[material.ice]
youngs_modulus = 3e5
[[body]]
name = "ball"
shape = { sphere = { center = [0, 0.12, 0.3], radius = 0.08 } }
velocity = [0, -2, 0]
angular_velocity = [0, 20, 0]
[[body]]
name = "cube"
material = "ice"
shape = { box = { center = [0.2, 0.15, 0.3], size = [0.12, 0.12, 0.12] } }
[[collider]]
name = "floor"
shape = { plane = { point = [0, 0, 0], normal = [0, 1, 0] } }
[[collider]]
name = "2-post"
shape = { cylinder = { center = [0.1, 0.1, 0], radius = 0.02, height = 0.2 } }
velocity = [0.1, 0, 0]
[output]
size = [160, 90]
)";

class Export : public Cli {
 protected:
  Export() { folder.write("pair.toml", pair_scene); }

  app::Json json_of_export(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "export");
    arguments.push_back("--json");
    const auto result = neve(arguments);
    EXPECT_EQ(result.exit_code, 0) << result.errors;
    return app::parse_json(std::string_view(result.output));
  }

  void expect_refused(std::vector<std::string> arguments, int code, const std::string& part) {
    arguments.insert(arguments.begin(), "export");
    const auto result = neve(arguments);
    EXPECT_EQ(result.exit_code, code) << result.errors;
    EXPECT_TRUE(contains(result.errors, part)) << result.errors;
  }
};

TEST_F(Export, EveryFormatHoldsTheStateToTheBit) {
  const auto python = python_with("numpy");
  if (!python) SKIP_OR_FAIL("no Python with numpy; install python3-numpy");
  const std::string formats = "ply,vtp,vti,bgeo,usda,npz,csv";
  json_of_export({"pair.toml", "--format", formats, "--attributes", all_attributes, "--out", "all",
                  "--frames", "3-5"});
  json_of_export({"pair.toml", "--format", formats, "--attributes", all_attributes, "--out",
                  "turned", "--frames", "5-5", "--up", "z", "--scale", "100"});
  // A frame, as text that is the same number.
  const auto dump = neve({"dump", "pair.toml", "--at", "0.20833333333333334", "--format", "vtk",
                          "--out", "state.vtp"});
  ASSERT_EQ(dump.exit_code, 0) << dump.errors;
  const auto same =
      run_script(*python, "check_formats.py", {"all", "5", "state.vtp"}, folder.path());
  EXPECT_EQ(same.output, "same\n") << same.errors;
  const auto turned = run_script(*python, "check_formats.py",
                                 {"turned", "5", "state.vtp", "z", "100"}, folder.path());
  EXPECT_EQ(turned.output, "same\n") << turned.errors;
  const auto units = [&](const std::string& out) {
    std::string text;
    const app::Json list = json_of(out + "/export.json");
    for (const app::Json& item : list["exports"])
      for (const app::Json& column : item["attributes"])
        if (const std::string name = column["name"];
            item["format"] == "npz" && (name == "x" || name == "v" || name == "m"))
          text += column["unit"].get<std::string>() + " ";
    return text;
  };
  EXPECT_EQ(units("all"), "m m/s kg ");
  EXPECT_EQ(units("turned"), "0.01 m 0.01 m/s kg ") << "masses are not scaled";
}

/// The cube is a smaller piece than the smallest, and so it is spray.
TEST_F(Export, ASurfaceIsTheSameClosedMeshInEveryFormat) {
  const auto python = python_with("numpy");
  if (!python) SKIP_OR_FAIL("no Python with numpy; install python3-numpy");
  const std::string attributes = "id,v,m,density,J_P,F_E,body,material";
  json_of_export({"pair.toml", "--format", "npz", "--frames", "1-1", "--attributes", attributes,
                  "--out", "particles"});
  const std::vector<std::string> surface{
      "pair.toml", "--surface", "--smallest-piece", "240",     "--format", "ply,vtp,usda,obj",
      "--frames",  "1-1",       "--attributes",     attributes};
  std::vector<std::string> plain = surface, turned = surface;
  plain.insert(plain.end(), {"--out", "plain", "--surface-smoothing", "0.8"});
  turned.insert(turned.end(), {"--out", "turned", "--up", "z", "--scale", "100", "--surface-cell",
                               "0.4", "--surface-smoothing", "0.8"});
  const app::Json list = json_of_export(plain)["exports"];
  ASSERT_EQ(list.size(), 4u);
  EXPECT_EQ(list[0]["surface"]["smallest_piece"], 240);
  EXPECT_NEAR(list[0]["surface"]["smoothing"].get<double>(), 0.8 * 0.02, 1e-12);
  const auto check = [&](std::vector<std::string> arguments) {
    const auto same = run_script(*python, "check_surface.py", arguments, folder.path());
    EXPECT_EQ(same.output, "same\n") << same.errors;
  };
  check({"plain", "1", "particles/npz/0001.npz"});
  json_of_export(turned);
  check({"turned", "1", "particles/npz/0001.npz", "z", "100"});
  EXPECT_EQ(neve({"verify", "plain"}).exit_code, 0);
}

TEST_F(Export, ASceneAsksForASurface) {
  folder.write("both.toml", std::string(tiny_scene) +
                                "[[export]]\nname = \"mesh\"\nformat = \"ply\"\nsurface = true\n"
                                "surface_cell = 0.8\nevery = 4\n");
  ASSERT_EQ(neve({"render", "both.toml", "--quiet"}).exit_code, 0);
  const app::Json list = json_of("out/both/run.json")["exports"];
  ASSERT_EQ(list[0]["files"].size(), 2u);
  json_of_export({"scene.toml", "--format", "ply", "--surface", "--surface-cell", "0.8", "--out",
                  "alone", "--frames", "4-4"});
  EXPECT_EQ(app::output::read_file(folder / "out/both/exports/mesh/0004.ply"),
            app::output::read_file(folder / "alone/ply/0004.ply"));
}

TEST_F(Export, MemoryOfASurfaceIsPartOfThePlan) {
  const auto planned = [&](const std::string& more) {
    folder.write("planned.toml", pair_scene + more);
    const auto result = neve({"render", "planned.toml", "--dry-run", "--json"});
    EXPECT_EQ(result.exit_code, 0) << result.errors;
    const app::Json json = app::parse_json(std::string_view(result.output));
    return std::pair(json["memory_bytes"].get<double>(), json["particles"].get<double>());
  };
  const std::string points = "[[export]]\nformat = \"ply\"\n",
                    mesh = points + "surface = true\nsurface_cell = ";
  const auto [without, particles] = planned(points);
  const double coarse = planned(mesh + "0.5\n").first - without,
               fine = planned(mesh + "0.25\n").first - without;
  EXPECT_GT(coarse, 400 * particles) << "less than was measured for snow at rest";
  EXPECT_NEAR(fine / coarse, 8, 0.01);
  // 0.2 is the finest: what the surface alone makes too much is refused before anything runs.
  const std::string most = std::to_string(static_cast<std::uint64_t>(without + coarse));
  folder.write("planned.toml", pair_scene + mesh + "0.2\n");
  const auto refused = neve({"render", "planned.toml", "--max-memory", most});
  EXPECT_EQ(refused.exit_code, 8) << refused.errors;
  EXPECT_FALSE(exists("out/planned/particles"));
}

TEST_F(Export, SurfacesOfNothingAndOfOneParticleAreEmptyMeshes) {
  folder.write("one.csv", "x,y,z\n0,0.5,0\n");
  folder.write("one.toml",
               "frames = 0\n[[body]]\nname = \"dot\"\n"
               "shape = { points = { file = \"one.csv\", spacing = 0.01 } }\n");
  json_of_export({"one.toml", "--format", "ply,vtp,usda,obj", "--surface", "--out", "one"});
  const std::string ply = read_text(folder / "one/ply/0000.ply");
  EXPECT_TRUE(contains(ply, "element vertex 1\n") && contains(ply, "element face 0\n")) << ply;
  EXPECT_TRUE(contains(ply, "comment the last 1 vertices are spray"));
}

TEST_F(Export, FramesAreThoseOfTheRun) {
  ASSERT_EQ(neve({"render", "scene.toml", "--quiet"}).exit_code, 0);
  const app::Json run = json_of("out/scene/run.json");
  const app::Json all = json_of_export({"scene.toml", "--format", "npz", "--out", "all"});
  const app::Json& files = all["exports"][0]["files"];
  ASSERT_EQ(files.size(), 5u);
  for (std::size_t k = 0; k < files.size(); ++k)
    EXPECT_EQ(files[k]["state_hash"], run["frames"][k]["state_hash"]) << k;
  // Frames that begin later, the folder of the run with its checkpoint, and its picture give the
  // same bytes.
  json_of_export({"scene.toml", "--format", "npz", "--out", "late", "--frames", "4-4"});
  json_of_export({"out/scene", "--format", "npz", "--frames", "4-4", "--out", "of_run"});
  json_of_export({"out/scene/particles/0004.png", "--format", "npz", "--out", "of_picture"});
  const auto bytes = app::output::read_file(folder / "all/npz/0004.npz");
  for (const char* other : {"late", "of_run", "of_picture"})
    EXPECT_EQ(app::output::read_file(folder / other / "npz" / "0004.npz"), bytes) << other;
}

TEST_F(Export, ARunContinuesFromItsCheckpoint) {
  ASSERT_EQ(neve({"render", "scene.toml", "--quiet", "--checkpoint-every", "3", "--frames", "0-3",
                  "--no-keep-states"})
                .exit_code,
            0);
  const auto late =
      neve({"export", "out/scene", "--format", "csv", "--frames", "3-4", "--out", "late"});
  EXPECT_EQ(late.exit_code, 0) << late.errors;
  EXPECT_TRUE(contains(late.errors, "continues from the checkpoint of frame 3")) << late.errors;
  // An export takes what is kept on its way to later frames, too; the scene alone gives the same.
  const auto early =
      neve({"export", "out/scene", "--format", "csv", "--frames", "1-4", "--out", "early"});
  EXPECT_TRUE(contains(early.errors, "continues from the checkpoint of frame 3")) << early.errors;
  ASSERT_EQ(neve({"export", "scene.toml", "--format", "csv", "--frames", "1-4", "--out", "fresh"})
                .exit_code,
            0);
  for (const char* frame : {"0003.csv", "0004.csv"})
    EXPECT_EQ(read_text(folder / "late/csv" / frame), read_text(folder / "fresh/csv" / frame));
  for (const char* frame : {"0001.csv", "0002.csv", "0003.csv", "0004.csv"})
    EXPECT_EQ(read_text(folder / "early/csv" / frame), read_text(folder / "fresh/csv" / frame));
}

TEST_F(Export, FilesThatAreMissingEmptyOrDamagedAreNamed) {
  ASSERT_EQ(neve({"render", "scene.toml", "--out", "out", "--quiet", "--no-movie"}).exit_code, 0);
  json_of_export({"out", "--format", "csv,vtp"});
  json_of_export({"out", "--format", "ply", "--out", "elsewhere", "--frames", "2-3"});
  const auto verified = [&](const std::string& place) { return neve({"verify", place}); };
  for (const char* place : {"out", "out/exports", "elsewhere"})
    EXPECT_EQ(verified(place).exit_code, 0) << verified(place).output;
  const auto expect_flaw = [&](const std::string& file, const std::string& flaw) {
    for (const char* place : {"out", "out/exports"}) {
      const auto result = verified(place);
      EXPECT_EQ(result.exit_code, 9) << result.output;
      EXPECT_TRUE(contains(result.output, "out/exports/" + file + " " + flaw)) << result.output;
    }
  };
  const std::string csv = read_text(folder / "out/exports/csv/0002.csv");
  folder.write("out/exports/csv/0002.csv", "");
  expect_flaw("csv/0002.csv", "is empty");
  folder.write("out/exports/csv/0002.csv", csv + "1");
  expect_flaw("csv/0002.csv", "is not the file");
  std::filesystem::remove(folder / "out/exports/csv/0002.csv");
  expect_flaw("csv/0002.csv", "is missing");
  folder.write("out/exports/csv/0002.csv", csv);
  EXPECT_EQ(verified("out").exit_code, 0);
  std::filesystem::remove(folder / "out/exports/vtp.pvd");
  expect_flaw("vtp.pvd", "is missing");
  std::string list = read_text(folder / "elsewhere/export.json");
  list.replace(list.find("\"fps\": 24"), 9, "\"fps\": 25");
  folder.write("elsewhere/export.json", list);
  EXPECT_EQ(verified("elsewhere").exit_code, 9);
  folder.write("elsewhere/export.json", "{}");
  EXPECT_EQ(verified("elsewhere").exit_code, 9);
}

TEST_F(Export, OneWritesToAFolderAtATime) {
  const pid_t first = start_program({NEVE_BINARY, "render", folder / "scene.toml", "--out",
                                     folder / "out", "--frames", "5000", "--quiet", "--no-movie"});
  ASSERT_TRUE(wait_for_file(folder / "out/particles/0002.png"));
  const std::string holder = "is in use by neve render, process " + std::to_string(first);
  expect_refused({"out", "--format", "csv", "--frames", "0-1"}, 6, holder);
  expect_refused({"scene.toml", "--format", "csv", "--frames", "0-1", "--out", "out"}, 6, holder);
  EXPECT_FALSE(exists("out/exports"));
  const auto elsewhere =
      neve({"export", "out", "--format", "csv", "--frames", "0-1", "--out", "elsewhere"});
  EXPECT_EQ(elsewhere.exit_code, 0) << elsewhere.errors;
  ::kill(first, SIGKILL);
  EXPECT_EQ(wait_for(first), 128 + SIGKILL);
  EXPECT_EQ(neve({"export", "out", "--format", "csv", "--frames", "0-1"}).exit_code, 0);
}

/// Both write to exports/export.json: the later one dropped what the earlier had listed.
TEST_F(Export, OneWritesToTheExportsOfARunAtATimeByEitherName) {
  ASSERT_EQ(neve({"render", "scene.toml", "--out", "out", "--no-movie"}).exit_code, 0);
  const app::output::FolderLock lock(folder / "out", "a test");
  for (const std::string name : {"out/exports", "out/exports/", "./out/../out/exports"})
    expect_refused({"out", "--format", "csv", "--frames", "0-1", "--out", name}, 6,
                   "out: is in use by a test");
  EXPECT_FALSE(exists("out/exports"));
}

TEST_F(Export, AnExportThatWasInterruptedIsNoCompleteRun) {
  ASSERT_EQ(neve({"render", "scene.toml", "--out", "out", "--no-movie"}).exit_code, 0);
  const std::filesystem::path printed = folder / "printed";
  const pid_t child =
      start_program({"/bin/sh", "-c",
                     "cd " + folder.path().string() +
                         "; exec " NEVE_BINARY
                         " export out --format csv --frames 0-5000 --json --quiet >printed"});
  ASSERT_TRUE(wait_for_file(folder / "out/exports/csv/0002.csv"));
  ::kill(child, SIGINT);
  EXPECT_EQ(wait_for(child), 130);
  // The answer and the error are one document.
  const app::Json answer = app::parse_json(std::string_view(read_text(printed)));
  EXPECT_EQ(answer["exit_code"], 130);
  EXPECT_EQ(answer["is_whole"], false);
  EXPECT_TRUE(contains(answer["error"], "interrupted; wrote ")) << answer;
  const auto verified = neve({"verify", "out"});
  EXPECT_EQ(verified.exit_code, 9);
  EXPECT_TRUE(contains(verified.output,
                       "out/exports/export.json says that neve export was interrupted\n"
                       "repeat the neve export that was interrupted"))
      << verified.output;
}

TEST_F(Export, TimesInsideAFrameAreThoseOfDump) {
  const app::Json list = json_of_export(
      {"scene.toml", "--format", "csv", "--at", "0.01,0.05,0.1s,0.125", "--out", "times"});
  const auto dump =
      neve({"dump", "scene.toml", "--at", "0.01,0.05,0.1s,0.125", "--json", "--field", "x"});
  ASSERT_EQ(dump.exit_code, 0) << dump.errors;
  const app::Json moments = app::parse_json(std::string_view(dump.output));
  ASSERT_EQ(moments.size(), 4u);
  for (std::size_t k = 0; k < moments.size(); ++k) {
    const app::Json& file = list["exports"][0]["files"][k];
    EXPECT_EQ(file["state_hash"], moments[k]["state_hash"]);
    EXPECT_EQ(file["time"], moments[k]["time"]);
    EXPECT_EQ(file["number"], k);
    EXPECT_TRUE(exists("times/" + file["file"].get<std::string>()));
  }
}

TEST_F(Export, BodiesAreWrittenByName) {
  const app::Json all = json_of_export({"pair.toml", "--format", "csv", "--frames", "0-0",
                                        "--attributes", "id,body", "--out", "all"});
  json_of_export({"pair.toml", "--format", "csv", "--frames", "0-0", "--attributes", "body",
                  "--body", "cube", "--out", "cube"});
  EXPECT_TRUE(read_text(folder / "all/csv/0000.csv").starts_with("x,y,z,id,body\n"));
  const std::string cube = read_text(folder / "cube/csv/0000.csv");
  const auto lines = std::count(cube.begin(), cube.end(), '\n');
  EXPECT_GT(lines, 100);
  std::size_t found = 0;
  for (std::size_t at = cube.find(",1\n"); at != std::string::npos; at = cube.find(",1\n", at + 1))
    ++found;
  EXPECT_EQ(found + 1, static_cast<std::size_t>(lines));
}

/// A ball, points of a PLY, and every third point of a CSV.
constexpr const char* carried_scene = R"(
frames = 4
[solver]
cell_size = 0.04
[[body]]
name = "ball"
shape = { sphere = { center = [0, 0.5, 0.3], radius = 0.06 } }
[[body]]
name = "painted"
shape = { points = { file = "points.ply", spacing = 0.02 } }
[[body]]
name = "table"
shape = { points = { file = "points.csv", spacing = 0.02, thinning = 3 } }
[[collider]]
shape = { plane = { point = [0, 0, 0], normal = [0, 1, 0] } }
[[export]]
format = "npz"
attributes = ["id", "x", "body"]
carried = ["temperature", "weight", "brush", "mark"]
[output]
size = [160, 90]
)";

TEST_F(Export, ColumnsOfPointFilesComeOutAsTheyWentIn) {
  const auto python = python_with("numpy");
  if (!python) SKIP_OR_FAIL("no Python with numpy; install python3-numpy");
  ASSERT_EQ(run_script(*python, "check_carried.py", {"write"}, folder.path()).exit_code, 0);
  folder.write("carried.toml", carried_scene);
  json_of_export({"carried.toml", "--format", "ply,vtp,csv,npz,usda,bgeo", "--attributes",
                  "id,temperature,x,body,weight,brush,mark", "--out", "all", "--frames", "4-4"});
  const auto same = run_script(*python, "check_carried.py", {"check", "all", "4"}, folder.path());
  EXPECT_EQ(same.output, "same\n") << same.errors;
  // A render exports the same columns in a worker.
  ASSERT_EQ(neve({"render", "carried.toml", "--no-movie"}).exit_code, 0);
  EXPECT_EQ(read_text(folder / "out/carried/exports/npz/0000.npz").size(),
            read_text(folder / "out/carried/exports/npz/0004.npz").size());
}

TEST_F(Export, ColumnsThatNoFileHasAreRefusedWithTheNearest) {
  folder.write("points.csv", "x,y,z,weight,density\n0,0.1,0,1,2\n");
  folder.write("points.ply",
               "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\n"
               "property float z\nproperty float temperature\nend_header\n0 0.1 0 -3\n");
  const std::string old = R"(carried = ["temperature", "weight", "brush", "mark"])";
  const auto scene_with = [&](const std::string& carried) {
    std::string text = carried_scene;
    return text.replace(text.find(old), old.size(), carried);
  };
  folder.write("plain.toml", scene_with(""));
  expect_refused({"plain.toml", "--format", "npz", "--attributes", "id,temprature"}, 2,
                 "there is no attribute \"temprature\", and no point file has such a column; did "
                 "you mean temperature?");
  expect_refused({"pair.toml", "--format", "npz", "--attributes", "id,desnity"}, 2,
                 "did you mean density?");
  expect_refused({"pair.toml", "--format", "npz", "--attributes", "id,a b"}, 2, "--attributes");
  const auto located = [&](const std::string& carried) {
    folder.write("located.toml", scene_with(carried));
    const auto result = neve({"check", "located.toml"});
    EXPECT_EQ(result.exit_code, 3) << carried;
    return result.errors;
  };
  EXPECT_TRUE(contains(located("carried = [\"brush\"]"), "located.toml:19:"));
  EXPECT_TRUE(contains(located("carried = [\"density\"]"), "is an attribute of neve itself"));
  EXPECT_TRUE(contains(located("carried = [\"weight\", \"weight\"]"), "named twice"));
}

/// They had the shapes of the start.
TEST_F(Export, AStageHasTheShapesThatAForkGivesCollidersAlsoAfterAResume) {
  folder.write("post.toml", std::string(tiny_scene) +
                                "[[export]]\nformat = \"usda\"\n[[collider]]\nname = \"post\"\n"
                                "shape = { sphere = { center = [0.5, 0.1, 0], radius = 0.1 } }\n");
  const auto render = [&](std::vector<std::string> words) {
    words.insert(words.end(), {"--no-movie", "--quiet"});
    words.insert(words.begin(), "render");
    const auto made = neve(words);
    EXPECT_EQ(made.exit_code, 0) << made.errors;
  };
  render({"post.toml", "--frames", "0-2", "--out", "a"});
  for (const char* out : {"whole", "parts"})
    render({"a", "--from", "0.05s", "--set", "collider.post.shape.sphere.radius=0.03125",
            "--frames", out[0] == 'w' ? "2-3" : "2", "--out", out});
  render({"parts", "--resume", "--frames", "2-3"});
  const std::string stage = read_text(folder / "whole/exports/usda.usda");
  EXPECT_TRUE(contains(stage, "0.03125")) << stage;
  EXPECT_EQ(stage, read_text(folder / "parts/exports/usda.usda"));
}

/// The places of these colliders follow from no time of the scene.
TEST_F(Export, TheStageOfCollidersThatWaitIsTheSameAfterAResume) {
  folder.write("waits.toml",
               std::string(tiny_scene) +
                   "[[export]]\nformat = \"usda\"\n[[collider]]\nvelocity = [1, 0, 0]\n"
                   "shape = { box = { center = [0.5, 0.1, 0], size = [0.1, 0.1, 0.1] } }\n");
  const auto render = [&](const std::string& out, const std::string& frames, const char* more) {
    const auto made = neve({"render", "waits.toml", "--set", "solver.bypass=[\"colliders\"]",
                            "--frames", frames, "--out", out, "--no-movie", "--quiet", more});
    EXPECT_EQ(made.exit_code, 0) << made.errors;
  };
  render("whole", "0-3", "--no-keep-states");
  render("parts", "0-1", "--no-keep-states");
  render("parts", "0-3", "--resume");
  EXPECT_EQ(read_text(folder / "whole/exports/usda.usda"),
            read_text(folder / "parts/exports/usda.usda"));
}

TEST_F(Export, TheNextExportReplacesTheOneOfItsNameAndKeepsOthers) {
  json_of_export({"scene.toml", "--format", "vtp,usda", "--out", "x"});
  folder.write("x/vtp/mine.txt", "kept");
  json_of_export({"scene.toml", "--format", "vtp", "--frames", "0-1", "--out", "x", "--replace"});
  for (const char* there : {"x/vtp/0001.vtp", "x/vtp/mine.txt", "x/usda.usda", "x/usda/0000.usda"})
    EXPECT_TRUE(exists(there)) << there;
  EXPECT_FALSE(exists("x/vtp/0002.vtp"));
  const app::Json list = json_of("x/export.json");
  EXPECT_EQ(list["exports"].size(), 2u);
  EXPECT_TRUE(list["files"].contains("usda/0004.usda"));
  EXPECT_EQ(neve({"verify", "x"}).exit_code, 0);
  // The scene has changed since, which nothing else would tell.
  const auto changed = neve({"export", "scene.toml", "--format", "ply", "--frames", "0-2", "--out",
                             "x", "--set", "material.snow.hardening=3"});
  EXPECT_EQ(changed.exit_code, 0) << changed.errors;
  EXPECT_TRUE(contains(changed.errors, "shows another state than this export")) << changed.errors;
  // Another scene has nothing to do with them.
  json_of_export({"pair.toml", "--format", "ply", "--frames", "0", "--out", "x", "--replace"});
  for (const char* gone : {"x/vtp/0001.vtp", "x/usda.usda", "x/usda/manifest.usda"})
    EXPECT_FALSE(exists(gone)) << gone;
  EXPECT_TRUE(exists("x/vtp/mine.txt"));
}

/// Hours of simulation were gone after the frames of another export, with exit code 0.
TEST_F(Export, NoExportIsReplacedWithoutAWord) {
  const std::vector<std::string> first{"scene.toml", "--format", "npz,usda", "--frames",
                                       "1-2",        "--out",    "x"};
  json_of_export(first);
  const std::string list = read_text(folder / "x/export.json");
  const auto refused = [&](std::vector<std::string> words, const std::string& part) {
    words.insert(words.end(), {"--out", "x"});
    expect_refused(words, app::exit_usage, part);
    words.insert(words.begin(), "export");
    const auto result = neve(words);
    EXPECT_TRUE(contains(result.errors, "add --replace, or choose another folder with --out"))
        << result.errors;
    EXPECT_EQ(read_text(folder / "x/export.json"), list);
    EXPECT_TRUE(exists("x/npz/0001.npz") && exists("x/usda/0001.usda")) << part;
  };
  refused({"pair.toml", "--format", "ply", "--frames", "4"},
          "x has exports of another scene, scene.toml; it would replace 6 files, from "
          "npz/0001.npz to usda/manifest.usda");
  refused({"scene.toml", "--format", "npz", "--frames", "2-3"},
          "x has this export at other frames or times; it would replace npz/0001.npz");
  refused({"scene.toml", "--format", "npz", "--at", "0.1"}, "at other frames or times");
  refused({"scene.toml", "--format", "usda", "--frames", "1-2", "--up", "z"},
          "the export usda with other attributes, bodies, units or axes");
  refused({"scene.toml", "--format", "npz", "--frames", "1-2", "--set", "seed=9"},
          "another simulation of the scene");
  refused({"scene.toml", "--format", "npz", "--frames", "1-2", "--body", "ball"},
          "the export npz with other attributes, bodies, units or axes");
  // Files that are made again, more frames of them, and another path to the scene lose nothing.
  json_of_export(first);
  EXPECT_EQ(read_text(folder / "x/export.json"), list);
  json_of_export(
      {(folder / "scene.toml").string(), "--format", "npz,usda", "--frames", "1-2", "--out", "x"});
  json_of_export(first);
  EXPECT_EQ(read_text(folder / "x/export.json"), list);
  json_of_export({"scene.toml", "--format", "npz", "--frames", "0-2", "--out", "x"});
  EXPECT_TRUE(exists("x/npz/0000.npz") && exists("x/usda/0001.usda"));
  // Files that their owner has changed or removed do not go, so nothing is lost.
  std::filesystem::remove_all(folder / "x/npz");
  std::filesystem::remove_all(folder / "x/usda");
  std::filesystem::remove(folder / "x/usda.usda");
  json_of_export({"pair.toml", "--format", "ply", "--frames", "0", "--out", "x"});
}

/// They were overwritten without a word, and so were the exports of a run by those of its format.
TEST_F(Export, FilesAndListsThatItHasNotMadeAreNotReplacedInSilence) {
  const std::vector<std::string> words{"scene.toml", "--format", "csv", "--frames", "0-1", "--out"};
  const auto into = [&](const std::string& out, std::vector<std::string> more = {}) {
    more.insert(more.begin(), out);
    more.insert(more.begin(), words.begin(), words.end());
    return more;
  };
  folder.write("a/csv/0000.csv", "mine");
  expect_refused(into("a"), app::exit_usage,
                 "a has files that no neve export there has made; it would replace csv/0000.csv");
  EXPECT_EQ(read_text(folder / "a/csv/0000.csv"), "mine");
  json_of_export(into("a", {"--replace"}));
  EXPECT_NE(read_text(folder / "a/csv/0000.csv"), "mine");
  const std::string list = read_text(folder / "a/export.json");
  for (const std::string& text : {list.substr(0, list.size() / 2), std::string("{}")}) {
    folder.write("a/export.json", text);
    expect_refused(into("a", {"--set", "seed=3"}), app::exit_usage,
                   "a has an export.json that neve cannot read as a list of exports");
    EXPECT_EQ(read_text(folder / "a/export.json"), text);
  }
  // One that was killed has listed its files before it made them.
  folder.write("a/export.json", list);
  app::Json begun = json_of("a/export.json");
  begun["begun"] = {"csv/0000.csv", "csv/0001.csv"};
  begun["files"] = app::Json::object();
  begun["exports"] = app::Json::array();
  begun["is_whole"] = false;
  folder.write("a/export.json", begun.dump());
  json_of_export(into("a"));
  EXPECT_EQ(read_text(folder / "a/export.json"), list);
  // Files of the cut-off export join no sequence of another simulation, and need a word to go.
  begun["begun"] = {"csv/0000.csv", "csv/0001.csv", "csv/0002.csv", "csv/0003.csv"};
  folder.write("a/export.json", begun.dump());
  folder.write("a/csv/0003.csv", "of the export that was cut off");
  const std::string why = "it would replace csv/0003.csv";
  expect_refused(into("a"), app::exit_usage, why);
  expect_refused(
      {"scene.toml", "--format", "csv", "--out", "a", "--frames", "0-3", "--set", "seed=3"},
      app::exit_usage, "this export of another simulation of the scene");
  json_of_export({"scene.toml", "--format", "ply", "--frames", "0", "--out", "a"});
  expect_refused(into("a"), app::exit_usage, why);
  json_of_export(into("a", {"--replace"}));
  EXPECT_FALSE(exists("a/csv/0003.csv"));
  EXPECT_TRUE(exists("a/ply/0000.ply"));
  EXPECT_FALSE(json_of("a/export.json").contains("begun"));
}

/// Moments are numbered from 0, whatever they are.
TEST_F(Export, OtherMomentsAreNotTheSameExport) {
  json_of_export({"scene.toml", "--format", "npz", "--at", "0.01,0.02", "--out", "m"});
  json_of_export({"scene.toml", "--format", "npz", "--at", "0.01,0.02", "--out", "m"});
  expect_refused({"scene.toml", "--format", "npz", "--at", "0.03,0.04", "--out", "m"},
                 app::exit_usage, "m has this export at other frames or times");
  expect_refused({"scene.toml", "--format", "npz", "--frames", "0-1", "--out", "m"},
                 app::exit_usage, "m has this export at other frames or times");
  json_of_export({"scene.toml", "--format", "npz", "--at", "0.01,0.02,0.03", "--out", "m"});
  EXPECT_TRUE(exists("m/npz/0002.npz"));
}

/// The list may be forged: it removes nothing outside its folder.
TEST_F(Export, AForgedListRemovesNothingElse) {
  folder.write("precious.txt", "kept");
  folder.write("x/export.json", R"({"exports": [{"format": "ply", "series": "../precious.txt",
      "files": [{"file": "../precious.txt"}, {"file": ")" +
                                    (folder / "precious.txt").string() + R"("}, {"file": 7}]}]})");
  json_of_export({"scene.toml", "--format", "ply", "--frames", "0-0", "--out", "x", "--replace"});
  EXPECT_TRUE(exists("precious.txt"));
}

TEST_F(Export, MistakesAreExplained) {
  expect_refused({"scene.toml"}, 2, "--format");
  expect_refused({"scene.toml", "--format", "ply,quux"}, 2, "expected ply, vtp, vti, vdb");
  expect_refused({"scene.toml", "--format", "ply,stl"}, 2, "ply or obj with --surface");
  expect_refused({"scene.toml", "--format", "ply", "--attributes", "id,JP"}, 2,
                 "did you mean J_P?");
  expect_refused({"scene.toml", "--format", "ply", "--body", "bal"}, 2, "did you mean \"ball\"?");
  expect_refused({"scene.toml", "--format", "ply", "--at", "0.1", "--frames", "0-1"}, 2,
                 "cannot be combined");
  expect_refused({"scene.toml", "--format", "ply", "--up", "x"}, 2, "expected y, z");
  expect_refused({"scene.toml", "--format", "ply", "--scale", "0"}, 2, "--scale 100");
  expect_refused({"scene.toml", "--format", "ply,npz", "--surface"}, 2,
                 "--surface: a file of format npz cannot hold a surface; use ply");
  expect_refused({"scene.toml", "--format", "obj"}, 2, "--format: an obj file holds a surface");
  for (const char* cell : {"0", "-1", "nan", "1e-9"})
    expect_refused({"scene.toml", "--format", "ply", "--surface", "--surface-cell", cell}, 2,
                   "expected 0.2 <= value <= 4");
  expect_refused({"scene.toml", "--format", "ply", "--surface-cell", "1"}, 2, "give --surface too");
  expect_refused({"scene.toml", "--format", "ply", "--surface", "--smallest-piece", "0"}, 2,
                 "--smallest-piece");
  expect_refused({"out/none", "--format", "ply"}, 3, "out/none");
  folder.write("empty/run.json", "{}");
  expect_refused({"empty", "--format", "ply"}, 3, "not a run.json");
  expect_refused({"scene.toml", "--format", "ply", "--out", "/proc/none"}, 6, "/proc/none");
  folder.write("file", "no folder");
  expect_refused({"scene.toml", "--format", "ply", "--out", "file"}, 6, "file");
  expect_refused({"scene.toml", "--format", "ply", "--set", "limits.particles=10"}, 8,
                 "limits.particles");
}

TEST_F(Export, ADivergedRunKeepsTheFilesBeforeIt) {
  folder.write("explode.toml", exploding_scene);
  const auto result = neve({"export", "explode.toml", "--format", "ply", "--out", "x"});
  EXPECT_EQ(result.exit_code, 5) << result.errors;
  EXPECT_TRUE(exists("x/ply/0000.ply"));
  EXPECT_EQ(json_of("x/export.json")["is_whole"], false);
}

TEST_F(Export, AFullDiskIsReportedAndLeavesNoHalfFile) {
  const auto result = app::output::run_process(
      "/bin/sh", {"-c", "ulimit -f 8; exec " NEVE_BINARY " export scene.toml --format ply --out x"},
      folder.path());
  EXPECT_EQ(result.exit_code, 6) << result.errors;
  EXPECT_TRUE(contains(result.errors, "0000.ply")) << result.errors;
  EXPECT_EQ(file_count(folder / "x/ply"), 0u);
}

constexpr const char* exporting = R"(
[[export]]
format = "npz"
every = 2
attributes = ["id", "v"]
[[export]]
name = "for_paraview"
format = "vtp"
bodies = ["ball"]
)";

TEST_F(Export, ARunWritesTheExportsOfItsScene) {
  folder.write("both.toml", std::string(tiny_scene) + exporting);
  ASSERT_EQ(neve({"render", "both.toml", "--quiet"}).exit_code, 0);
  const app::Json list = json_of("out/both/run.json")["exports"];
  ASSERT_EQ(list.size(), 2u);
  EXPECT_EQ(list[0]["files"].size(), 3u);
  EXPECT_EQ(list[1]["files"].size(), 5u);
  for (const app::Json& e : list)
    for (const app::Json& file : e["files"])
      EXPECT_TRUE(exists("out/both/" + file["file"].get<std::string>())) << file;
  EXPECT_TRUE(exists("out/both/exports/for_paraview.pvd"));
  json_of_export({"scene.toml", "--format", "npz", "--attributes", "id,v", "--out", "alone"});
  EXPECT_EQ(app::output::read_file(folder / "out/both/exports/npz/0004.npz"),
            app::output::read_file(folder / "alone/npz/0004.npz"));
  // A picture is drawn again without them; another run in their place removes them.
  ASSERT_EQ(neve({"render", "out/both/particles/0002.png", "--quiet"}).exit_code, 0);
  EXPECT_FALSE(exists("out/0002-again/exports"));
  std::filesystem::rename(folder / "scene.toml", folder / "both.toml");
  ASSERT_EQ(neve({"render", "both.toml", "--quiet", "--replace", "--set", "seed=2"}).exit_code, 0);
  EXPECT_FALSE(exists("out/both/exports/npz/0004.npz"));
  EXPECT_FALSE(exists("out/both/exports/for_paraview.pvd"));
}

TEST_F(Export, AResumedRunListsAllItsExports) {
  folder.write("both.toml", std::string(tiny_scene) + exporting);
  ASSERT_EQ(neve({"render", "both.toml", "--quiet", "--out", "whole"}).exit_code, 0);
  ASSERT_EQ(neve({"render", "both.toml", "--quiet", "--frames", "0-2", "--out", "parts",
                  "--checkpoint-every", "2"})
                .exit_code,
            0);
  ASSERT_EQ(neve({"render", "both.toml", "--quiet", "--resume", "--out", "parts",
                  "--checkpoint-every", "2"})
                .exit_code,
            0);
  EXPECT_EQ(json_of("parts/run.json")["exports"], json_of("whole/run.json")["exports"]);
  EXPECT_EQ(read_text(folder / "parts/exports/for_paraview.pvd"),
            read_text(folder / "whole/exports/for_paraview.pvd"));
}

/// A ball that flies along x at 2 m/s, with a parameter that changes and a camera that follows it.
constexpr const char* followed_scene = R"(
frames = 3
first_frame = 10
[solver]
cell_size = 0.08
gravity = [0, 0, 0]
[[body]]
name = "ball"
shape = { sphere = { center = [0, 0.3, 0], radius = 0.12 } }
velocity = [2, 0, 0]
[[curve]]
parameter = "material.snow.hardening"
keyframes = [{ time = 0, value = 10 }, { time = 0.1, value = 12 }]
[camera]
follow = "ball"
eye = [1, 0, 1.5]
target = [0, 0, 0]
[output]
size = [160, 90]
)";
constexpr const char* series = R"(
[[export]]
format = "usda"
[[export]]
format = "vtp"
)";

/// The first number after each text that a file has in its order.
std::vector<double> numbers_after(const std::string& text, const std::string& start) {
  std::vector<double> numbers;
  for (std::size_t at = text.find(start); at != std::string::npos; at = text.find(start, at + 1))
    numbers.push_back(std::stod(text.substr(at + start.size())));
  return numbers;
}

TEST_F(Export, ASceneWithCurvesIsExportedAndTheStagesCameraFollowsAsPicturesDo) {
  folder.write("followed.toml", followed_scene);
  json_of_export({"followed.toml", "--format", "csv,usda", "--out", "made"});
  EXPECT_TRUE(exists("made/csv/0013.csv"));
  const std::string text = read_text(folder / "made/usda.usda");
  const std::string view = text.substr(text.find("def Camera"));
  const std::size_t places = view.find("xformOp:translate.timeSamples");
  ASSERT_NE(places, std::string::npos) << view;
  for (int k = 0; k <= 3; ++k) {
    const std::string time = std::to_string(10 + k) + ": (";
    const std::size_t at = view.find(time, places);
    ASSERT_NE(at, std::string::npos);
    // The centre of the jittered ball is a part of its spacing beside the origin.
    EXPECT_NEAR(std::stod(view.substr(at + time.size())), 1 + 2 * k / 24.0, 0.02) << k;
  }
}

/// One of them follows, the scene's does not.
TEST_F(Export, AStageHasTheCamerasOfViewsToo) {
  const std::string scene =
      std::string(followed_scene).substr(0, std::string(followed_scene).find("[camera]"));
  const std::string views =
      "[[view]]\nname = \"close\"\nsize = [90, 90]\ncamera = { follow = \"ball\", eye = [1, 0, "
      "1.5], "
      "target = [0, 0, 0] }\n[[view]]\nname = \"side\"\ncamera = { eye = [3, 0, 0], target = [0, "
      "0.3, "
      "0], fov = 20 }\n";
  const auto stage_of = [&](const std::string& text, const char* out) {
    folder.write("views.toml", text + views);
    json_of_export({"views.toml", "--format", "usda", "--out", out});
    return read_text(folder / out / "usda.usda");
  };
  const auto camera = [](const std::string& stage, const std::string& name) {
    const std::size_t at = stage.find("def Camera \"" + name + "\"");
    return at == std::string::npos ? std::string()
                                   : stage.substr(at, stage.find("        }\n", at) - at);
  };
  const auto is_of_close = [](const std::string& prim) {
    return contains(prim, "horizontalAperture = 24\n") && contains(prim, "translate.timeSamples");
  };
  // The first view is the camera of the stage where the scene has views alone.
  const std::string without = stage_of(scene, "without");
  EXPECT_TRUE(is_of_close(camera(without, "camera"))) << without;
  EXPECT_TRUE(contains(camera(without, "side"), "translate = (3, 0, 0)"))
      << camera(without, "side");
  EXPECT_EQ(camera(without, "close"), "");
  const std::string with =
      stage_of(scene + "[camera]\neye = [0, 1, 2]\ntarget = [0, 0, 0]\n", "with");
  EXPECT_TRUE(contains(camera(with, "camera"), "translate = (0, 1, 2)")) << camera(with, "camera");
  EXPECT_TRUE(is_of_close(camera(with, "close"))) << camera(with, "close");
  EXPECT_TRUE(contains(camera(with, "side"), "translate = (3, 0, 0)"));
}

/// The samples of a property, by their times; one at -1 where it has no samples.
std::map<double, std::vector<double>> samples_of(const std::string& prim,
                                                 const std::string& property) {
  std::size_t at = prim.find(property);
  if (at == std::string::npos) return {};
  at += property.size();
  const bool is_fixed = !prim.substr(at).starts_with(".timeSamples");
  std::string list = prim.substr(at, prim.find(is_fixed ? "\n" : "}", at) - at);
  std::ranges::replace_if(
      list, [](char c) { return std::strchr("(),=\n", c) != nullptr; }, ' ');
  std::map<double, std::vector<double>> samples;
  double time = -1;
  std::istringstream words(list);
  for (std::string word; words >> word;)
    if (word.ends_with(':'))
      time = std::stod(word);
    else if (word.find_first_not_of("0123456789.e+-") == std::string::npos)
      samples[time].push_back(std::stod(word));
  return samples;
}

/// A blade that turns once between two files, and by a quarter between two frames.
constexpr const char* turning_scene = R"(
frames = 8
[solver]
cell_size = 0.08
[[body]]
name = "ball"
shape = { sphere = { center = [0, 0.3, 0], radius = 0.12 } }
[[collider]]
name = "blade"
shape = { box = { center = [0.5, 0.2, 0], size = [0.3, 0.3, 0.3] } }
angular_velocity = [0, 0, 38]
[[collider]]
name = "floor"
shape = { plane = {} }
[camera]
eye = [0.3, 0.3, 0.8]
target = [0, 0.2, 0]
turntable = 0.25
[[export]]
format = "usda"
every = 4
[output]
size = [160, 90]
)";

/// USD interpolates between samples: what has two samples half a turn apart shrinks to nothing
/// there as a matrix, and as a quaternion it turns the wrong way.
TEST_F(Export, WhatAStageTurnsHasItsSizeAndItsPlaceBetweenFiles) {
  folder.write("turning.toml", turning_scene);
  ASSERT_EQ(neve({"render", "turning.toml", "--out", "run", "--quiet", "--no-movie"}).exit_code, 0);
  const std::string text = read_text(folder / "run/exports/usda.usda");
  const std::string view = text.substr(text.find("def Camera"));
  const std::string blade = text.substr(text.find("def Mesh \"blade\""));
  for (const std::string& prim : {blade, view}) {
    const auto turns = samples_of(prim, "quatd xformOp:orient");
    for (int frame = 0; frame <= 8; ++frame) EXPECT_TRUE(turns.contains(frame)) << frame;
    const std::vector<double>* last = nullptr;
    for (const auto& [time, q] : turns) {
      ASSERT_EQ(q.size(), 4u) << time;
      EXPECT_NEAR(std::inner_product(q.begin(), q.end(), q.begin(), 0.0), 1, 1e-12) << time;
      // Half the angle of an eighth of a turn.
      const std::vector<double>& before = last ? *last : q;
      EXPECT_GT(std::inner_product(q.begin(), q.end(), before.begin(), 0.0),
                std::cos(std::numbers::pi / 8) - 1e-9)
          << time;
      last = &q;
    }
  }
  for (const auto& [time, q] : samples_of(blade, "quatd xformOp:orient"))
    EXPECT_NEAR(std::abs(q[3]), std::abs(std::sin(19 * time / 24)), 1e-9) << time;
  // The turntable takes 6 frames.
  for (const auto& [time, x] : samples_of(view, "double3 xformOp:translate")) {
    const double turned = 2 * std::numbers::pi * time / 6;
    EXPECT_NEAR(x[0], 0.3 * std::cos(turned) + 0.8 * std::sin(turned), 1e-9) << time;
    EXPECT_NEAR(x[1], 0.3, 1e-12);
  }
  // A thing that rests has no samples.
  EXPECT_EQ(samples_of(text.substr(text.find("def Mesh \"floor\"")), "quatd xformOp:orient"),
            (std::map<double, std::vector<double>>{{-1, {1, 0, 0, 0}}}));
}

/// USD's own begins at one unit: a scene of half a metre would not be seen.
TEST_F(Export, TheCameraOfAStageSeesAllThatThereIs) {
  folder.write("turning.toml", turning_scene);
  for (const double scale : {1.0, 100.0}) {
    json_of_export({"turning.toml", "--format", "usda", "--frames", "0-6", "--scale",
                    std::to_string(scale), "--up", "z", "--out", scale > 1 ? "large" : "small"});
    const std::string text = read_text(folder / (scale > 1 ? "large" : "small") / "usda.usda");
    const auto range = samples_of(text, "float2 clippingRange");
    ASSERT_EQ(range.size(), 1u);
    const double near = range.at(-1).at(0) / scale, far = range.at(-1).at(1) / scale;
    // The eye is 0.3 m above the floor and more than 0.25 m from the box, which are seen up to the
    // corners of the picture; the corners of the floor's square are 7 m away.
    EXPECT_GT(near, 0.02);
    EXPECT_LT(near, 0.25);
    EXPECT_GT(far, 7.5);
    EXPECT_LT(far, 20);
  }
}

TEST_F(Export, SeriesAreInTheOrderOfTimeWheneverTheirFramesWereMade) {
  folder.write("followed.toml", std::string(followed_scene) + series);
  for (const char* frames : {"12-13", "10-11"})
    ASSERT_EQ(
        neve({"render", "followed.toml", "--frames", frames, "--out", "run", "--quiet"}).exit_code,
        0);
  const std::string stage = read_text(folder / "run/exports/usda.usda");
  EXPECT_TRUE(contains(stage, "startTimeCode = 10\n") && contains(stage, "endTimeCode = 13\n"))
      << stage.substr(0, 400);
  EXPECT_TRUE(contains(stage, "active = [(10, 0), (11, 1), (12, 2), (13, 3)]"));
  const std::vector<double> times =
      numbers_after(read_text(folder / "run/exports/vtp.pvd"), "timestep=\"");
  EXPECT_EQ(times.size(), 4u);
  EXPECT_TRUE(std::is_sorted(times.begin(), times.end()));
  EXPECT_EQ(neve({"verify", "run"}).exit_code, 0);
  ASSERT_EQ(neve({"render", "followed.toml", "--out", "whole", "--quiet"}).exit_code, 0);
  EXPECT_EQ(read_text(folder / "whole/exports/usda.usda"), stage)
      << "places that the camera follows are listed, for frames that another command made";
}

/// A mesh that changed since: what it would seed is not mixed with the states that are kept.
TEST_F(Export, ARunWhoseFilesHaveChangedIsRefusedByAllThatGoOnWithIt) {
  const auto tetrahedron = [](const char* x) {
    return std::string("v 0 0 0\nv ") + x +
           " 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
  };
  folder.write("solid.obj", tetrahedron("2"));
  folder.write("mesh.toml",
               "frames = 2\n[solver]\ncell_size = 0.08\n[[body]]\nshape = { mesh = { file = "
               "\"solid.obj\", scale = 0.5, center = [0, 0.4, 0] } }\n[output]\nsize = [160, "
               "90]\n");
  ASSERT_EQ(neve({"render", "mesh.toml", "--out", "run", "--quiet", "--no-movie"}).exit_code, 0);
  ASSERT_EQ(neve({"dump", "run", "--at", "0.02"}).exit_code, 0);
  const std::vector<std::string> of_scene{"mesh.toml", "--format", "ply", "--out", "ply"};
  json_of_export(of_scene);
  json_of_export(of_scene);
  folder.write("solid.obj", tetrahedron("3"));
  expect_refused(of_scene, app::exit_usage, "parameters or files have changed since");
  for (const std::vector<std::string>& words : std::vector<std::vector<std::string>>{
           {"dump", "run", "--at", "0.02"},
           {"strip", "run", "--at", "0,0.05", "--out", "strip.png"},
           {"render", "run", "--from", "0.05", "--out", "fork"},
           {"export", "run", "--format", "csv", "--out", "csv"}}) {
    const auto result = neve(words);
    EXPECT_EQ(result.exit_code, app::exit_invalid_scene) << words[0] << ": " << result.errors;
    EXPECT_TRUE(contains(result.errors, "solid.obj: error: has changed since the run in run"))
        << words[0] << ": " << result.errors;
  }
}

}  // namespace
}  // namespace neve::test

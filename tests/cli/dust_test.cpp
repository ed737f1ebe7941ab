/// Dust from a scene file to pictures, exports and run.json, through kills, forks and switches.

#include "app/output/atomic_file.h"
#include "tests/support/resume.h"

namespace neve::test {
namespace {

namespace fs = std::filesystem;

constexpr const char* dusty_scene = R"(
frames = 5
[solver]
cell_size = 0.03
[material.snow]
preset = "powder"
[dust]
speed = 0.5
settling_speed = 0.05
[[body]]
name = "ball"
shape = { sphere = { center = [-0.1, 0.13, 0], radius = 0.12 } }
velocity = [4, -4, 0]
[[collider]]
name = "floor"
shape = { plane = { point = [0, 0, 0], normal = [0, 1, 0] } }
[[view]]
name = "snow"
layers = ["ground", "snow", "dust"]
[[export]]
name = "cloud"
format = "ply"
dust = true
attributes = ["id", "x", "v", "m", "age"]
[output]
size = [160, 90]
)";

class DustRun : public Cli {
 protected:
  DustRun() { folder.write("dusty.toml", dusty_scene); }

  app::output::ProcessResult render(const std::string& out, std::vector<std::string> more = {}) {
    std::vector<std::string> words{"render", "dusty.toml", "--out", out, "--no-movie"};
    words.insert(words.end(), more.begin(), more.end());
    return neve(words);
  }
  std::vector<std::uint8_t> bytes_of(const std::string& file) {
    return app::output::read_file(folder / file);
  }
  app::Json dust_of(const std::string& out) {
    return json_of(out + "/run.json")["frames"].back()["dust"];
  }
};

TEST_F(DustRun, PictureHasTheCloudAndTheSnowIsTheSame) {
  ASSERT_EQ(render("with").exit_code, 0);
  ASSERT_EQ(render("without", {"--set", "material.snow.dust=0"}).exit_code, 0);
  EXPECT_EQ(hashes("with"), hashes("without"));
  const app::Json dust = dust_of("with");
  EXPECT_GT(dust["particles"].get<int>(), 20);
  EXPECT_EQ(dust["born"].get<int>(),
            dust["particles"].get<int>() + dust["settled"].get<int>() + dust["faded"].get<int>());
  EXPECT_FALSE(json_of("without/run.json")["frames"].back().contains("dust"));
  const auto compared = neve({"compare", "with/snow/0005.png", "without/snow/0005.png", "--json"});
  const app::Json difference = app::parse_json(std::string_view(compared.output));
  EXPECT_GT(difference["max"].get<double>(), 10) << compared.output;
  const auto start = neve({"compare", "with/snow/0000.png", "without/snow/0000.png", "--json"});
  EXPECT_EQ(start.exit_code, 0) << start.output;
}

TEST_F(DustRun, KilledAtAnyInstantItEndsWithTheSameCloud) {
  ASSERT_EQ(render("whole", {"--threads", "1"}).exit_code, 0);
  EXPECT_EQ(kill_and_resume(folder / "dusty.toml", folder / "parts", {4, 0.6, 3}), 4);
  const auto last = render("parts", {"--resume", "--checkpoint-every", "1"});
  ASSERT_EQ(last.exit_code, 0) << last.errors;
  EXPECT_EQ(hashes("whole"), hashes("parts"));
  EXPECT_EQ(dust_of("whole"), dust_of("parts"));
  for (const std::string file : {"exports/cloud/0003.ply", "exports/cloud/0005.ply"})
    EXPECT_TRUE(bytes_of("whole/" + file) == bytes_of("parts/" + file)) << file;
}

TEST_F(DustRun, ForkContinuesTheCloud) {
  ASSERT_EQ(render("whole", {"--checkpoint-every", "1"}).exit_code, 0);
  const auto fork = neve({"render", "whole", "--from", "0.125s", "--set", "dust.life=9", "--out",
                          "fork", "--no-movie"});
  ASSERT_EQ(fork.exit_code, 0) << fork.errors;
  // Lives are chosen at birth: the dust of the start lives on, and more is born.
  EXPECT_EQ(dust_of("fork")["born"], dust_of("whole")["born"]);
  EXPECT_EQ(hashes("fork")[5], hashes("whole")[5]);
}

/// A collider that has another shape in the same place: air that is simulated up to the change sees
/// it, as air that was read from a state does.
TEST_F(DustRun, AForkThatChangesAMeshIsTheSameFromAStateAndFromTheStart) {
  std::string box;
  for (int k = 0; k < 8; ++k) {
    box += "v";
    for (const int side : {k >> 2, k >> 1 & 1, k & 1}) box += side ? " 0.5" : " -0.5";
    box += "\n";
  }
  folder.write("box.obj", box +
                              "f 1 2 4 3\nf 5 7 8 6\nf 1 5 6 2\nf 3 4 8 7\nf 1 3 7 5\n"
                              "f 2 6 8 4\n");
  folder.write("rock.toml", R"(
frames = 6
[solver]
cell_size = 0.05
[dust]
speed = 0.5
strain_rate = 0.05
spray_drag = 0.5
[material.snow]
density = 200
dust = 0.05
[[body]]
shape = { sphere = { center = [0, 1.0, 0], radius = 0.2 } }
velocity = [0, -8, 0]
[[collider]]
name = "rock"
shape = { mesh = { file = "box.obj", center = [0, 0.3, 0], scale = 0.6 } }
[[collider]]
name = "floor"
shape = { plane = { point = [0, 0, 0], normal = [0, 1, 0] } }
[output]
size = [160, 90]
)");
  const std::vector<std::string> change{"--from", "0.125", "--set",
                                        "collider.rock.shape.mesh.scale=0.2", "--no-movie"};
  const auto fork = [&](const std::string& of, const std::string& out) {
    std::vector<std::string> words{"render", of, "--out", out};
    words.insert(words.end(), change.begin(), change.end());
    EXPECT_EQ(neve(words).exit_code, 0);
    return hashes(out);
  };
  ASSERT_EQ(neve({"render", "rock.toml", "--out", "whole", "--no-movie"}).exit_code, 0);
  EXPECT_EQ(fork("whole", "restored"), fork("rock.toml", "simulated"));
}

TEST_F(DustRun, ExportWritesPointsAndVolumesWithoutARun) {
  const auto exported = neve({"export", "dusty.toml", "--at", "0.2s", "--dust", "--format",
                              "ply,vdb,vti,npz", "--out", "files", "--json"});
  ASSERT_EQ(exported.exit_code, 0) << exported.errors;
  for (const std::string format : {"ply", "vdb", "vti", "npz"}) {
    int files = 0;
    for (const auto& entry : fs::recursive_directory_iterator(folder / "files"))
      files += entry.path().extension() == "." + format && fs::file_size(entry.path()) > 500;
    EXPECT_EQ(files, 1) << format;
  }
  const auto refused =
      neve({"export", "dusty.toml", "--at", "0.2s", "--dust", "--surface", "--format", "ply"});
  EXPECT_EQ(refused.exit_code, 2) << refused.errors;
  EXPECT_TRUE(contains(refused.errors, "dust has no surface")) << refused.errors;
  EXPECT_FALSE(contains(exported.errors, "sheds dust")) << exported.errors;
  const auto none = neve({"export", "dusty.toml", "--at", "0s", "--dust", "--format", "csv",
                          "--set", "material.snow.dust=0", "--out", "none"});
  EXPECT_TRUE(contains(none.errors, "no snow of the scene sheds dust")) << none.errors;
  folder.write("by_curve.toml", std::string(dusty_scene) +
                                    "[[curve]]\nparameter = \"material.snow.dust\"\n"
                                    "keyframes = [{ time = 0, value = 0 }, { time = 0.1, value = "
                                    "0.02 }]\n");
  const auto by_curve = neve(
      {"export", "by_curve.toml", "--at", "0s", "--dust", "--format", "csv", "--out", "by_curve"});
  EXPECT_EQ(by_curve.exit_code, 0) << by_curve.errors;
  EXPECT_FALSE(contains(by_curve.errors, "sheds dust")) << by_curve.errors;
}

}  // namespace
}  // namespace neve::test

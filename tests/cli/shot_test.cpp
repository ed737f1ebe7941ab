/// A shot from 1001 with handles, slate, words and time code, as it comes out of every command; and
/// one with the coordinates of a map.

#include <cstdio>
#include <filesystem>
#include <sstream>

#include "app/output/atomic_file.h"
#include "app/output/process.h"
#include "render/image/exr.h"
#include "render/image/exr_header.h"
#include "render/image/image.h"
#include "tests/cli/run_neve.h"
#include "tests/support/child.h"
#include "tests/support/needs.h"

namespace neve::test {
namespace {

constexpr const char* shot_scene = R"(
title = "Wall"
frames = 2
first_frame = 1001
handles = 1
[solver]
cell_size = 0.08
[[view]]
name = "particles"
[[body]]
shape = { sphere = { center = [0, 0.3, 0], radius = 0.12 } }
[output]
size = [320, 180]
[shot]
show = "Alp"
name = "sh010"
version = "v003"
artist = "Ina"
slate = true
[burn_in]
top_left = "{shot.name}"
bottom_right = "{frame}"
[[export]]
format = "csv"
every = 2
)";

class Shots : public Cli {
 protected:
  Shots() { folder.write("shot.toml", shot_scene); }

  void run(std::vector<std::string> arguments) {
    const auto result = neve(arguments);
    EXPECT_EQ(result.exit_code, 0) << result.errors;
  }
  app::Json run_json(const std::string& of) { return json_of(of + "/run.json"); }
};

TEST_F(Shots, HaveTheirNumbersInEveryName) {
  run({"render", "shot.toml", "--out", "a", "--no-movie", "--quiet"});
  for (const char* name : {"0999.png", "1000.png", "1001.png", "1003.png", "1004.png"})
    EXPECT_TRUE(exists(std::string("a/particles/") + name)) << name;
  EXPECT_FALSE(exists("a/particles/1005.png"));
  EXPECT_FALSE(exists("a/particles/0000.png"));
  const app::Json json = run_json("a");
  EXPECT_EQ(json["frames"].size(), 5u);
  EXPECT_EQ(json["frames"][0]["frame"], 1000);
  EXPECT_EQ(json["frames"][0]["time"], 0.0);
  EXPECT_EQ(json["frames"][4]["frame"], 1004);
  EXPECT_EQ(json["slate"], 999);
  EXPECT_TRUE(json["files"].contains("particles/0999.png"));
  for (const char* name : {"1000.csv", "1002.csv", "1004.csv"})
    EXPECT_TRUE(exists(std::string("a/exports/csv/") + name)) << name;
  EXPECT_FALSE(exists("a/exports/csv/1001.csv"));
  run({"verify", "a"});
  const auto info = neve({"info", "a/particles/1003.png", "--json"});
  EXPECT_EQ(app::parse_json(info.output)["frame"], 1003);
}

TEST_F(Shots, AreResumedAndMadeAgainByTheirNumbers) {
  run({"render", "shot.toml", "--out", "whole", "--no-movie", "--quiet"});
  run({"render", "shot.toml", "--out", "parts", "--no-movie", "--quiet", "--frames", "1002"});
  EXPECT_FALSE(exists("parts/particles/1003.png"));
  std::filesystem::remove(folder / "parts/particles/1001.png");
  run({"render", "shot.toml", "--out", "parts", "--no-movie", "--quiet", "--resume"});
  EXPECT_TRUE(exists("parts/particles/1001.png"));
  EXPECT_EQ(run_json("parts")["frames"][4]["state_hash"],
            run_json("whole")["frames"][4]["state_hash"]);
  run({"verify", "parts"});
  run({"render", "whole/particles/1003.png", "--out", "again", "--no-movie", "--quiet"});
  EXPECT_EQ(run_json("again")["frames"][0]["frame"], 1003);
  EXPECT_EQ(run_json("again")["frames"][0]["state_hash"],
            run_json("whole")["frames"][3]["state_hash"]);
}

/// The time of a picture is 0 at the first handle, whatever its number, as in run.json.
TEST_F(Shots, HaveTheirNumbersInForecastsNotesAndAdvice) {
  const auto check = neve({"check", "shot.toml", "--json"});
  const app::Json frames = app::parse_json(check.output)["frames"];
  ASSERT_EQ(frames.size(), 4u);
  EXPECT_EQ(frames[0]["frame"], 1001);
  EXPECT_EQ(frames[3]["frame"], 1004);
  EXPECT_TRUE(contains(neve({"check", "shot.toml"}).output, "in frame 100"));
  run({"render", "shot.toml", "--out", "a", "--no-movie", "--quiet"});
  EXPECT_TRUE(contains(neve({"dump", "a", "--at", "0.13"}).errors,
                       "continues from the checkpoint of frame 1003"));
  const auto late = neve({"dump", "a", "--at", "1002"});
  EXPECT_EQ(late.exit_code, app::exit_usage);
  EXPECT_TRUE(contains(late.errors, "frame 1002 is at 0.08333333333333333 s")) << late.errors;
}

TEST_F(Shots, PassesHaveTheTimeOfTheRun) {
  run({"render", "shot.toml", "--out", "a", "--no-movie", "--quiet", "--frames", "1001-1001",
       "--passes", "depth"});
  const auto text = render::read_exr_text(app::output::read_file(folder / "a/particles/1001.exr"));
  EXPECT_NEAR(std::stod(text.at("neve:time")), 1.0 / 24, 1e-12);
}

/// SMPTE 12M packs two digits in a byte, frames lowest.
TEST_F(Shots, PassesHaveTheTimeCodeOfTheShot) {
  run({"render", "shot.toml", "--out", "a", "--no-movie", "--quiet", "--frames", "1002-1002",
       "--passes", "depth", "--set", "shot.time_code=10:20:30:11"});
  const auto bytes = app::output::read_file(folder / "a/particles/1002.exr");
  for (const render::ExrAttribute& attribute : render::read_exr_attributes(bytes)) {
    if (attribute.name != "timeCode") continue;
    EXPECT_EQ((std::vector<std::uint8_t>(attribute.bytes.begin(), attribute.bytes.begin() + 4)),
              (std::vector<std::uint8_t>{0x12, 0x30, 0x20, 0x10}));
    return;
  }
  ADD_FAILURE() << "no time code";
}

TEST_F(Shots, RefuseNumbersBeforeTheFirst) {
  const auto result = neve({"render", "shot.toml", "--frames", "0-3"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_NE(result.errors.find("the scene begins with frame 1000, not 0; expected frames from 1000 "
                               "to 1004"),
            std::string::npos)
      << result.errors;
}

/// The slate is one frame before the first: 999 of 24 a second are 41 s and 15 frames.
TEST_F(Shots, MoviesHaveSlateAndTimeCode) {
  const auto ffprobe = app::output::find_program("ffprobe");
  if (!ffprobe) GTEST_SKIP() << "ffprobe is not installed";
  run({"render", "shot.toml", "--out", "a", "--quiet"});
  const auto probed = [&](const std::string& movie) {
    return app::output::run_process(
               *ffprobe,
               {"-v", "error", "-count_frames", "-select_streams", "v", "-show_entries",
                "stream=nb_read_frames:stream_tags=timecode", "-of", "csv=p=0", movie},
               folder.path(), 60)
        .output;
  };
  EXPECT_EQ(probed("a/particles.mp4"), "6,00:00:41:15\n");
  run({"compare", "a", "a", "--mode", "wipe", "--out", "c.mp4"});
  EXPECT_EQ(probed("c.mp4"), "5,00:00:41:16\n") << "it has no slate";
}

TEST_F(Shots, CountBelowZero) {
  run({"render", "shot.toml", "--set", "first_frame=0", "--out", "a", "--quiet"});
  for (const char* name : {"-002.png", "-001.png", "0000.png", "0003.png"})
    EXPECT_TRUE(exists(std::string("a/particles/") + name)) << name;
  EXPECT_EQ(exists("a/particles.mp4"), app::output::find_program("ffmpeg").has_value());
  run({"render", "a/particles/-001.png", "--out", "again", "--no-movie", "--quiet"});
  EXPECT_EQ(run_json("again")["frames"][0]["state_hash"], run_json("a")["frames"][0]["state_hash"]);
}

/// It has no picture whose size a slate could have: the run became a failed one.
TEST_F(Shots, AViewThatWasInterruptedBeforeItsFirstPictureHasNoSlate) {
  const std::vector<std::string> more{"--no-movie",         "--quiet", "--no-keep-states",
                                      "--checkpoint-every", "0",       "--set",
                                      "frames=10",          "--set",   "solver.cell_size=0.03"};
  std::vector<std::string> first{"render", "shot.toml", "--out", "a"};
  first.insert(first.end(), more.begin(), more.end());
  run(first);
  std::vector<std::string> second{NEVE_BINARY, "render",     folder / "shot.toml",
                                  "--out",     folder / "a", "--view",
                                  "smoke",     "--frames",   "1012-1012"};
  second.insert(second.end(), more.begin(), more.end());
  const pid_t child = start_program(second);
  ASSERT_GT(child, 0);
  ASSERT_TRUE(wait_for_file(folder / "a/smoke"));
  ::kill(child, SIGINT);
  EXPECT_EQ(wait_for(child), 130);
  EXPECT_EQ(run_json("a")["status"], "interrupted");
}

/// The slate of the earlier frames was taken for the picture of its number.
TEST_F(Shots, EarlierFramesTakeThePlaceOfTheSlate) {
  run({"render", "shot.toml", "--out", "a", "--no-movie", "--quiet", "--frames", "1002-1004"});
  EXPECT_EQ(run_json("a")["slate"], 1001);
  run({"render", "shot.toml", "--out", "a", "--no-movie", "--quiet"});
  run({"render", "shot.toml", "--out", "whole", "--no-movie", "--quiet"});
  EXPECT_EQ(run_json("a")["frames"].size(), 5u);
  EXPECT_EQ(hashes("a"), hashes("whole"));
  EXPECT_EQ(run_json("a")["slate"], 999);
  EXPECT_TRUE(app::output::read_file(folder / "a/particles/1001.png") ==
              app::output::read_file(folder / "whole/particles/1001.png"));
  run({"verify", "a"});
}

/// A script waits for the number that the user sees.
TEST_F(Shots, ScriptsOfViewNameTheirNumbers) {
  folder.write("script.json", R"([
    {"click": "Frame"}, {"wait_for": "simulation frame 1001", "within": 60}, {"quit": true}])");
  run({"view", "shot.toml", "--replay", "script.json", "--out", "viewed", "--size", "900x600"});
}

/// Plates have the numbers of the frames.
TEST_F(Shots, PlatesAreFoundByTheNumbersOfTheFrames) {
  run({"render", "shot.toml", "--out", "a", "--no-movie", "--quiet"});
  run({"render", "shot.toml", "--out", "b", "--no-movie", "--quiet", "--frames", "1003-1004",
       "--plate", "a/particles/####.png"});
  EXPECT_TRUE(exists("b/particles/1004.png"));
}

/// A shot over plates from 1001, as a film: each of its frames is over the plate of its number.
TEST_F(Shots, AFilmOverPlatesFrom1001HasTheirFrames) {
  const auto ffprobe = app::output::find_program("ffprobe");
  const auto ffmpeg = app::output::find_program("ffmpeg");
  if (!ffprobe || !ffmpeg) SKIP_OR_FAIL("no ffmpeg in PATH");
  app::output::make_folder(folder / "plates");
  for (int number = 1001; number <= 1003; ++number) {
    const auto grey = static_cast<std::uint8_t>(60 * (number - 1000));
    const render::Image plate{320, 180, 3, std::vector<std::uint8_t>(320 * 180 * 3, grey)};
    app::output::write_file(folder / ("plates/shot." + std::to_string(number) + ".png"),
                            render::encode_png(plate));
  }
  run({"render", "shot.toml", "--set", "handles=0", "--set", "shot.slate=false", "--plate",
       "plates/shot.%04d.png", "--no-caption", "--out", "a", "--quiet"});
  const auto probed = app::output::run_process(
      *ffprobe,
      {"-v", "error", "-count_frames", "-select_streams", "v", "-show_entries",
       "stream=width,height,r_frame_rate,color_space,nb_read_frames:stream_tags=timecode", "-of",
       "csv=p=0", "a/particles.mp4"},
      folder.path(), 60);
  // 1001 frames of 24 a second are 41 s and 17 frames.
  EXPECT_EQ(probed.output, "320,180,bt709,24/1,3,00:00:41:17\n") << probed.errors;
  for (int k = 0; k < 3; ++k) {
    const auto pixel = app::output::run_process(
        *ffmpeg,
        {"-v", "error", "-i", "a/particles.mp4", "-vf",
         "select=eq(n\\," + std::to_string(k) + "),crop=16:16:20:90,scale=1:1,format=gray",
         "-frames:v", "1", "-f", "rawvideo", "-"},
        folder.path(), 60);
    ASSERT_EQ(pixel.output.size(), 1u) << pixel.errors;
    // The film is lossy; one plate is 60 from the next.
    EXPECT_NEAR(static_cast<unsigned char>(pixel.output[0]), 60 * (k + 1), 8) << k;
  }
}

TEST_F(Shots, SweepsHaveTheNumbersOfTheirScene) {
  run({"sweep", "shot.toml", "-p", "material.snow.hardening=5,10", "--out", "s.cdb", "--quiet",
       "--frames", "1000-1001", "--movie", "none", "--review"});
  EXPECT_TRUE(exists("s.cdb/runs/0001/particles/1001.png"));
  EXPECT_TRUE(exists("s.cdb/sheet/1001.png"));
  EXPECT_TRUE(exists("s.cdb/review/run_0001.1001.png"));
  EXPECT_EQ(json_of("s.cdb/runs.otio")["tracks"]["children"][0]["children"].size(), 2u);
  run({"sweep", "collect", "s.cdb", "--quiet", "--movie", "none"});
  EXPECT_TRUE(exists("s.cdb/review/run_0001.1001.png")) << "later collects keep the links";
  std::filesystem::remove_all(folder / "s.cdb/review");
  run({"sweep", "collect", "s.cdb", "--quiet", "--movie", "none"});
  EXPECT_TRUE(contains(read_text(folder / "s.cdb/runs.otio"), "runs/0001/particles/"));
}

/// A hut of a map: east, north, up in UTM, drawn with y up.
constexpr const char* map_scene = R"(
frames = 0
[solver]
cell_size = 0.1
[[view]]
name = "particles"
[[body]]
name = "hut"
shape = { mesh = { file = "hut.obj", coordinates = "world", rotation = [-90, 0, 0] } }
[output]
size = [160, 90]
)";

constexpr const char* hut_obj = R"(v 431250 5254000 1800
v 431251 5254000 1800
v 431250 5254001 1800
v 431251 5254001 1800
v 431250 5254000 1801
v 431251 5254000 1801
v 431250 5254001 1801
v 431251 5254001 1801
f 1 3 4 2
f 5 6 8 7
f 1 2 6 5
f 3 7 8 4
f 1 5 7 3
f 2 4 8 6
)";

TEST_F(Shots, ExportsPutTheOffsetOfAMapBack) {
  folder.write("map.toml", map_scene);
  folder.write("hut.obj", hut_obj);
  run({"export", "map.toml", "--format", "csv,usda", "--up", "z", "--attributes", "x", "--out",
       "e"});
  std::istringstream rows(read_text(folder / "e/csv/0000.csv"));
  std::string row;
  std::getline(rows, row);
  int count = 0;
  for (; std::getline(rows, row); ++count) {
    double x = 0, y = 0, z = 0;
    ASSERT_EQ(std::sscanf(row.c_str(), "%lf,%lf,%lf", &x, &y, &z), 3) << row;
    EXPECT_NEAR(x, 431250.5, 0.5);
    EXPECT_NEAR(y, 5254000.5, 0.5);
    EXPECT_NEAR(z, 1800.5, 0.5);
  }
  EXPECT_GT(count, 1000);
  EXPECT_TRUE(
      contains(read_text(folder / "e/usda/0000.usda"), "double3 xformOp:translate = (4312"));
  EXPECT_EQ(json_of("e/export.json")["world_offset"].size(), 3u);
  // The picture alone has the offset: it is made again without looking for it.
  run({"render", "map.toml", "--out", "m", "--no-movie", "--quiet"});
  EXPECT_EQ(json_of("m/run.json")["world_offset"], json_of("e/export.json")["world_offset"]);
  run({"render", "m/particles/0000.png", "--out", "again", "--no-movie", "--quiet"});
  EXPECT_EQ(json_of("again/run.json")["frames"][0]["state_hash"],
            json_of("m/run.json")["frames"][0]["state_hash"]);
}

TEST_F(Shots, CheckSaysThatAMapIsFarAway) {
  folder.write("map.toml", map_scene);
  folder.write("hut.obj", hut_obj);
  const auto far =
      neve({"check", "map.toml", "--set", "body.hut.shape.mesh.origin=[381250,5254000,1800]",
            "--set", "solver.cell_size=0.5"});
  EXPECT_TRUE(contains(far.output + far.errors, "coordinates = \"world\""))
      << far.output << far.errors;
}

}  // namespace
}  // namespace neve::test

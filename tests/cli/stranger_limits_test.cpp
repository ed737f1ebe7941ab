/// Outputs beyond a limit: refused by their plan, before the first step, and within the limit.

#include <cstring>
#include <filesystem>
#include <fstream>

#include "app/output/atomic_file.h"
#include "app/record/picture_record.h"
#include "render/image/exr.h"
#include "render/image/image.h"
#include "tests/support/costly_cli.h"

namespace neve::test {
namespace {

/// docs/trust.md promises a tenth more than the limit at most.
constexpr double most = 440e6;
const std::string limit = " --max-memory 400MB";

class StrangerLimits : public CostlyCli {
 protected:
  void expect_refused(const std::string& arguments, const std::string& word) {
    const Cost cost = cost_of(arguments + limit);
    const std::string said = read_text(folder / "said");
    EXPECT_EQ(cost.exit_code, 8) << arguments << "\n" << said;
    EXPECT_TRUE(contains(said, "refused: ") && contains(said, word)) << arguments << "\n" << said;
    EXPECT_LT(cost.seconds, 2) << arguments;
    EXPECT_LT(cost.memory, most) << arguments;
  }
  void expect_within(const std::string& arguments, int exit_code = 0) {
    const Cost cost = cost_of(arguments + limit);
    EXPECT_EQ(cost.exit_code, exit_code) << arguments << "\n" << read_text(folder / "said");
    EXPECT_LT(cost.memory, most) << arguments;
  }
  void make_run() {
    ASSERT_EQ(
        neve({"render", "scene.toml", "--frames", "0-1", "--out", "run", "--no-movie"}).exit_code,
        0);
  }
  /// A copy of a picture with another text.
  void write_with(const std::string& from, const std::string& key, const std::string& value,
                  const std::string& to) {
    const auto bytes = app::output::read_file(folder / from);
    render::PngText texts = render::read_png_text(bytes);
    texts["neve:" + key] = value;
    app::output::write_file(folder / to, render::encode_png(render::decode_png(bytes), texts));
  }
};

TEST_F(StrangerLimits, StripsAreAsLargeAsTheirPlanSays) {
  expect_refused(
      "strip scene.toml --columns 1 --tiles 20 --set output.size='[1280, 720]' --set "
      "frames=19 --frames 0-19",
      "the strip needs about");
  expect_refused("strip scene.toml --width 16384 --columns 1 --tiles 2", "the strip needs about");
  expect_within("strip scene.toml --columns 1 --tiles 2 --width 320 --frames 0-1 --out strip.png");
  for (const char* width : {"16384", "10000"}) {
    write_with("strip.png", "strip",
               std::string(R"({"times":[0,0.01,0.02,0.03],"columns":1,"width":)") + width + "}",
               "wide.png");
    expect_refused("strip wide.png --yes", "the strip needs about");
  }
}

/// Longer than any backend draws at once, and not longer than the memory.
TEST_F(StrangerLimits, ALongStripIsDrawnOrRefusedBeforeItsFirstStep) {
  const Cost cost = cost_of(
      "strip scene.toml --columns 1 --tiles 33 --width 1000 --frames 0-1 "
      "--set output.size='[1000, 1000]' --out long.png --max-memory 4GB");
  EXPECT_TRUE(cost.exit_code == 0 || cost.exit_code == 8) << read_text(folder / "said");
  if (cost.exit_code == 8) {
    EXPECT_LT(cost.seconds, 1);
  }
}

TEST_F(StrangerLimits, ComparisonsAreAsLargeAsTheirPlanSays) {
  make_run();
  expect_refused("compare run run --size 12000x9000 --out c.png", "a picture of one run needs");
  expect_refused("compare run run --size 8400x400 --out c.png", "at most ");
}

TEST_F(StrangerLimits, DenseGridsOfSnowFarApartAreRefused) {
  for (const char* away : {"12", "24"}) {
    const std::string place = std::string("[") + away + ", " + away + ", " + away + "]";
    folder.write("apart.toml", tiny_scene +
                                   std::string("[[body]]\nshape = { sphere = { center = ") + place +
                                   ", radius = 0.08 } }\n");
    expect_refused("export apart.toml --frames 0 --format vti --set solver.cell_size=0.05",
                   "the box of nodes around the snow needs about");
  }
}

TEST_F(StrangerLimits, ManySmallViewsAreForeseen) {
  folder.write("views.toml", with_views(300, "[16, 16]"));
  expect_within("render views.toml --frames 0 --no-movie");
  for (const int count : {1000, 3000}) {
    folder.write("views.toml", with_views(count, "[16, 16]"));
    expect_refused("render views.toml --frames 0 --no-movie",
                   std::to_string(count + 1) + " pictures a frame take most of it: draw some");
  }
}

/// Values of two characters take the most memory for their length.
TEST_F(StrangerLimits, ListsAreNoLongerThanTheirLimit) {
  make_run();
  const std::string run = read_text(folder / "run/run.json");
  const auto with_list = [&](std::size_t values) {
    std::ofstream file(folder / "run/run.json", std::ios::binary);
    file << run.substr(0, run.rfind('}')) << ", \"list\": [0";
    for (std::size_t k = 1; k < values; ++k) file << ",0";
    file << "]}";
  };
  ::setenv("NEVE_MAX_MEMORY", "400MB", 1);  // verify and info have no flag for it
  with_list(7'000'000);
  EXPECT_LT(cost_of("info run").memory, most);
  with_list(12'000'000);
  for (const char* command : {"verify run", "info run", "render run --yes", "compare run run"}) {
    const Cost cost = cost_of(command);
    EXPECT_EQ(cost.exit_code, 8) << command;
    EXPECT_TRUE(contains(read_text(folder / "said"), "what it lists needs about")) << command;
    EXPECT_LT(cost.memory, 100e6) << command;
  }
  ::unsetenv("NEVE_MAX_MEMORY");
  // This file is larger than any list of neve, and is refused with any memory.
  std::filesystem::resize_file(folder / "run/run.json", 140'000'000);
  EXPECT_EQ(cost_of("info run").exit_code, 6);
  EXPECT_TRUE(contains(read_text(folder / "said"), "larger than 134217728 bytes"));
}

/// A string attribute of 2^31 - 1 bytes in 1 kB.
TEST_F(StrangerLimits, AttributesAreNoLongerThanTheirFile) {
  make_run();
  render::ExrHeader header;
  header.text = render::read_png_text(app::output::read_file(folder / "run/particles/0001.png"));
  std::vector<std::uint8_t> bytes =
      render::encode_exr({4, 4, {{"Z", std::vector<float>(16, 1.0f)}}}, header);
  const std::string name("neve:scene\0string\0", 18);
  const auto at = std::search(bytes.begin(), bytes.end(), name.begin(), name.end());
  ASSERT_NE(at, bytes.end());
  constexpr std::int32_t vast = 2147483647;
  std::memcpy(&*at + name.size(), &vast, sizeof vast);
  app::output::write_file(folder / "vast.exr", bytes);
  const Cost cost = cost_of("info vast.exr");
  EXPECT_TRUE(cost.exit_code == 3 || cost.exit_code == 6) << read_text(folder / "said");
  EXPECT_LT(cost.memory, 100e6);
  const Cost plate = cost_of("render scene.toml --frames 0 --plate vast.exr --out o" + limit);
  EXPECT_TRUE(plate.exit_code == 2 || plate.exit_code == 3) << read_text(folder / "said");
  EXPECT_LT(plate.memory, most);
}

/// Each is a reading of the scene: the time of all of them is said before the first.
TEST_F(StrangerLimits, ManyChangesOfALongSceneAreForeseen) {
  std::string text = tiny_scene;
  for (int k = 0; k < 300; ++k) text += "[material.m" + std::to_string(k) + "]\nhardening = 7\n";
  folder.write("scene.toml", text);
  make_run();
  const auto changed = [&](int count) {
    std::string changes = "[";
    for (int k = 0; k < count; ++k)
      changes += std::string(k ? "," : "") +
                 R"({"step":0,"address":"material.snow.hardening","value":")" +
                 std::to_string(k % 9 + 1) + R"("})";
    write_with("run/particles/0001.png", "changes", changes + "]", "changed.png");
  };
  changed(10'000);
  for (const char* command : {"render changed.png", "strip changed.png", "dump changed.png"}) {
    const Cost cost = cost_of(std::string(command) + " </dev/null");
    const std::string said = read_text(folder / "said");
    EXPECT_EQ(cost.exit_code, 8) << command << said;
    EXPECT_TRUE(contains(said, "--yes agrees")) << command << said;
    EXPECT_LT(cost.seconds, 5) << command;
  }
  EXPECT_EQ(cost_of("info changed.png").exit_code, 0);
  changed(100);
  const Cost cost = cost_of("dump changed.png --at 0 --yes");
  EXPECT_EQ(cost.exit_code, 0) << read_text(folder / "said");
  EXPECT_LT(cost.seconds, 5);
  EXPECT_LT(cost.memory, 500e6);
}

}  // namespace
}  // namespace neve::test

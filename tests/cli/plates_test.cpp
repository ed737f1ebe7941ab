/// neve render --shutter and --plate: motion blur, and pictures behind the snow.

#include <algorithm>
#include <filesystem>

#include "app/output/atomic_file.h"
#include "render/image/exr.h"
#include "render/image/image.h"
#include "render/image/jpeg.h"
#include "tests/cli/run_neve.h"

namespace neve::test {
namespace {

/// A ball that flies to the right at 3 m/s, 0.125 m a frame.
constexpr const char* fast_ball_scene = R"(
frames = 1
[solver]
cell_size = 0.04
gravity = [0, 0, 0]
[[view]]
name = "particles"
[[body]]
shape = { sphere = { center = [0, 0.3, 0], radius = 0.12 } }
velocity = [3, 0, 0]
[camera]
eye = [0, 0.3, 2]
target = [0, 0.3, 0]
fov = 28.0725
[output]
size = [160, 90]
background = "transparent"
)";

class Plates : public Cli {
 protected:
  Plates() { folder.write("flying.toml", fast_ball_scene); }

  void render(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), {"render"});
    arguments.insert(arguments.end(), {"--no-movie", "--no-caption", "--quiet"});
    const auto result = neve(arguments);
    EXPECT_EQ(result.exit_code, 0) << result.errors;
  }
  render::Image picture(const std::string& file) {
    return render::decode_png(app::output::read_file(folder / file));
  }
  /// Pixels that are covered by any snow, and by snow alone, in the middle row of frame 0.
  std::pair<int, int> covered(const std::string& run) {
    const render::Image image = picture(run + "/particles/0000.png");
    std::pair<int, int> count;
    for (std::size_t x = 0; x < 160; ++x) {
      const int alpha = image.pixels.at(4 * (45 * 160 + x) + 3);
      count.first += alpha > 4 ? 1 : 0;
      count.second += alpha > 250 ? 1 : 0;
    }
    return count;
  }
};

/// A picture shows 90 pixels a metre: the ball moves by 11.25 pixels a frame.
TEST_F(Plates, AnOpenShutterSmearsByTheWayOfTheSnow) {
  const std::vector<std::string> common{"flying.toml", "--frames", "0-0", "--quality", "final"};
  const auto with = [&](std::vector<std::string> more) {
    more.insert(more.begin(), common.begin(), common.end());
    render(more);
  };
  with({"--shutter", "0", "--out", "sharp"});
  with({"--out", "usual"});
  with({"--shutter", "360", "--out", "open"});
  const auto [sharp, sharp_solid] = covered("sharp");
  const auto [usual, usual_solid] = covered("usual");
  const auto [open, open_solid] = covered("open");
  // The shutter opens and closes slowly: the first light comes a quarter of its time before.
  constexpr double reach = 1.4;  // of 1.5, where there is enough to count
  EXPECT_NEAR(usual - sharp, reach * 5.6, 2);
  EXPECT_NEAR(open - sharp, reach * 11.25, 2);
  EXPECT_NEAR(sharp_solid - open_solid, 11.25, 3);
  EXPECT_LT(usual_solid, sharp_solid);
}

/// Nothing but a ground moves in these: it tilts, or the camera flies over it.
TEST_F(Plates, GroundsAreBlurredByTheirWayAndByThatOfTheCamera) {
  const std::string still =
      "frames = 2\n[solver]\ncell_size = 0.08\ngravity = [0, 0, 0]\n[output]\nsize = [160, 90]\n"
      "[[view]]\nname = \"p\"\nlayers = [\"ground\", \"particles\"]\n"
      "[[body]]\nshape = { sphere = { center = [0, 9, 0], radius = 0.1 } }\n"
      "[[collider]]\nname = \"floor\"\nshape = { plane = { normal = [0, 1, 0] } }\n";
  folder.write("tilts.toml",
               still +
                   "keyframes = [{ time = 0 }, { time = 0.1, rotation = [0, 0, 30] }]\n"
                   "[camera]\neye = [0, 1.2, 5]\ntarget = [0, 0.5, 0]\n");
  folder.write("flown.toml", still +
                                 "[camera]\neye = [0, 0.6, 1.5]\ntarget = [0, 0, 0]\n"
                                 "keyframes = [{ time = 0 }, { time = 0.1, "
                                 "eye = [0.5, 0.6, 1.5], target = [0.5, 0, 0] }]\n");
  for (const std::string scene : {"tilts", "flown"}) {
    const auto drawn = [&](const std::string& shutter) {
      const std::string out = scene + shutter;
      render({scene + ".toml", "--frames", "1-1", "--shutter", shutter, "--out", out});
      return picture(out + "/p/0001.png");
    };
    EXPECT_GT(render::compare(drawn("0"), drawn("360")).local, 2) << scene;
  }
}

/// Nothing but a see-through collider moves in these.
TEST_F(Plates, GhostsAndWiresAreBlurredByTheirWay) {
  for (const std::string style : {"ghost", "wire"})
    for (const std::string form :
         {"sphere = { center = [0, 0.6, 0], radius = 0.3 }",
          "box = { center = [0, 0.6, 0], size = [0.5, 0.5, 0.5] }", "plane = { }"}) {
      folder.write("seen.toml",
                   "frames = 1\n[solver]\ncell_size = 0.08\ngravity = [0, 0, 0]\n[output]\n"
                   "size = [160, 90]\n[camera]\neye = [0, 1.2, 5]\ntarget = [0, 0.5, 0]\n"
                   "[[view]]\nname = \"p\"\nlayers = [\"ground\", \"colliders\", \"particles\"]\n"
                   "[[body]]\nshape = { sphere = { center = [0, 9, 0], radius = 0.1 } }\n"
                   "[[collider]]\nname = \"seen\"\nstyle = \"" +
                       style + "\"\nshape = { " + form + " }\n" +
                       "keyframes = [{ time = 0 }, { time = 0.1, rotation = [0, 0, 30], "
                       "position = [0.5, 0, 0] }]\n");
      const auto drawn = [&](const std::string& shutter) {
        render({"seen.toml", "--frames", "1-1", "--shutter", shutter, "--out", "run", "--replace"});
        return picture("run/p/0001.png");
      };
      EXPECT_GT(render::compare(drawn("0"), drawn("360")).local, 2) << style << " " << form;
    }
}

TEST_F(Plates, ABlurredPictureMakesItselfAgain) {
  render({"flying.toml", "--frames", "0-0", "--shutter", "180", "--out", "first"});
  render({"first/particles/0000.png", "--out", "again"});
  EXPECT_EQ(read_text(folder / "first/particles/0000.png"),
            read_text(folder / "again/particles/0000.png"));
  EXPECT_TRUE(
      contains(neve({"info", "first/particles/0000.png"}).output, "shutter     180 degrees"));
}

TEST_F(Plates, APlateIsBehindTheSnow) {
  render::Image plate{160, 90, 3, std::vector<std::uint8_t>(160 * 90 * 3, 77)};
  const auto bytes = render::encode_png(plate);
  app::output::make_folder(folder / "street");
  app::output::write_file(folder / "street/0000.png", bytes);
  plate.pixels.assign(plate.pixels.size(), 200);
  app::output::write_file(folder / "street/0001.png", render::encode_png(plate));
  render({"flying.toml", "--plate", "street/%04d.png", "--out", "run"});
  const render::Image first = picture("run/particles/0000.png"),
                      second = picture("run/particles/0001.png");
  EXPECT_EQ(first.channels, 3);
  EXPECT_EQ(first.pixels.at(30), 77);
  EXPECT_EQ(second.pixels.at(30), 200);
  EXPECT_GT(first.pixels.at(3 * (45 * 160 + 80)), 120) << "no snow";
  render({"run/particles/0001.png", "--out", "again"});
  EXPECT_EQ(picture("again/particles/0001.png").pixels, second.pixels);
  std::filesystem::create_directory(folder / "moved");
  for (const char* part : {"street", "run"})
    std::filesystem::rename(folder / part, folder / "moved" / part);
  render({"moved/run/particles/0001.png", "--out", "moved_again"});
  EXPECT_EQ(picture("moved_again/particles/0001.png").pixels, second.pixels);
  for (const char* part : {"street", "run"})
    std::filesystem::rename(folder / "moved" / part, folder / part);
  app::output::write_file(folder / "street/0001.png", bytes);
  EXPECT_EQ(neve({"render", "run/particles/0001.png", "--out", "other"}).exit_code, 3);
}

TEST_F(Plates, PlatesOfOtherFormatsAndNumbersAreRead) {
  // Linear light 0.5 is 188 of sRGB.
  render::ExrPicture exr{160, 90, {}};
  for (const char* name : {"R", "G", "B"})
    exr.channels.push_back({name, std::vector<float>(160 * 90, 0.5f)});
  const auto bytes = render::encode_exr(exr);
  for (const char* file : {"plate.exr", "p.0000.exr"})
    app::output::write_file(folder / file, bytes);
  render::Image covered{160, 90, 4, std::vector<std::uint8_t>(160 * 90 * 4, 255)};
  for (std::size_t i = 3; i < covered.pixels.size(); i += 4) covered.pixels[i] = 0;
  app::output::write_file(folder / "alpha.png", render::encode_png(covered));
  const auto corner = [&](const std::string& plate) {
    render({"flying.toml", "--frames", "0-0", "--plate", plate, "--out", "run", "--replace"});
    return int{picture("run/particles/0000.png").pixels.at(30)};
  };
  for (const char* plate : {"plate.exr", "p.####.exr", "p.$F4.exr", "p.%04d.exr"})
    EXPECT_EQ(corner(plate), 188) << plate;
  EXPECT_EQ(corner("alpha.png"), 0) << "white that covers nothing";
  if (render::can_encode_jpeg()) {
    const render::Image grey{160, 90, 3, std::vector<std::uint8_t>(160 * 90 * 3, 77)};
    app::output::write_file(folder / "photo.jpg", render::encode_jpeg(grey, 95, true));
    EXPECT_NEAR(corner("photo.jpg"), 77, 1);
  }
}

TEST_F(Plates, ALookChangesThePicturesAndIsKeptWithThem) {
  folder.write("negative.cube", "LUT_1D_SIZE 2\n1 1 1\n0 0 0\n");
  const std::vector<std::string> frame{"flying.toml", "--frames", "0-0"};
  const auto with = [&](std::vector<std::string> more) {
    more.insert(more.begin(), frame.begin(), frame.end());
    render(more);
  };
  with({"--out", "plain"});
  with({"--lut", "negative.cube", "--out", "graded"});
  const render::Image plain = picture("plain/particles/0000.png"),
                      graded = picture("graded/particles/0000.png");
  ASSERT_EQ(plain.pixels.size(), graded.pixels.size());
  for (std::size_t i = 0; i < plain.pixels.size(); ++i) {
    const bool is_alpha = i % 4 == 3;
    ASSERT_EQ(is_alpha ? plain.pixels[i] : 255 - plain.pixels[i], graded.pixels[i]);
  }
  render({"graded/particles/0000.png", "--out", "again"});
  EXPECT_EQ(picture("again/particles/0000.png").pixels, graded.pixels);
  EXPECT_TRUE(contains(neve({"info", "graded/particles/0000.png"}).output, "negative.cube"));
  with({"--set", "shot.slate=true", "--out", "plain_slate"});
  with({"--set", "shot.slate=true", "--lut", "negative.cube", "--out", "slate"});
  EXPECT_GT(render::compare(picture("plain_slate/particles/-001.png"),
                            picture("slate/particles/-001.png"))
                .mean,
            100)
      << "a slate has the look of its film";
  folder.write("wrong.cube", "LUT_1D_SIZE 2\n");
  const auto refused = neve({"render", "flying.toml", "--lut", "wrong.cube", "--out", "wrong"});
  EXPECT_EQ(refused.exit_code, 3) << refused.errors;
  EXPECT_TRUE(contains(refused.errors, "wrong.cube:1")) << refused.errors;
}

TEST_F(Plates, WrongPlatesAndShuttersAreRefusedBeforeTheRun) {
  const auto refused = [&](std::vector<std::string> arguments, int code, const std::string& part) {
    arguments.insert(arguments.begin(), {"render", "flying.toml"});
    const auto result = neve(arguments);
    EXPECT_EQ(result.exit_code, code) << result.errors;
    EXPECT_TRUE(contains(result.errors, part)) << result.errors;
  };
  refused({"--shutter", "400"}, 2, "expected 0 (no motion blur) to 360");
  refused({"--plate", "street/%s.png"}, 2, "street/%04d.png");
  refused({"--plate", "nowhere.png"}, 6, "nowhere.png");
  const render::Image small{8, 8, 3, std::vector<std::uint8_t>(192)};
  app::output::write_file(folder / "small.png", render::encode_png(small));
  refused({"--plate", "small.png"}, 3, "the plate is 8x8 and the view particles is 160x90");
  refused({"--plate", "small.png"}, 3, "pictures are at least 16x16");
  EXPECT_FALSE(exists("out/flying/run.json"));
}

/// The plates of later frames were read when the pictures that they replace were gone.
TEST_F(Plates, AWrongPlateOfAnyFrameIsRefusedBeforeAnythingIsRemoved) {
  render({"flying.toml", "--out", "a", "--frames", "2"});
  const render::Image street{160, 90, 3, std::vector<std::uint8_t>(3 * 160 * 90, 200)};
  folder.write("street/0002.png", "no picture");
  for (const char* file : {"street/0000.png", "street/0001.png"})
    app::output::write_file(folder / file, render::encode_png(street));
  const std::vector<std::string> command{"render", "a", "--plate", "street/%04d.png", "--replace"};
  const std::string before = read_text(folder / "a/run.json");
  const auto refused = neve(command);
  EXPECT_EQ(refused.exit_code, 3) << refused.errors;
  EXPECT_TRUE(contains(refused.errors, "street/0002.png")) << refused.errors;
  EXPECT_EQ(read_text(folder / "a/run.json"), before);
  EXPECT_EQ(neve({"verify", "a"}).exit_code, 0);
}

/// Their names alone counted: pictures of the old look stayed, and were continued by the new one.
TEST_F(Plates, AnotherLookOrPlateInTheSameFileIsAnotherDrawing) {
  const auto plate = [&](const std::string& file, std::uint8_t grey) {
    const render::Image image{160, 90, 3, std::vector<std::uint8_t>(3 * 160 * 90, grey)};
    folder.write(file, "");
    app::output::write_file(folder / file, render::encode_png(image));
  };
  const auto look = [&](bool is_other) {
    folder.write("look.cube",
                 is_other ? "LUT_1D_SIZE 2\n1 1 1\n0 0 0\n" : "LUT_1D_SIZE 2\n0 0 0\n1 1 1\n");
  };
  look(false);
  for (const char* file : {"one.png", "street/0000.png", "street/0001.png"}) plate(file, 90);
  const std::vector<std::pair<std::string, std::string>> ways{
      {"--lut", "look.cube"}, {"--plate", "one.png"}, {"--plate", "street/%04d.png"}};
  for (std::size_t k = 0; k < ways.size(); ++k) {
    const std::string out = "of_" + std::to_string(k);
    render({"flying.toml", "--out", out, ways[k].first, ways[k].second});
    render({"flying.toml", "--out", out, ways[k].first, ways[k].second});
  }
  look(true);
  for (const char* file : {"one.png", "street/0001.png"}) plate(file, 200);
  for (std::size_t k = 0; k < ways.size(); ++k) {
    const std::string out = "of_" + std::to_string(k);
    const std::vector<std::string> words{"render",     "flying.toml",  "--out",
                                         out,          ways[k].first,  ways[k].second,
                                         "--no-movie", "--no-caption", "--quiet"};
    const std::string before = read_text(folder / (out + "/particles/0001.png"));
    const auto refused = neve(words);
    EXPECT_EQ(refused.exit_code, 2) << ways[k].second;
    EXPECT_TRUE(contains(refused.errors, "changed since")) << refused.errors;
    EXPECT_EQ(read_text(folder / (out + "/particles/0001.png")), before);
    auto resumed = words;
    resumed.insert(resumed.end(), {"--resume", "--frames", "2"});
    if (k < 2) {
      EXPECT_EQ(neve(resumed).exit_code, 2) << ways[k].second;
    }
    render({"flying.toml", "--out", out, ways[k].first, ways[k].second, "--replace"});
    EXPECT_NE(read_text(folder / (out + "/particles/0001.png")), before);
  }
}

}  // namespace
}  // namespace neve::test

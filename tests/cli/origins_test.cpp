/// Pictures that are put together from others say what they are.

#include "app/output/atomic_file.h"
#include "render/image/image.h"
#include "tests/cli/run_neve.h"

namespace neve::test {
namespace {

class Origins : public Cli {};

TEST_F(Origins, AContactSheetSaysWhatItIs) {
  ASSERT_EQ(neve({"sweep", "scene.toml", "-p", "material.snow.hardening=4,20", "--frames", "0-2",
                  "--out", "s.cdb", "--set", "light.intensity=1.5"})
                .exit_code,
            0);
  for (const char* sheet : {"s.cdb/sheet.png", "s.cdb/sheet/0002.png"}) {
    const auto info = neve({"info", sheet});
    EXPECT_EQ(info.exit_code, 0) << info.errors;
    for (const char* line :
         {"sheet       a contact sheet of 2 runs\n", "scene       scene.toml\n",
          "view        particles\n", "frame       2\n", "varies      material.snow.hardening\n",
          "override    light.intensity=1.5\n", "again       neve sweep collect s.cdb"})
      EXPECT_TRUE(contains(info.output, line)) << line << "is missing in\n" << info.output;
  }
  const auto strips = neve({"info", "s.cdb/strips.png", "--json"});
  EXPECT_TRUE(contains(strips.output, "\"a page of strips of 2 runs\"")) << strips.output;
  // It is no picture of a run, and that is said.
  const auto drawn = neve({"render", "s.cdb/sheet.png", "--out", "x"});
  EXPECT_EQ(drawn.exit_code, 3);
  EXPECT_TRUE(contains(drawn.errors,
                       "s.cdb/sheet.png: error: is a contact sheet of 2 runs, not one picture of a "
                       "run; name a picture of one of its runs"))
      << drawn.errors;
  EXPECT_FALSE(exists("x"));
}

TEST_F(Origins, AComparisonCarriesBothRuns) {
  for (const char* out : {"a", "b"})
    ASSERT_EQ(neve({"render", "scene.toml", "--out", out, "--set",
                    std::string("material.snow.hardening=") + (*out == 'a' ? "4" : "20"),
                    "--frames", "0-2", "--no-movie", "--quiet"})
                  .exit_code,
              0);
  ASSERT_EQ(neve({"compare", "a", "b", "--out", "c", "--movie", "none", "--quiet"}).exit_code, 0);
  const auto info = neve({"info", "c/beside/0002.png"});
  EXPECT_EQ(info.exit_code, 0) << info.errors;
  for (const char* part :
       {"picture     a comparison of two runs, beside\n", "A           a   hardening = 4\n",
        "B           b   hardening = 20\n", "frame       2\n",
        "again       neve compare a b --mode beside --frames 2-2 --out FILE.png\n", "\n# A\n",
        "\n# B\n", "hardening = 4\n", "hardening = 20\n"})
    EXPECT_TRUE(contains(info.output, part)) << part << "is missing in\n" << info.output;
  // All of them, and the words that it says make it again.
  for (const auto& file : std::filesystem::recursive_directory_iterator(folder / "c"))
    if (file.path().extension() == ".png") {
      EXPECT_EQ(neve({"info", file.path().string()}).exit_code, 0) << file.path();
    }
  ASSERT_EQ(neve({"compare", "a", "b", "--mode", "beside", "--frames", "2-2", "--out", "one.png",
                  "--quiet"})
                .exit_code,
            0);
  EXPECT_EQ(read_text(folder / "one.png"), read_text(folder / "c/beside/0002.png"));
  const auto json = neve({"info", "c/metrics.png", "--json"});
  const app::Json metrics = app::parse_json(std::string_view(json.output));
  EXPECT_EQ(metrics["sheet"], "a comparison of two runs, metrics");
  ASSERT_EQ(metrics["scenes"].size(), 2u);
  EXPECT_TRUE(contains(metrics["scenes"][1]["scene"].get<std::string>(), "hardening = 20"));
  const auto drawn = neve({"render", "one.png", "--out", "x"});
  EXPECT_EQ(drawn.exit_code, 3);
  EXPECT_TRUE(contains(drawn.errors,
                       "one.png: error: is a comparison of two runs, beside, not a "
                       "picture of a run; name one that neve render wrote"))
      << drawn.errors;
}

TEST_F(Origins, ASlateAndADifferenceCarryTheirScene) {
  const std::vector<std::string> words{"render",     "scene.toml", "--frames", "0-1",
                                       "--no-movie", "--quiet",    "--set",    "shot.slate=true"};
  auto render = [&](std::vector<std::string> more) {
    more.insert(more.begin(), words.begin(), words.end());
    return neve(more).exit_code;
  };
  ASSERT_EQ(render({"--out", "a"}), 0);
  const auto slate = neve({"info", "a/particles/-001.png"});
  EXPECT_EQ(slate.exit_code, 0) << slate.errors;
  for (const char* part :
       {"picture     a slate\n", "view        particles\n", "number      -1\n",
        "override    shot.slate=true\n", "again       neve render ", "\n# scene\n", "slate = true"})
    EXPECT_TRUE(contains(slate.output, part)) << part << "is missing in\n" << slate.output;
  EXPECT_EQ(neve({"verify", "a"}).exit_code, 0);
  EXPECT_EQ(
      render({"--out", "b", "--reference", "a/particles/0000.png", "--reference-threshold", "0"}),
      9);
  const auto difference = neve({"info", "b/difference.png"});
  EXPECT_EQ(difference.exit_code, 0) << difference.errors;
  for (const char* part : {"picture     the difference of a picture and its reference\n",
                           "reference   a/particles/0000.png\n", "\n# scene\n"})
    EXPECT_TRUE(contains(difference.output, part)) << part << "is missing in\n"
                                                   << difference.output;
}

TEST_F(Origins, APictureWhoseStateIsNotReachedAgainIsWarnedOf) {
  ASSERT_EQ(neve({"render", "scene.toml", "--out", "a", "--frames", "1-1", "--no-movie"}).exit_code,
            0);
  const auto again = [&] {
    return neve({"render", "a/particles/0001.png", "--out", "b", "--yes"});
  };
  EXPECT_FALSE(contains(again().errors, "has another state")) << again().errors;
  // The picture seems to be of a program whose steps were others.
  const std::vector<std::uint8_t> bytes = app::output::read_file(folder / "a/particles/0001.png");
  render::PngText text = render::read_png_text(bytes);
  text.at("neve:state_hash") = "0123456789abcdef";
  app::output::write_file(folder / "a/particles/0001.png",
                          render::encode_png(render::decode_png(bytes), text));
  std::filesystem::remove_all(folder / "b");
  const auto other = again();
  EXPECT_EQ(other.exit_code, 0) << other.errors;
  EXPECT_TRUE(contains(other.errors,
                       "frame 1 has another state than a/particles/0001.png shows: its bits came"))
      << other.errors;
  EXPECT_EQ(json_of("b/run.json")["warnings"].size(), 1u);
  // A picture made with another parameter is not warned of.
  const auto changed =
      neve({"render", "a/particles/0001.png", "--out", "c", "--set", "material.snow.hardening=3"});
  EXPECT_FALSE(contains(changed.errors, "has another state")) << changed.errors;
}

}  // namespace
}  // namespace neve::test

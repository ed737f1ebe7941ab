/// Movies as they are asked for: format, quality, rate.

#include "tests/cli/run_neve.h"
#include "tests/support/needs.h"

namespace neve::test {
namespace {

class MovieFlags : public Cli {
 protected:
  void SetUp() override {
    if (!app::output::find_program("ffmpeg")) SKIP_OR_FAIL("no ffmpeg in PATH (Debian: ffmpeg)");
  }
};

TEST_F(MovieFlags, AFinishedRunGetsAnotherMovieWithoutARun) {
  ASSERT_EQ(neve({"render", "scene.toml", "--out", "a", "--movie", "gif"}).exit_code, 0);
  EXPECT_TRUE(exists("a/particles.gif"));
  EXPECT_FALSE(exists("a/particles.mp4"));
  EXPECT_EQ(neve({"verify", "a"}).exit_code, 0);
  const app::Json before = json_of("a/run.json");
  const auto again = neve({"render", "scene.toml", "--out", "a", "--resume", "--movie", "webp",
                           "--movie-fps", "12", "--movie-quality", "60", "--json"});
  ASSERT_EQ(again.exit_code, 0) << again.errors;
  EXPECT_EQ(app::parse_json(std::string_view(again.output))["movies"],
            app::Json::array({"a/particles.webp"}));
  EXPECT_EQ(json_of("a/run.json")["frames"], before["frames"]) << "nothing was simulated again";
  // Another run removes what the one before made.
  ASSERT_EQ(neve({"render", "scene.toml", "--out", "a", "--movie", "none", "--set", "seed=2",
                  "--replace"})
                .exit_code,
            0);
  for (const char* movie : {"a/particles.gif", "a/particles.webp", "a/particles.mp4"})
    EXPECT_FALSE(exists(movie)) << movie;
}

/// A line that is seen on a movie and not in its pictures is told before the movie is made.
TEST_F(MovieFlags, ALineOfBlackBesideOddPicturesIsTold) {
  const auto odd = neve(
      {"render", "scene.toml", "--frames", "1", "--set", "output.size=[161, 90]", "--out", "a"});
  ASSERT_EQ(odd.exit_code, 0) << odd.errors;
  EXPECT_TRUE(contains(odd.errors,
                       "--movie: h264 has even sides: the movie of particles gets a line of black "
                       "and is 162x90; choose an even size, as 162x90, or --movie gif"))
      << odd.errors;
  const auto gif = neve({"render", "a", "--movie", "gif"});
  EXPECT_FALSE(contains(gif.errors, "even sides")) << gif.errors;
}

TEST_F(MovieFlags, ALongerFilmIsLongerInAllOfItsFormats) {
  ASSERT_EQ(
      neve({"render", "scene.toml", "--out", "a", "--movie", "gif", "--movie-fps", "12"}).exit_code,
      0);
  const app::Json styles = json_of("a/run.json")["movies"];
  const std::uintmax_t before = std::filesystem::file_size(folder / "a/particles.gif");
  const auto longer = neve({"render", "a", "--frames", "8"});
  ASSERT_EQ(longer.exit_code, 0) << longer.errors;
  EXPECT_GT(std::filesystem::file_size(folder / "a/particles.gif"), before * 5 / 4);
  EXPECT_TRUE(exists("a/particles.mp4"));
  EXPECT_EQ(json_of("a/run.json")["movies"]["particles.gif"], styles["particles.gif"]);
  EXPECT_EQ(neve({"verify", "a"}).exit_code, 0);
}

/// It was listed as whole.
TEST_F(MovieFlags, AFilmThatIsShorterThanItsPicturesIsToldUntilItIsMadeAgain) {
  ASSERT_EQ(
      neve({"render", "scene.toml", "--frames", "2", "--out", "a", "--movie", "gif"}).exit_code, 0);
  const std::string text = "a/particles.gif shows frames 0 to 2, and its view has others";
  for (const char* frames : {"4", "5"}) {
    const auto longer = neve({"render", "a", "--frames", frames, "--no-movie"});
    ASSERT_EQ(longer.exit_code, 0) << longer.errors;
    EXPECT_TRUE(contains(longer.errors, text)) << longer.errors;
    const auto verified = neve({"verify", "a"});
    EXPECT_EQ(verified.exit_code, 0);
    EXPECT_TRUE(contains(verified.output, text)) << verified.output;
  }
  const auto whole = neve({"render", "a", "--movie", "gif"});
  ASSERT_EQ(whole.exit_code, 0) << whole.errors;
  EXPECT_FALSE(contains(whole.errors, "its view has others")) << whole.errors;
  EXPECT_FALSE(contains(neve({"verify", "a"}).output, "its view has others"));
  ASSERT_EQ(
      neve({"render", "scene.toml", "--frames", "5", "--out", "b", "--movie", "gif"}).exit_code, 0);
  EXPECT_EQ(read_text(folder / "a/particles.gif"), read_text(folder / "b/particles.gif"));
}

/// The suffix and three digits of the rate were all that was known of a film.
TEST_F(MovieFlags, FormatAndRateOfAFilmAreThoseThatWereAskedFor) {
  const auto render = [&](std::vector<std::string> more) {
    more.insert(more.begin(), "render");
    return neve(more);
  };
  ASSERT_EQ(render({"scene.toml", "--out", "a"}).exit_code, 0);
  EXPECT_EQ(json_of("a/run.json")["movies"]["particles.mp4"],
            "quality 80, 24 frames per second, h264");
  for (const auto& [flag, value] : {std::pair{"--movie", "h265"}, {"--movie-fps", "23.976"}}) {
    const auto refused = render({"scene.toml", "--out", "a", flag, value});
    EXPECT_EQ(refused.exit_code, 2) << flag;
    EXPECT_TRUE(contains(refused.errors, "it would replace particles.mp4")) << refused.errors;
  }
  ASSERT_EQ(
      render({"scene.toml", "--out", "b", "--movie", "h265", "--movie-fps", "23.976"}).exit_code,
      0);
  const app::Json styles = json_of("b/run.json")["movies"];
  EXPECT_TRUE(contains(styles["particles.mp4"].get<std::string>(), "h265")) << styles;
  EXPECT_EQ(render({"b", "--frames", "6"}).exit_code, 0) << "it stays as it is, and is longer";
  EXPECT_EQ(json_of("b/run.json")["movies"], styles);
  EXPECT_EQ(render({"b", "--frames", "8", "--movie", "gif"}).exit_code, 0);
  EXPECT_EQ(json_of("b/run.json")["movies"]["particles.mp4"], styles["particles.mp4"]);
  // Texts of earlier builds are those of the same films.
  app::Json run = json_of("a/run.json");
  run["movies"]["particles.mp4"] = "quality 80, 24 frames per second";
  folder.write("a/run.json", run.dump());
  EXPECT_EQ(render({"a", "--movie", "h264"}).exit_code, 0);
  EXPECT_EQ(render({"a", "--movie", "h264", "--movie-fps", "12"}).exit_code, 2);
}

TEST_F(MovieFlags, SheetsAndComparisonsHaveThemToo) {
  const auto swept = neve({"sweep", "scene.toml", "-p", "seed=1,2", "--frames", "0-2", "--size",
                           "96x54", "--out", "s", "--movie", "gif"});
  ASSERT_EQ(swept.exit_code, 0) << swept.errors;
  EXPECT_TRUE(exists("s/sheet.gif"));
  EXPECT_FALSE(exists("s/sheet.mp4"));
  ASSERT_EQ(neve({"sweep", "collect", "s", "--movie", "webm"}).exit_code, 0);
  EXPECT_TRUE(exists("s/sheet.webm"));
  const auto compare = [&](std::vector<std::string> more) {
    std::vector<std::string> words{"compare", "s/runs/0000", "s/runs/0001"};
    words.insert(words.end(), more.begin(), more.end());
    return neve(words);
  };
  ASSERT_EQ(compare({"--out", "x.webp"}).exit_code, 0);
  EXPECT_EQ(read_text(folder / "x.webp").substr(8, 4), "WEBP");
  ASSERT_EQ(compare({"--out", "both", "--mode", "wipe", "--movie", "prores"}).exit_code, 0);
  EXPECT_TRUE(exists("both/wipe.mov"));
  const auto unfit = compare({"--out", "x.gif", "--movie", "h265"});
  EXPECT_EQ(unfit.exit_code, 2);
  EXPECT_TRUE(contains(unfit.errors, "--movie h265: does not fit x.gif")) << unfit.errors;
}

TEST_F(MovieFlags, WrongOnesAreToldBeforeAnythingIsDrawn) {
  const auto refused = [&](std::vector<std::string> flags, const std::string& part) {
    flags.insert(flags.begin(), {"render", "scene.toml"});
    const auto result = neve(flags);
    EXPECT_EQ(result.exit_code, 2) << part;
    EXPECT_TRUE(contains(result.errors, part)) << result.errors;
  };
  refused({"--movie", "av1"}, "there is no format \"av1\"; did you mean vp9?");
  refused({"--movie", "giff"}, "did you mean gif?");
  refused({"--movie-quality", "0"}, "expected a whole number from 1 to 100");
  refused({"--movie-fps", "fast"}, "expected 0.1 to 1000 frames a second");
  refused({"--movie", "gif", "--movie-fps", "100"}, "at most 50 frames a second");
  EXPECT_FALSE(exists("out"));
}

}  // namespace
}  // namespace neve::test

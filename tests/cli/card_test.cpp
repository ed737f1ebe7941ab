/// neve card: the picture and the numbers of a material.

#include "app/output/atomic_file.h"
#include "render/image/image.h"
#include "tests/cli/run_neve.h"

namespace neve::test {
namespace {

class CardCommand : public Cli {
 protected:
  void expect_refused(std::vector<std::string> arguments, const std::string& part) {
    arguments.insert(arguments.begin(), "card");
    const auto result = neve(arguments);
    EXPECT_EQ(result.exit_code, 2) << result.errors;
    EXPECT_NE(result.errors.find(part), std::string::npos) << result.errors;
  }
};

TEST_F(CardCommand, WritesAPictureAndNumbers) {
  const auto result = neve({"card", "--preset", "quick", "--set", "material.snow.model=cam_clay",
                            "--out", "made/snow.png", "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_EQ(read_text(folder / "made/snow.json"), result.output);
  const app::Json card = app::parse_json(std::string_view(result.output)).at("cards").at(0);
  EXPECT_EQ(card.at("title"), "quick");
  EXPECT_EQ(card.at("material").at("model"), "cam_clay");
  EXPECT_EQ(card.at("material").at("youngs_modulus"), 5e4);
  for (const char* experiment : {"press", "tear", "shear", "drop", "tilt", "column"}) {
    const app::Json& e = card.at(experiment);
    EXPECT_TRUE(e.at("failure").is_null()) << experiment;
    EXPECT_FALSE(e.at("words").empty()) << experiment;
    for (const auto& [name, curve] : e.at("curve").items())
      EXPECT_GT(curve.size(), 10u) << experiment << ", " << name;
  }
  const auto bytes = app::output::read_file(folder.path() / "made/snow.png");
  EXPECT_GT(render::decode_png(bytes).width, 1000);
  const auto info = neve({"info", "made/snow.png", "--json"});
  ASSERT_EQ(info.exit_code, 0) << info.errors;
  EXPECT_NE(info.output.find("model = \\\"cam_clay\\\""), std::string::npos) << info.output;
  // It is no picture of a run.
  const auto told = neve({"info", "made/snow.png"});
  EXPECT_TRUE(contains(told.output, "card        of ")) << told.output;
  EXPECT_TRUE(contains(told.output, "; neve card made/snow.png makes it again\n")) << told.output;
  EXPECT_FALSE(contains(told.output, "state hash")) << told.output;
  const auto drawn = neve({"render", "made/snow.png", "--out", "x"});
  EXPECT_EQ(drawn.exit_code, 2);
  EXPECT_TRUE(
      contains(drawn.errors, ", not a picture of a run; neve card made/snow.png makes it again"))
      << drawn.errors;
  EXPECT_FALSE(exists("x"));
}

TEST_F(CardCommand, AnotherCardIsReplacedOnlyWhenAskedFor) {
  const auto card = [&](std::vector<std::string> more) {
    std::vector<std::string> words{"card", "--preset", "quick", "--quiet"};
    words.insert(words.end(), more.begin(), more.end());
    return neve(words);
  };
  ASSERT_EQ(card({}).exit_code, 0);
  const std::string first = read_text(folder / "out/quick/card.png");
  const std::string numbers = read_text(folder / "out/quick/card.json");
  const auto other = card({"--set", "material.snow.hardening=6"});
  EXPECT_EQ(other.exit_code, 2);
  EXPECT_EQ(other.errors,
            "neve: error: there is a card of other scenes or settings; this one would replace "
            "out/quick/card.png and out/quick/card.json; add --replace, or name another file with "
            "--out\n");
  EXPECT_EQ(read_text(folder / "out/quick/card.png"), first);
  EXPECT_EQ(read_text(folder / "out/quick/card.json"), numbers);
  // A card that is made again loses nothing.
  EXPECT_EQ(card({}).exit_code, 0);
  EXPECT_EQ(read_text(folder / "out/quick/card.png"), first);
  ASSERT_EQ(card({"--set", "material.snow.hardening=6", "--replace"}).exit_code, 0);
  EXPECT_NE(read_text(folder / "out/quick/card.png"), first);
  // Nobody has named the file of numbers.
  folder.write("notes.json", "{}\n");
  const auto beside = card({"--out", "notes.png"});
  EXPECT_EQ(beside.exit_code, 2);
  EXPECT_TRUE(contains(beside.errors, "notes.json was not made by neve card; ")) << beside.errors;
  folder.write("out/quick/card.png", "mine");
  EXPECT_EQ(card({"--replace"}).exit_code, 2);
  EXPECT_EQ(read_text(folder / "out/quick/card.png"), "mine");
}

TEST_F(CardCommand, LeavesNoPictureWithoutItsNumbers) {
  // The numbers fit, the picture does not.
  const auto full = app::output::run_process(
      "/bin/bash",
      {"-c", "ulimit -f 200; exec '" NEVE_BINARY "' card --preset quick --out b/card.png -q"},
      folder.path());
  EXPECT_EQ(full.exit_code, 6) << full.errors;
  EXPECT_TRUE(contains(full.errors, "b/card.png: cannot write")) << full.errors;
  EXPECT_TRUE(std::filesystem::is_empty(folder / "b"));
}

TEST_F(CardCommand, AnswersMistakesBeforeItBegins) {
  expect_refused({"--preset", "wett"}, "did you mean wet?");
  expect_refused({"--preset", "wet", "--out", "card"}, "expected a file that ends in .png");
  expect_refused({"wet"}, "--preset wet");
  expect_refused({"--material", "ice"}, "there is no material \"ice\"");
}

}  // namespace
}  // namespace neve::test

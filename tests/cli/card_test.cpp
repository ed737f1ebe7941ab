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
}

TEST_F(CardCommand, AnswersMistakesBeforeItBegins) {
  expect_refused({"--preset", "wett"}, "did you mean wet?");
  expect_refused({"--preset", "wet", "--out", "card"}, "expected a file that ends in .png");
  expect_refused({"wet"}, "--preset wet");
  expect_refused({"--material", "ice"}, "there is no material \"ice\"");
}

}  // namespace
}  // namespace neve::test

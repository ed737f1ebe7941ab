/// Pictures that are put together from others say what they are.

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

TEST_F(Origins, ACardIsNoPictureOfARun) {
  ASSERT_EQ(neve({"card", "--preset", "wet", "--preset", "powder", "--out", "card.png", "--quiet"})
                .exit_code,
            0);
  const auto info = neve({"info", "card.png"});
  EXPECT_TRUE(contains(info.output, "card        of ")) << info.output;
  EXPECT_TRUE(contains(info.output, "; neve card card.png makes it again\n")) << info.output;
  EXPECT_FALSE(contains(info.output, "state hash")) << info.output;
  const auto drawn = neve({"render", "card.png", "--out", "x"});
  EXPECT_EQ(drawn.exit_code, 2);
  EXPECT_TRUE(contains(drawn.errors, ", not a picture of a run; neve card card.png makes it again"))
      << drawn.errors;
  EXPECT_FALSE(exists("x"));
}

}  // namespace
}  // namespace neve::test

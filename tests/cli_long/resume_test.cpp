/// A hundred kills at random instants, inside of writes too.

#include "tests/support/faulty_cli.h"

namespace neve::test {
namespace {

TEST_F(Cli, KilledAHundredTimesItEndsWithTheSameBits) {
  // Frames enough that the kills do not run out of them.
  std::string text(tiny_scene);
  text.replace(text.find("frames = 4"), 10, "frames = 60\nfps = 96");
  folder.write("scene.toml", text);
  ASSERT_EQ(neve({"render", "scene.toml", "--out", "whole"}).exit_code, 0);
  const int met = kill_and_resume(folder / "scene.toml", folder / "parts", 100, 0.4, 2);
  EXPECT_EQ(met, 100);
  ASSERT_EQ(neve({"render", "scene.toml", "--out", "parts", "--resume"}).exit_code, 0);
  const RunFiles a = files_of(folder / "whole"), b = files_of(folder / "parts");
  EXPECT_EQ(a.hashes, b.hashes);
  EXPECT_EQ(a.pictures, b.pictures);
}

TEST_F(FaultyCli, AfterTwoHundredPowerCutsItEndsWithTheSameBits) {
  EXPECT_EQ(cut_power(200, 2), 200);
}

}  // namespace
}  // namespace neve::test

/// Golden pictures. A change that is meant is made golden with the command of the test:
///   ./neve render scenes/snowball_drop.toml --frames 3-3 --size 320x180 --out /tmp/golden
///   cp /tmp/golden/particles/0003.png tests/golden/snowball_drop.png

#include "tests/cli/run_neve.h"

namespace neve::test {
namespace {

const std::string source = NEVE_SOURCE_DIR;

class Golden : public Cli {
 protected:
  app::ProcessResult render(const std::string& frame, const std::string& backend) {
    return neve({"render", source + "/scenes/snowball_drop.toml", "--frames", frame + "-" + frame,
                 "--size", "320x180", "--backend", backend, "--reference",
                 source + "/tests/golden/snowball_drop.png"});
  }
};

/// The default threshold, a mean of half a grey level, allows for another driver's rounding at the
/// edges of particles; with the same driver the pictures are equal.
TEST_F(Golden, SnowballDropLooksAsItDid) {
  for (const char* backend : {"egl", "osmesa"}) {
    const auto result = render("3", backend);
    EXPECT_EQ(result.exit_code, 0) << backend << ": " << result.errors;
  }
}

/// Negative control: the picture before it is not close enough.
TEST_F(Golden, AnotherFrameIsToldApart) {
  EXPECT_EQ(render("2", "auto").exit_code, 9);
}

}  // namespace
}  // namespace neve::test

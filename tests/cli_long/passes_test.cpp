/// neve render --passes, read by a program of compositors.

#include "tests/cli/run_neve.h"
#include "tests/support/needs.h"
#include "tests/support/python.h"

namespace neve::test {
namespace {

class PassesToOpenImageIo : public Cli {};

TEST_F(PassesToOpenImageIo, EveryChannelHasItsNameAndItsNumbers) {
  const auto python = python_with("OpenImageIO");
  if (!python) SKIP_OR_FAIL("no Python with OpenImageIO; install python3-openimageio");
  for (const char* quality : {"preview", "final"}) {
    const auto drawn = neve({"render", "scene.toml", "--view", "particles", "--view", "snow",
                             "--passes", "all,v,J_P,F_E", "--frames", "2-2", "--quality", quality,
                             "--no-movie", "--out", quality});
    ASSERT_EQ(drawn.exit_code, 0) << drawn.errors;
    for (const char* view : {"particles", "snow"}) {
      const auto same =
          run_script(*python, "check_openimageio.py",
                     {std::string(quality) + "/" + view + "/0002.exr"}, folder.path());
      EXPECT_EQ(same.output, "same 46\n") << view << same.errors;
    }
  }
}

}  // namespace
}  // namespace neve::test

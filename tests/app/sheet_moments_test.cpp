/// Moments of strips: those at which there is snow in a picture.

#include <gtest/gtest.h>

#include <filesystem>

#include "app/support/json.h"
#include "app/sweep/sheet/moments.h"
#include "tests/support/temporary_folder.h"

namespace neve::app::sweep {
namespace {

/// A camera that sees about a metre of ground around the origin, and half a metre above it.
const char* const looking_down = R"(
frames = 10
fps = 10
[[body]]
shape = { sphere = { center = [0, 3, 0], radius = 0.1 } }
[camera]
eye = [0, 0.25, 3]
target = [0, 0.25, 0]
fov = 20
)";

class SheetMoments : public testing::Test {
 protected:
  /// A run whose snow falls from 3 m by so many metres a frame.
  void add_run(double fall, const std::string& scene = looking_down, std::size_t particles = 9) {
    app::sweep::Run run;
    run.index = static_cast<int>(manifest_.runs.size());
    run.folder = std::to_string(run.index);
    run.frames = {0, 10};
    store::RunResult result;
    for (int frame = 0; frame <= 10; ++frame) {
      result.frames.push_back(frame);
      const double y = std::max(0.1, 3 - fall * frame);
      result.places.push_back({frame, frame / 10.0, particles, {0, y, 0}, 0.1, 0.2});
    }
    const auto folder = folder_.path() / "runs" / run.folder;
    std::filesystem::create_directories(folder);
    folder_.write("runs/" + run.folder + "/run.json", Json{{"scene", scene}}.dump());
    manifest_.runs.push_back(run);
    results_.push_back(result);
  }

  sheet::SnowInPictures snow() const { return {folder_.path(), manifest_, results_}; }

  test::TemporaryFolder folder_;
  store::Manifest manifest_;
  std::vector<store::RunResult> results_;
};

using Frames = std::vector<int>;

TEST_F(SheetMoments, StripsBeginWhenSnowComesIntoThePictureOfARun) {
  add_run(0.3);  // its middle is 0.9 m high at frame 7, its core at the edge, and 0.6 m at frame 8
  EXPECT_EQ(snow().moments(6), (Frames{8, 9, 10}));
  EXPECT_FALSE(snow().has_snow(0, 7));
  EXPECT_TRUE(snow().has_snow(0, 8));
  add_run(0.6);
  EXPECT_EQ(snow().moments(4), (Frames{4, 6, 8, 10}));
  EXPECT_FALSE(snow().has_snow(0, 4)) << "its tile says so";
  EXPECT_TRUE(snow().has_snow(1, 4));
}

TEST_F(SheetMoments, SnowThatAnEmitterHasNotMadeYetIsNotThere) {
  add_run(3, looking_down, 0);
  EXPECT_FALSE(snow().has_snow(0, 10));
  EXPECT_EQ(snow().moments(2), (Frames{0, 10})) << "all frames where none has snow";
}

TEST_F(SheetMoments, WhereTheCameraIsNotKnownAllFramesCount) {
  add_run(0.3,
          "frames = 10\n[[body]]\nshape = { sphere = { center = [0, 3, 0], radius = 0.1 } }\n");
  add_run(0.3, "no scene");
  EXPECT_EQ(snow().moments(3), (Frames{0, 5, 10}));
  EXPECT_TRUE(snow().has_snow(1, 0));
}

}  // namespace
}  // namespace neve::app::sweep

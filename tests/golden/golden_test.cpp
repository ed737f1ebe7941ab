/// Golden pictures: everything that can be drawn, as it was when a person approved it. The scene
/// is layers.toml, a view is a picture; remake makes them again.

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <map>

#include "app/output/atomic_file.h"
#include "render/image/image.h"
#include "sim/kernels/simd.h"
#include "tests/cli/run_neve.h"

namespace neve::test {
namespace {

namespace fs = std::filesystem;

const fs::path goldens = fs::path(NEVE_SOURCE_DIR) / "tests" / "golden";

/// Pictures of the driver that made them are equal, whatever the way of drawing particles. Half a
/// grey level on average, and 12 on the worst 8x8 pixels, is what other drivers may round at the
/// edges of particles and letters; the negative control below says that no two goldens are so near.
constexpr double mean_allowed = 0.5, local_allowed = 12;

bool is_near(const render::Difference& difference) {
  return difference.mean <= mean_allowed && difference.local <= local_allowed;
}

std::vector<std::string> names() {
  std::vector<std::string> names;
  for (const auto& file : fs::directory_iterator(goldens))
    if (file.path().extension() == ".png") names.push_back(file.path().stem().string());
  std::sort(names.begin(), names.end());
  return names;
}

render::Image read(const fs::path& file) {
  return render::decode_png(app::output::read_file(file));
}

/// Ways to draw a picture: OpenGL by a backend, particles by OpenGL or on the CPU.
struct Way {
  const char* backend;
  const char* particles;
};

class GoldenTest : public Cli, public testing::WithParamInterface<Way> {
 protected:
  /// Draws frame 3 of layers.toml into "out".
  void draw(const std::vector<std::string>& more) {
    const Way way = GetParam();
    if (!sim::kernels::is_available(sim::kernels::SimdLevel::baseline))
      GTEST_SKIP() << "built with NEVE_KERNEL_SETS=native";
    ::setenv("NEVE_SIMD", "baseline", 1);  // the same snow on every machine
    ::setenv("NEVE_PARTICLES", way.particles, 1);
    std::vector<std::string> arguments{"render",
                                       (goldens / "layers.toml").string(),
                                       "--frames",
                                       "3-3",
                                       "--out",
                                       "out",
                                       "--backend",
                                       way.backend,
                                       "--no-keep-states",
                                       "--checkpoint-every",
                                       "0"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const auto result = neve(arguments);
    ::unsetenv("NEVE_SIMD");
    ::unsetenv("NEVE_PARTICLES");
    ASSERT_EQ(result.exit_code, 0) << result.errors;
  }
  void expect_golden(const fs::path& picture_file, const fs::path& golden_file) const;
};

/// A failure leaves picture, golden and difference beside the tests' binaries.
fs::path keep(const std::string& way, const std::string& name, const render::Image& picture,
              const render::Image& golden) {
  const fs::path folder = fs::path(NEVE_BINARY).parent_path() / "golden" / way;
  fs::create_directories(folder);
  app::output::write_file(folder / (name + ".png"), render::encode_png(picture));
  app::output::write_file(folder / (name + "-golden.png"), render::encode_png(golden));
  app::output::write_file(folder / (name + "-difference.png"),
                          render::encode_png(render::difference_image(picture, golden)));
  return folder;
}

void GoldenTest::expect_golden(const fs::path& picture_file, const fs::path& golden_file) const {
  const std::string name = golden_file.stem().string();
  const render::Image picture = read(picture_file), golden = read(golden_file);
  const render::Difference difference = render::compare(picture, golden);
  if (is_near(difference)) return;
  const std::string way = std::string(GetParam().backend) + "-" + GetParam().particles;
  ADD_FAILURE() << name << ": mean " << difference.mean << ", local " << difference.local
                << ", max " << difference.max << "; see " << keep(way, name, picture, golden);
}

TEST_P(GoldenTest, EveryViewLooksAsItDid) {
  draw({});
  std::size_t views = 0;
  for (const auto& view : fs::directory_iterator(folder / "out")) {
    if (!view.is_directory()) continue;
    ++views;
    const std::string name = view.path().filename().string();
    const fs::path golden_file = goldens / (name + ".png");
    if (!fs::exists(golden_file)) {
      ADD_FAILURE() << name << " has no golden picture; see tests/golden/remake";
      continue;
    }
    expect_golden(view.path() / "0003.png", golden_file);
  }
  EXPECT_EQ(views, names().size()) << "a golden picture has no view";
}

/// Four samples a pixel, and motion blur.
TEST_P(GoldenTest, SnowAtFinalQualityLooksAsItDid) {
  draw({"--view", "snow", "--quality", "final"});
  expect_golden(folder / "out/snow/0003.png", goldens / "final/snow.png");
}

INSTANTIATE_TEST_SUITE_P(Ways, GoldenTest,
                         testing::Values(Way{"egl", "gl"}, Way{"egl", "cpu"}, Way{"osmesa", "cpu"}),
                         [](const auto& way) {
                           return std::string(way.param.backend) + "_" + way.param.particles;
                         });

/// Negative control: every golden is told apart from every other.
TEST(Golden, GoldenPicturesDifferFromEachOther) {
  std::map<std::string, render::Image> pictures;
  for (const std::string& name : names()) pictures[name] = read(goldens / (name + ".png"));
  ASSERT_GT(pictures.size(), 12u);
  for (const auto& [name, picture] : pictures)
    for (const auto& [other_name, other] : pictures) {
      if (name >= other_name) continue;
      if (picture.width != other.width || picture.height != other.height ||
          picture.channels != other.channels)
        continue;
      EXPECT_FALSE(is_near(render::compare(picture, other))) << name << " and " << other_name;
    }
}

}  // namespace
}  // namespace neve::test

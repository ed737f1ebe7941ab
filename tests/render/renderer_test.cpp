#include "render/renderer.h"

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "gl_test.h"
#include "render/frame/view.h"
#include "render/shapes/mesh_shapes.h"
#include "tests/support/temporary_folder.h"

namespace neve::render {
namespace {

Frame ball_over_ground() {
  Frame frame = small_frame(160, 120);
  frame.camera = {.eye = {0, 0.9f, 2.2f}, .target = {0, 0, 0}, .up = {0, 1, 0}, .fov = 40};
  frame.light.direction = {-0.7f, 0.7f, 0};
  frame.grounds.push_back({.point = {0, -0.3f, 0}, .line_spacing = 10});
  add_ball(frame, {0, 0, 0}, 0.2f, 0.03f);
  return frame;
}

Pixel at(const Image& image, const Frame& frame, Vec3f place) {
  const Vec3f p = make_view(frame.camera, frame.width, frame.height).project(place);
  return pixel(image, static_cast<int>(p.x), frame.height - 1 - static_cast<int>(p.y));
}

TEST(Renderer, SameFrameGivesTheSameBytes) {
  OPEN_OR_SKIP(context, "auto");
  const Frame frame = ball_over_ground();
  Renderer renderer(*context);
  const Image first = renderer.draw(frame);
  renderer.draw(small_frame(77, 41));  // another size in between
  EXPECT_EQ(renderer.draw(frame).pixels, first.pixels);
  ThreadPool pool(3);
  Renderer with_threads(*context, {}, &pool);
  EXPECT_EQ(with_threads.draw(frame).pixels, first.pixels);
}

/// Both ways through pixel buffers and at once bring the same bytes, in the order of the requests.
TEST(Renderer, PicturesComeBackInOrderEitherWay) {
  OPEN_OR_SKIP(context, "auto");
  Frame clear = ball_over_ground();
  clear.is_transparent = true;
  const std::vector<Frame> frames = {ball_over_ground(), small_frame(77, 41), clear};
  Renderer plain(*context);
  std::vector<Image> expected;
  for (const Frame& frame : frames) expected.push_back(plain.draw(frame));
  for (const ReadBackWay way : {ReadBackWay::buffered, ReadBackWay::at_once}) {
    Renderer renderer(*context, {}, nullptr, ParticlePath::automatic, way);
    EXPECT_THROW(renderer.fetch(), std::logic_error);
    for (int round = 0; round < 2; ++round) {  // the second fills the same buffers again
      for (const Frame& frame : frames) renderer.submit(frame);
      EXPECT_EQ(renderer.pending(), 3u);
      EXPECT_EQ(renderer.draw(frames[1]).pixels, expected[1].pixels) << "does not wait in line";
      for (const Image& image : expected) {
        const Image found = renderer.fetch();
        EXPECT_EQ(found.channels, image.channels);
        EXPECT_EQ(found.pixels, image.pixels);
      }
      EXPECT_EQ(renderer.pending(), 0u);
    }
  }
}

TEST(Renderer, CachesDoNotShowInThePicture) {
  OPEN_OR_SKIP(context, "auto");
  Renderer renderer(*context);
  Frame frame = ball_over_ground();
  renderer.draw(frame);
  Frame view = frame;
  view.camera.eye = {1, 0.5f, 1.5f};
  EXPECT_EQ(renderer.draw(view).pixels, Renderer(*context).draw(view).pixels);
  view.light.direction = {0.7f, 0.7f, 0};
  EXPECT_EQ(renderer.draw(view).pixels, Renderer(*context).draw(view).pixels);
}

TEST(Renderer, PhasesAreReportedInOrderWhenAskedFor) {
  OPEN_OR_SKIP(context, "auto");
  Renderer renderer(*context);
  const Frame frame = ball_over_ground();
  std::vector<PhaseTime> times = {{"left from before", 1}};
  EXPECT_EQ(renderer.draw(frame, &times).pixels, renderer.draw(frame).pixels);
  std::vector<std::string> phases;
  for (const PhaseTime& time : times) {
    phases.push_back(time.phase);
    EXPECT_GE(time.seconds, 0);
  }
  EXPECT_EQ(phases.front(), "light");
  EXPECT_EQ(phases.back(), "read_back");
  for (const char* phase : {"particles", "solids", "smoke", "shade", "overlay"})
    EXPECT_EQ(std::count(phases.begin(), phases.end(), phase), 1) << phase;
}

TEST(Renderer, EmptyFrameIsADarkGradient) {
  OPEN_OR_SKIP(context, "auto");
  Renderer renderer(*context);
  const Image image = renderer.draw(small_frame());
  EXPECT_EQ(image.width, 120);
  EXPECT_EQ(image.height, 90);
  EXPECT_EQ(image.channels, 3);
  ASSERT_EQ(image.pixels.size(), 3u * 120 * 90);
  EXPECT_GT(pixel(image, 60, 85).brightness(), pixel(image, 60, 4).brightness() + 20);
  EXPECT_LT(pixel(image, 60, 85).brightness(), 130);
}

TEST(GroundPass, ShadowOfSnowIsDarkerThanLitGround) {
  OPEN_OR_SKIP(context, "auto");
  Renderer renderer(*context);
  const Frame frame = ball_over_ground();
  const Image image = renderer.draw(frame);
  const int shadow = at(image, frame, {0.32f, -0.3f, 0}).brightness();
  const int lit = at(image, frame, {-0.45f, -0.3f, 0}).brightness();
  EXPECT_LT(shadow + 20, lit);
}

TEST(GroundPass, ShadowContinuesOutsideTheLightVolume) {
  OPEN_OR_SKIP(context, "auto");
  Renderer renderer(*context);
  Frame frame = ball_over_ground();
  frame.grounds[0].point.y = -0.8f;  // far below the box around the ball
  frame.camera.target = {0.4f, -0.4f, 0};
  const Image image = renderer.draw(frame);
  EXPECT_LT(at(image, frame, {0.8f, -0.8f, 0}).brightness() + 20,
            at(image, frame, {0.1f, -0.8f, 0.4f}).brightness());
}

TEST(GroundPass, PlaneSeenFromBehindIsNotDrawn) {
  OPEN_OR_SKIP(context, "auto");
  Renderer renderer(*context);
  Frame frame = small_frame();
  const Image nothing = renderer.draw(frame);
  frame.grounds.push_back({.point = {0, 0, 0}, .normal = {0, 0, -1}});
  EXPECT_EQ(renderer.draw(frame).pixels, nothing.pixels);
  frame.grounds[0].normal = {0, 0, 1};
  EXPECT_NE(renderer.draw(frame).pixels, nothing.pixels);
}

TEST(GroundPass, LinesAreDrawn) {
  OPEN_OR_SKIP(context, "auto");
  Renderer renderer(*context);
  Frame frame = small_frame();
  frame.grounds.push_back({.point = {0, 0, 0}, .normal = {0, 0, 1}, .line_spacing = 0.5f});
  const Image image = renderer.draw(frame);
  // A line through the middle, along y; plain ground a quarter of a spacing beside it.
  EXPECT_GT(pixel(image, 60, 30).brightness(), pixel(image, 48, 30).brightness() + 5);
}

TEST(MeshPass, MeshHidesWhatIsBehindAndIsHiddenByWhatIsInFront) {
  OPEN_OR_SKIP(context, "auto");
  Renderer renderer(*context);
  Frame frame = small_frame();
  frame.points.radius = 0.05f;
  frame.meshes.push_back(render::shapes::box_mesh({0, 0, 0}, {0.4f, 0.4f, 0.1f}));
  add_point(frame, {0.1f, 0, -0.3f});
  const int covered = pixel(renderer.draw(frame), 68, 45).brightness();
  frame.points.position.edit()[0] = {0.1f, 0, 0.3f};
  const int in_front = pixel(renderer.draw(frame), 70, 45).brightness();
  EXPECT_LT(covered, 190);
  EXPECT_GT(in_front, covered + 30);
}

TEST(MeshPass, MeshThrowsAShadowOnTheGround) {
  OPEN_OR_SKIP(context, "auto");
  Renderer renderer(*context);
  Frame frame = ball_over_ground();
  frame.points = {};
  frame.meshes.push_back(render::shapes::sphere_mesh({0, 0, 0}, 0.2f));
  const Image image = renderer.draw(frame);
  EXPECT_LT(at(image, frame, {0.32f, -0.3f, 0}).brightness() + 20,
            at(image, frame, {-0.45f, -0.3f, 0}).brightness());
}

TEST(Renderer, SupersamplingSmoothsEdgesAndKeepsThePicture) {
  OPEN_OR_SKIP(context, "auto");
  Renderer renderer(*context);
  Frame frame = small_frame();
  frame.points.radius = 0.3f;
  add_point(frame, {0, 0, 0});
  const Image plain = renderer.draw(frame);
  frame.supersampling = 2;
  const Image smooth = renderer.draw(frame);
  ASSERT_EQ(smooth.width, plain.width);
  EXPECT_LT(compare(plain, smooth).mean, 2);
  // Along a row through the edge: a value between background and sphere appears.
  const auto levels_between = [](const Image& image) {
    int between = 0;
    for (int y = 10; y < 80; ++y) {
      for (int x = 1; x + 1 < image.width; ++x) {
        const int a = pixel(image, x - 1, y).brightness(), b = pixel(image, x, y).brightness(),
                  c = pixel(image, x + 1, y).brightness();
        between += std::min(std::abs(a - b), std::abs(b - c)) > 15 && (a < b) == (b < c);
      }
    }
    return between;
  };
  EXPECT_GT(levels_between(smooth), levels_between(plain) + 20);
}

TEST(Renderer, RendererDrawsUpToItsLargestSideAndRefusesMore) {
  OPEN_OR_SKIP(context, "auto");
  Renderer renderer(*context);
  const int max = renderer.max_size();
  ASSERT_GE(max, 1024);
  for (const auto& [width, height] : {std::pair{max, 2}, {2, max}, {1, 1}}) {
    const Image image = renderer.draw(small_frame(width, height));
    EXPECT_EQ(image.width, width);
    EXPECT_EQ(image.height, height);
  }
  EXPECT_THROW(renderer.draw(small_frame(max + 1, 2)), std::invalid_argument);
  EXPECT_THROW(renderer.draw(small_frame(0, 2)), std::invalid_argument);
  Frame fine = small_frame(max, 2);
  fine.supersampling = 2;
  EXPECT_THROW(renderer.draw(fine), std::invalid_argument);
}

TEST(Renderer, InconsistentFramesAreRefused) {
  OPEN_OR_SKIP(context, "auto");
  Renderer renderer(*context);
  Frame frame = small_frame();
  frame.points.position.edit().resize(3);
  frame.points.value.edit().resize(2);
  EXPECT_THROW(renderer.draw(frame), std::invalid_argument);
  frame.points = {};
  frame.meshes.push_back(render::shapes::box_mesh({}, {1, 1, 1}));
  frame.meshes[0].index.edit().push_back(1000);
  EXPECT_THROW(renderer.draw(frame), std::invalid_argument);
}

TEST(Renderer, AnyCameraGivesAPicture) {
  OPEN_OR_SKIP(context, "auto");
  Renderer renderer(*context);
  Frame frame = ball_over_ground();
  frame.camera = {.eye = {0, 2, 0}, .target = {0, 0, 0}, .up = {0, 1, 0}, .fov = 30};
  const Image from_above = renderer.draw(frame);  // up is along the view: another one is taken
  EXPECT_GT(pixel(from_above, 90, 60).brightness(), 150);
  EXPECT_LT(pixel(from_above, 20, 60).brightness(), 130);
  frame.camera.target = frame.camera.eye;
  EXPECT_NO_THROW(renderer.draw(frame));
}

TEST(Renderer, SceneFarFromTheOriginLooksTheSame) {
  OPEN_OR_SKIP(context, "auto");
  Renderer renderer(*context);
  Frame frame = ball_over_ground();
  frame.grounds[0].line_spacing = 8;  // divides the shift: the same lines
  const Image here = renderer.draw(frame);
  const Vec3f shift{1024, 512, -2048};
  for (Vec3f& p : frame.points.position.edit()) p = p + shift;
  frame.grounds[0].point = frame.grounds[0].point + shift;
  frame.camera.eye = frame.camera.eye + shift;
  frame.camera.target = frame.camera.target + shift;
  // Floats are 0.1 mm apart there: a grain may move by a tenth of a pixel.
  EXPECT_LT(compare(here, renderer.draw(frame)).mean, 0.5);
}

TEST(Shaders, ShadersAreReadFromAFolderAndErrorsNameTheFile) {
  OPEN_OR_SKIP(context, "auto");
  namespace fs = std::filesystem;
  const test::TemporaryFolder temporary;
  const fs::path folder = temporary / "shaders";
  fs::copy(fs::path(NEVE_SOURCE_DIR) / "shaders", folder);
  EXPECT_NO_THROW(Renderer(*context, folder.string()).draw(small_frame()));
  std::ofstream(folder / "shade.frag", std::ios::app) << "nonsense here;\n";
  try {
    Renderer renderer(*context, folder.string());
    ADD_FAILURE() << "nonsense compiled";
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("shade.frag"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace neve::render

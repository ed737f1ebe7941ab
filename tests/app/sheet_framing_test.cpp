/// Cameras of contact sheets: the snow of the moment that is shown, large enough on every tile.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <utility>
#include <vector>

#include "app/output/read_picture.h"
#include "app/scene/toml/error.h"
#include "app/setup/camera_path.h"
#include "app/setup/coarse_run.h"
#include "app/setup/framing.h"
#include "app/sweep/plan/shared_view.h"
#include "app/sweep/plan/sweep_options.h"
#include "tests/cli/run_neve.h"
#include "tests/structure/sources.h"

namespace neve::app::sweep {
namespace {

namespace fs = std::filesystem;

/// Two balls that fall far; what is thrown out of the softer one flies wide.
class SheetFraming : public testing::Test {
 protected:
  /// @param more  at the end of the scene
  plan::SweepPlan framed(const std::string& sheet, const std::string& axis,
                         const std::string& more = "") {
    folder_.write("fall.toml", R"(
frames = 24
fps = 24
[solver]
cell_size = 0.04
[[body]]
name = "ball"
shape = { sphere = { center = [0, 1.6, 0], radius = 0.15 } }
[[collider]]
name = "floor"
shape = { plane = {} }
)" + more);
    plan::SweepOptions options;
    options.file = folder_.write("sweep.toml", "[sweep]\nscene = \"fall.toml\"\n[axis]\n" + axis +
                                                   "\n[sheet]\n" + sheet + "\n");
    options.out = folder_.path() / (std::to_string(++count_) + ".cdb");
    plan::SweepPlan plan = plan::plan_sweep(options);
    plan::share_camera_and_ranges(plan, 2);
    return plan;
  }

  static double distance(const scene::Scene& scene) {
    const setup::CameraPlace place =
        setup::camera_at(*scene.camera, scene::duration(scene), scene::duration(scene));
    return (place.eye - place.target).norm();
  }

 private:
  test::TemporaryFolder folder_;
  int count_ = 0;
};

const char* const two_densities = "\"material.snow.density\" = [300, 400]";

TEST_F(SheetFraming, ASheetIsOfItsMomentAndNotOfTheWholeFall) {
  const plan::SweepPlan moment = framed("", two_densities),
                        fall = framed("framing = \"fall\"", two_densities);
  EXPECT_LT(distance(moment.runs[0].scene), 0.7 * distance(fall.runs[0].scene));
  for (const plan::SweepPlan* plan : {&moment, &fall})
    EXPECT_EQ(plan->runs[0].scene.camera->eye, plan->runs[1].scene.camera->eye)
        << "tiles are compared";
}

TEST_F(SheetFraming, TheMomentIsTheLastFrameThatIsDrawn) {
  const plan::SweepPlan early = framed("", "frames = [4]"), late = framed("", "frames = [24]");
  EXPECT_GT(early.runs[0].scene.camera->target->y(), 1.2) << "the ball has hardly fallen";
  EXPECT_LT(late.runs[0].scene.camera->target->y(), 0.3);
}

TEST_F(SheetFraming, HandlesAreFramesToo) {
  const plan::SweepPlan whole = framed("", two_densities),
                        handled = framed("[set]\nframes = 8\nhandles = 8\n", two_densities);
  EXPECT_EQ(handled.runs[0].scene.camera->eye, whole.runs[0].scene.camera->eye);
}

TEST_F(SheetFraming, EachRunMayHaveACameraOfItsOwn) {
  const std::string places = "\"body.ball.shape.sphere.radius\" = [0.15, 0.45]";
  const plan::SweepPlan shared = framed("", places), each = framed("framing = \"each\"", places);
  EXPECT_EQ(distance(shared.runs[0].scene), distance(shared.runs[1].scene));
  EXPECT_LT(1.5 * distance(each.runs[0].scene), distance(each.runs[1].scene));
  EXPECT_LT(distance(each.runs[0].scene), distance(shared.runs[0].scene));
}

/// The narrowest heap has its quarter of the width even if another one is thrown far wider.
TEST_F(SheetFraming, SmallSnowIsNotLostBesideLargeSnow) {
  const plan::SweepPlan plan = framed("", "\"body.ball.shape.sphere.radius\" = [0.15, 0.4]");
  const scene::Scene& scene = plan.runs[0].scene;
  const std::vector<setup::CoarseMoment> moments = setup::coarse_run(scene);
  const sim::Vec3d towards_eye = (*scene.camera->eye - *scene.camera->target).normalized();
  const setup::Lens lens{scene.camera->up,
                         std::tan(setup::radians(scene.camera->fov / 2)),
                         1.0 * scene.size.width / scene.size.height,
                         1,
                         {0}};
  const setup::Extent seen =
      setup::extent_of(setup::without_outliers(moments.back().x, 0.02),
                       {{*scene.camera->target, distance(scene)}, towards_eye}, lens);
  EXPECT_GT(0.5 * (seen.right - seen.left), 0.17) << "coarse copies lie narrower than the snow";
}

TEST(MomentsNear, ThoseBeforeAndAfterEachTimeAreTaken) {
  std::vector<setup::CoarseMoment> moments;
  for (int k = 0; k <= 10; ++k) moments.push_back({0.1 * k, {}});
  const auto times = [&](const std::vector<double>& wanted) {
    std::vector<int> tenths;
    for (const setup::CoarseMoment& m : setup::moments_near(moments, wanted))
      tenths.push_back(static_cast<int>(std::lround(10 * m.time)));
    return tenths;
  };
  EXPECT_EQ(times({0.25}), (std::vector<int>{2, 3}));
  EXPECT_EQ(times({0.3, 0.31}), (std::vector<int>{3, 4}));
  EXPECT_EQ(times({1.04}), (std::vector<int>{10}));
  EXPECT_EQ(times({2}).size(), 11u) << "where the coarse run ends early, all that is known";
}

/// A rectangle of a sheet that is neither its paper nor dark, as tiles of ended runs are.
struct Tile {
  int x, y, width, height;
};

class Sheet {
 public:
  explicit Sheet(const fs::path& file) : image_(output::read_picture(file)) {}

  /// Columns of the width that most have, down to the next dark line: words on a dark ground are
  /// no part of a tile here.
  std::vector<Tile> tiles() const {
    std::map<int, int> widths;
    std::map<std::pair<int, int>, int> columns;
    for (int y = 0; y < image_.height; ++y)
      for (const auto& column : runs_of(y))
        if (column.second >= smallest_tile) ++widths[column.second], ++columns[column];
    const int width =
        std::ranges::max_element(widths, {}, [](const auto& w) { return w.second; })->first;
    std::vector<Tile> found;
    for (const auto& [column, rows] : columns) {
      if (column.second != width || rows < smallest_tile / 2) continue;
      int top = 0;
      for (int y = 0; y <= image_.height; ++y) {
        if (y < image_.height && !is_paper(column.first + 1, y)) continue;
        if (y - top >= smallest_tile / 2) found.push_back({column.first, top, width, y - top});
        top = y + 1;
      }
    }
    return found;
  }

  /// Returns the distance of the outermost columns with snow, as a share of the width of the tile.
  double snow_width(const Tile& tile) const {
    std::vector<int> columns;  // words are above
    for (int y = tile.y + tile.height / 5; y < tile.y + tile.height; ++y)
      for (int x = tile.x; x < tile.x + tile.width; ++x)
        if (is_snow(x, y)) columns.push_back(x);
    if (columns.empty()) return 0;
    std::sort(columns.begin(), columns.end());
    const std::size_t few = columns.size() / 100;
    return 1.0 * (columns[columns.size() - 1 - few] - columns[few]) / tile.width;
  }

 private:
  static constexpr int smallest_tile = 100;  // px

  const std::uint8_t* at(int x, int y) const {
    return image_.pixels.data() +
           (static_cast<std::size_t>(y) * static_cast<std::size_t>(image_.width) +
            static_cast<std::size_t>(x)) *
               static_cast<std::size_t>(image_.channels);
  }
  /// True for snow, which is blue in the shade too. Grounds are darker, colliders are grey.
  bool is_snow(int x, int y) const {
    const std::uint8_t* rgb = at(x, y);
    return rgb[2] > 150 && rgb[2] - rgb[0] >= 4;
  }
  bool is_paper(int x, int y) const {
    const std::uint8_t* rgb = at(x, y);
    return rgb[0] < 48 && rgb[1] < 51 && rgb[2] < 56;
  }
  /// Pixels side by side that are no paper: where they begin, and how many.
  std::vector<std::pair<int, int>> runs_of(int y) const {
    std::vector<std::pair<int, int>> runs;
    int begin = 0;
    for (int x = 0; x <= image_.width; ++x) {
      if (x < image_.width && !is_paper(x, y)) continue;
      if (x > begin) runs.push_back({begin, x - begin});
      begin = x + 1;
    }
    return runs;
  }

  render::Image image_;
};

TEST(ShippedSheets, EverySubjectTakesAQuarterOfTheWidthOfItsTile) {
  const fs::path docs = test::source_root() / "docs";
  const std::map<fs::path, std::size_t> sheets{
      {docs / "sweeps/dt_study.png", 17},          {docs / "sweeps/snow_variations.png", 6},
      {docs / "sweeps/cohesion_and_noise.png", 8}, {docs / "sweeps/other_ways.png", 6},
      {docs / "sweeps/transfer_study.png", 24},    {docs / "sweeps/refined.png", 6},
      {docs / "sweeps/refined_seeds.png", 4},      {docs / "gallery/roof_sheet.png", 12},
  };
  for (const auto& [file, count] : sheets) {
    const Sheet sheet(file);
    const std::vector<Tile> tiles = sheet.tiles();
    EXPECT_EQ(tiles.size(), count) << file;
    for (const Tile& tile : tiles)
      EXPECT_GE(sheet.snow_width(tile), 0.25) << file << ", tile at " << tile.x << ", " << tile.y;
  }
}

TEST_F(SheetFraming, RunsKeepTheTurnOfTheirOwnCamera) {
  const plan::SweepPlan plan = framed("", "\"camera.orbit\" = [0, 180]");
  EXPECT_EQ(plan.runs[0].scene.camera->orbit, 0);
  EXPECT_EQ(plan.runs[1].scene.camera->orbit, 180);
  EXPECT_EQ(plan.runs[0].scene.camera->eye, plan.runs[1].scene.camera->eye);
  const plan::SweepPlan near = framed("", "\"camera.push_in\" = [false, true]");
  EXPECT_TRUE(near.runs[0].scene.camera->keyframes.empty());
  EXPECT_FALSE(near.runs[1].scene.camera->keyframes.empty());
}

/// A second ball, far away.
const std::string two_balls = R"([[body]]
name = "other"
shape = { sphere = { center = [2, 1.6, 0], radius = 0.15 } }
)";

std::string with_view(const std::string& rest) {
  return "[[view]]\nname = \"main\"\n" + rest + "\n";
}

TEST_F(SheetFraming, AViewWithALensOfItsOwnHasOneCameraForAllRuns) {
  const std::string view = with_view("camera = { fov = 25 }");
  const std::string sizes = "\"body.ball.shape.sphere.radius\" = [0.15, 0.3]";
  const plan::SweepPlan plan = framed("", sizes, view);
  const auto camera = [](const plan::SweepPlan& of, std::size_t run) {
    return *of.runs[run].scene.views[0].camera;
  };
  EXPECT_EQ(camera(plan, 0).fov, 25);
  EXPECT_EQ(camera(plan, 0).eye, camera(plan, 1).eye);
  EXPECT_EQ(camera(plan, 0).target, camera(plan, 1).target);
  const plan::SweepPlan lenses = framed("", "\"view.main.camera.fov\" = [15, 40]", view);
  EXPECT_NE(camera(lenses, 0).eye, camera(lenses, 1).eye) << "each lens stands where it sees all";
}

TEST_F(SheetFraming, EachPlaneAndEachFollowedBodyIsSeenByACameraOfItsOwn) {
  const plan::SweepPlan planes = framed("", "\"view.main.slice.normal\" = [[0, 0, 1], [1, 0, 0]]",
                                        with_view("layers = [\"ground\", \"heatmap\"]"));
  for (const plan::PlannedRun& item : planes.runs) {
    const scene::View& view = item.scene.views[0];
    const sim::Vec3d towards_eye = (*view.camera->eye - *view.camera->target).normalized();
    EXPECT_GT(std::abs(towards_eye.dot(view.slice.normal)), 0.7) << "it is no sliver";
  }
  const plan::SweepPlan followed = framed("", "\"camera.follow\" = [\"ball\", \"other\"]",
                                          two_balls + "[camera]\nfollow = \"ball\"\n");
  EXPECT_EQ(followed.runs[1].scene.camera->follow, "other");
  EXPECT_NEAR(followed.runs[1].scene.camera->target->x(), 0, 0.3) << "relative to what it follows";
}

TEST_F(SheetFraming, AxesOfPlotsOfBodiesAreThoseOfAllRuns) {
  const plan::SweepPlan plan =
      framed("", "\"collider.stone.velocity\" = [[2, 0, 0], [8, 4, 0]]",
             "[[collider]]\nname = \"stone\"\ndensity = 900\n"
             "shape = { sphere = { center = [-0.8, 0.3, 0], radius = 0.1 } }\n" +
                 with_view("layers = [\"particles\", \"plots\"]"));
  for (const auto range : {&scene::PlotRanges::body_height, &scene::PlotRanges::body_speed}) {
    const std::optional<scene::Range>& first = plan.runs[0].scene.views[0].plots.*range;
    const std::optional<scene::Range>& second = plan.runs[1].scene.views[0].plots.*range;
    ASSERT_TRUE(first && second);
    EXPECT_EQ(first->max, second->max);
    EXPECT_EQ(first->min, second->min);
  }
}

/// A sheet has one legend, or each tile has its own.
TEST_F(SheetFraming, TilesHaveLegendsWhereOneWouldBeUntrue) {
  const std::string view = with_view(
      "layers = [\"ground\", \"heatmap\", \"legend\"]\n"
      "slice = { scalar = \"speed\", range_from = \"frame\" }");
  const plan::SweepPlan one = framed("", "\"body.ball.velocity\" = [[0, -1, 0], [0, -6, 0]]", view);
  EXPECT_FALSE(one.have_tiles_legends);
  for (const plan::PlannedRun& item : one.runs) {
    EXPECT_EQ(item.scene.views[0].slice.range_from, scene::RangeFrom::scene);
    EXPECT_FALSE(scene::has_layer(item.scene.views[0], scene::Layer::legend));
  }
  for (const std::string axis :
       {"\"view.main.slice.scalar\" = [\"speed\", \"density\"]",
        "\"view.main.slice.scalar_range\" = [[0, 1], [0, 9]]",
        "\"view.main.slice.scalar_colormap\" = [\"magma\", \"viridis\"]"}) {
    const plan::SweepPlan several = framed("", axis, view);
    EXPECT_TRUE(several.have_tiles_legends) << axis;
    for (const plan::PlannedRun& item : several.runs)
      EXPECT_TRUE(scene::has_layer(item.scene.views[0], scene::Layer::legend)) << axis;
  }
}

TEST_F(SheetFraming, NumbersOfFramesAreOfAllRuns) {
  EXPECT_THROW(framed("", "first_frame = [0, 1001]"), scene::toml::SceneError);
  EXPECT_THROW(framed("", "handles = [0, 4]"), scene::toml::SceneError);
}

/// A camera that a person has written into the look is used for tiles of any size, and never lost.
TEST(SharedLook, ACameraThatIsWrittenIntoItStays) {
  const test::TemporaryFolder folder;
  plan::SweepOptions options;
  options.file = folder
                     .write("still.toml",
                            "frames = 1\n[solver]\ncell_size = 0.1\ngravity = [0, 0, 0]\n"
                            "[[body]]\nshape = { sphere = { radius = 0.3 } }\n")
                     .string();
  options.axes = {"seed=1,2"};
  options.out = (folder / "s.cdb").string();
  const auto eye_after = [&](std::filesystem::path& aside) {
    plan::SweepPlan plan = plan::plan_sweep(options);
    aside = plan::share_camera_and_ranges(plan, 1);
    return plan.runs[1].scene.camera->eye.value();
  };
  const fs::path look = plan::shared_view_path(options.out);
  fs::path aside;
  const sim::Vec3d found = eye_after(aside);
  options.frames = setup::FrameRange{0, 0};
  eye_after(aside);
  EXPECT_TRUE(aside.empty()) << "nobody has written into it";
  std::string text = test::read_text(look);
  const std::size_t place = text.find("eye = [");
  ASSERT_NE(place, std::string::npos) << text;
  text.replace(place, text.find(']', place) + 1 - place, "eye = [0, 1, 7]");
  folder.write("s.cdb/look.toml", text);
  options.size = scene::PictureSize{320, 180};
  EXPECT_EQ(eye_after(aside), sim::Vec3d(0, 1, 7)) << "tiles of another size";
  EXPECT_TRUE(aside.empty());
  options.frames.reset();
  EXPECT_EQ(eye_after(aside), found);
  EXPECT_EQ(test::read_text(aside), text) << "it is kept";
}

}  // namespace
}  // namespace neve::app::sweep

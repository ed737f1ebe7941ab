/// Changes made while a simulation runs: kept, read back, and the scene that they make.

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "app/scene/flat.h"
#include "app/scene/read.h"
#include "app/support/errors.h"
#include "app/timeline/changes.h"
#include "tests/support/changed_run.h"

namespace neve::app {
namespace {

TEST(LiveChanges, ChangesSurviveJson) {
  const std::vector<app::scene::LiveChange> changes{{0, "solver.cfl", "0.2"},
                                                    {17, "collider.floor.contact", "\"sticky\""},
                                                    {17, "camera", "none"}};
  EXPECT_EQ(
      app::scene::live_changes(parse_json(std::string_view(to_text(app::scene::to_json(changes))))),
      changes);
  EXPECT_EQ(app::scene::text_of(changes[1]), "step 17: collider.floor.contact = \"sticky\"");
  EXPECT_TRUE(app::scene::live_changes(Json::array()).empty());
}

TEST(LiveChanges, InvalidChangesAreRefused) {
  for (const char* bad : {"{}", "[1]", "null", R"([{"step": 1, "address": "solver.cfl"}])",
                          R"([{"step": -1, "address": "solver.cfl", "value": "1"}])",
                          R"([{"step": 1.5, "address": "solver.cfl", "value": "1"}])",
                          R"([{"step": 1, "address": "solver.cell_size", "value": "1"}])",
                          R"([{"step": 1, "address": "nonsense", "value": "1"}])",
                          R"([{"step": 2, "address": "solver.cfl", "value": "1"},
            {"step": 1, "address": "solver.cfl", "value": "1"}])"})
    EXPECT_THROW(app::scene::live_changes(parse_json(std::string_view(bad))), std::runtime_error)
        << bad;
}

TEST(LiveChanges, OnlyTheFirstAndLastChangeOfAStepAndAddressAreKept) {
  std::vector<app::scene::LiveChange> changes;
  for (const char* value : {"1", "2", "3", "4"})
    app::scene::note_change(changes, {5, "light.ambient", value});
  app::scene::note_change(changes, {5, "solver.cfl", "0.2"});
  app::scene::note_change(changes, {6, "solver.cfl", "0.3"});
  const std::vector<app::scene::LiveChange> expected{{5, "light.ambient", "1"},
                                                     {5, "light.ambient", "4"},
                                                     {5, "solver.cfl", "0.2"},
                                                     {6, "solver.cfl", "0.3"}};
  EXPECT_EQ(changes, expected);
  app::scene::forget_changes_after(changes, 5);
  EXPECT_EQ(changes.size(), 3u);
}

TEST(LiveChanges, ChangesUpToAStepMakeItsScene) {
  const app::scene::Scene source = test::changed_scene("solver.cfl=0.1");
  const std::vector<app::scene::LiveChange> changes{{3, "solver.cfl", "0.2"},
                                                    {5, "solver.cfl", "0.3"},
                                                    {5, "camera.fov", "20"},
                                                    {9, "camera", "none"}};
  EXPECT_EQ(app::timeline::with_changes(source, changes, 2).solver.cfl, 0.1);
  EXPECT_EQ(app::timeline::with_changes(source, changes, 3).solver.cfl, 0.2);
  EXPECT_EQ(app::timeline::with_changes(source, changes, 8).solver.cfl, 0.3);
  EXPECT_EQ(app::timeline::with_changes(source, changes, 8).camera->fov, 20);
  EXPECT_FALSE(app::timeline::with_changes(source, changes).camera);
  try {
    app::timeline::with_changes(source, {{7, "solver.cfl", "-1"}});
    FAIL() << "a bad value was taken";
  } catch (const app::UsageError& error) {
    EXPECT_NE(std::string(error.what()).find("change at step 7: solver.cfl=-1"), std::string::npos)
        << error.what();
  }
}

TEST(LiveChanges, ARecordedSceneStartsAsTheRunAndLooksAsItDoesNow) {
  const app::scene::Scene from = test::changed_scene();
  app::scene::Scene now = test::changed_scene("view.snow.particles.color_by=speed");
  now.solver.cfl = 0.1;
  now.colliders[0].friction = 0.9;
  now.colliders[0].style = app::scene::ColliderStyle::wire;
  const app::scene::Scene recorded = app::timeline::recorded_scene(from, now);
  EXPECT_EQ(recorded.solver.cfl, from.solver.cfl);
  EXPECT_EQ(recorded.colliders[0].friction, from.colliders[0].friction);
  EXPECT_EQ(recorded.colliders[0].style, app::scene::ColliderStyle::wire);
  EXPECT_EQ(recorded.views[0].particles.color_by, app::scene::ColorBy::speed);
  for (const app::scene::Difference& difference : app::scene::differences(from, recorded))
    EXPECT_FALSE(app::scene::concerns_simulation(difference.address)) << difference.address;
}

}  // namespace
}  // namespace neve::app

/// The timeline of a sweep.

#include <gtest/gtest.h>

#include <filesystem>

#include "app/support/json.h"
#include "app/sweep/sheet/review.h"
#include "tests/support/temporary_folder.h"

namespace neve::test {
namespace {

using app::Json;

app::sweep::store::Manifest two_runs() {
  app::sweep::store::Manifest manifest;
  manifest.title = "Hardening";
  manifest.view = "snow";
  manifest.fps = 25;
  manifest.first_number = 1001;
  manifest.parameters = {{"material.snow.hardening", "hardening", "", "float"},
                         {"solver.transfer", "transfer", "", "choice"}};
  for (int k = 0; k < 2; ++k) {
    app::sweep::Run run;
    run.index = k;
    run.folder = k == 0 ? "0000" : "0001";
    run.settings = {{"material.snow.hardening", k == 0 ? "5" : "10"}, {"solver.transfer", "apic"}};
    run.frames = {1001, 1003};
    manifest.runs.push_back(run);
  }
  return manifest;
}

/// Structure as opentimelineio writes it; its own reader is asked by the long tests.
TEST(ReviewTimeline, HasAClipPerRunAndAMarkerPerValue) {
  std::vector<app::sweep::store::RunResult> results(2);
  results[0].frames = {1001, 1002, 1003};
  const Json timeline = app::parse_json(
      std::string_view(app::sweep::sheet::otio_timeline(two_runs(), results, false)));
  EXPECT_EQ(timeline["OTIO_SCHEMA"], "Timeline.1");
  const Json& track = timeline["tracks"]["children"][0];
  EXPECT_EQ(track["kind"], "Video");
  ASSERT_EQ(track["children"].size(), 1u) << "a run without pictures is no clip";
  const Json& clip = track["children"][0];
  EXPECT_EQ(clip["source_range"]["start_time"]["value"], 1001.0);
  EXPECT_EQ(clip["source_range"]["duration"]["value"], 3.0);
  EXPECT_EQ(clip["source_range"]["duration"]["rate"], 25.0);
  const Json& media = clip["media_reference"];
  EXPECT_EQ(media["target_url_base"], "runs/0000/snow/");
  EXPECT_EQ(media["start_frame"], 1001);
  EXPECT_EQ(media["frame_zero_padding"], 4);
  ASSERT_EQ(clip["markers"].size(), 2u);
  EXPECT_EQ(clip["markers"][0]["name"], "material.snow.hardening = 5");
  EXPECT_EQ(clip["markers"][0]["metadata"]["neve"]["value"], 5.0);
  EXPECT_EQ(clip["markers"][1]["metadata"]["neve"]["value"], "apic");
}

TEST(ReviewTimeline, NamesLinksWhereThereAreSome) {
  std::vector<app::sweep::store::RunResult> results(2);
  results[1].frames = {1001};
  const Json timeline = app::parse_json(
      std::string_view(app::sweep::sheet::otio_timeline(two_runs(), results, true)));
  const Json& media = timeline["tracks"]["children"][0]["children"][0]["media_reference"];
  EXPECT_EQ(media["target_url_base"], "review/");
  EXPECT_EQ(media["name_prefix"], "run_0001.");
  EXPECT_EQ(media["name_suffix"], ".png");
}

/// OTIO pads behind the sign: it looks for -0002.png where neve writes -002.png.
TEST(ReviewTimeline, NumbersBelowZeroAreThoseOfLinks) {
  std::vector<app::sweep::store::RunResult> results(2);
  results[0].frames = {-2, -1, 0, 1, 2};
  for (const bool has_links : {false, true}) {
    const Json timeline = app::parse_json(
        std::string_view(app::sweep::sheet::otio_timeline(two_runs(), results, has_links)));
    const Json& clip = timeline["tracks"]["children"][0]["children"][0];
    const int first = has_links ? -2 : 0;
    EXPECT_EQ(clip["media_reference"]["start_frame"], first);
    EXPECT_EQ(clip["source_range"]["start_time"]["value"], double(first));
    EXPECT_EQ(clip["source_range"]["duration"]["value"], double(3 - first));
  }
  const TemporaryFolder folder;
  app::sweep::sheet::link_pictures(folder.path(), two_runs(), results);
  EXPECT_TRUE(std::filesystem::is_symlink(folder.path() / "review/run_0000.-0002.png"));
  EXPECT_TRUE(std::filesystem::is_symlink(folder.path() / "review/run_0000.0002.png"));
}

TEST(ReviewTimeline, RunsThatDidNotEndHaveCostsAlone) {
  app::sweep::store::Manifest manifest = two_runs();
  std::vector<app::sweep::store::RunResult> results(2);
  for (app::sweep::store::RunResult& result : results) {
    result.frames = {1001, 1002};
    result.metrics.assign(app::sweep::store::metric_infos().size(), 3);
  }
  results[0].status.state = app::sweep::store::RunState::ok;
  results[1].status.state = app::sweep::store::RunState::interrupted;
  const Json timeline =
      app::parse_json(std::string_view(app::sweep::sheet::otio_timeline(manifest, results, false)));
  const Json& clips = timeline["tracks"]["children"][0]["children"];
  EXPECT_EQ(clips[0]["metadata"]["neve"]["metrics"]["spread"], 3.0);
  EXPECT_TRUE(clips[1]["metadata"]["neve"]["metrics"]["spread"].is_null());
  EXPECT_EQ(clips[1]["metadata"]["neve"]["metrics"]["steps"], 3.0);
}

TEST(ReviewTimeline, LinksAreNamedByTheNumberOfTheRun) {
  app::sweep::Run run;
  run.index = 2;
  run.folder = "0007";
  EXPECT_EQ(app::sweep::sheet::review_prefix(run), "run_0002.");
}

TEST(ReviewTimeline, RunsHaveTheirOwnRates) {
  app::sweep::store::Manifest manifest = two_runs();
  EXPECT_TRUE(manifest.has_one_rate());
  manifest.runs[1].settings.push_back({"fps", "23.976"});
  EXPECT_FALSE(manifest.has_one_rate());
  std::vector<app::sweep::store::RunResult> results(2);
  results[0].frames = results[1].frames = {1001, 1002};
  const Json timeline =
      app::parse_json(std::string_view(app::sweep::sheet::otio_timeline(manifest, results, false)));
  const Json& clips = timeline["tracks"]["children"][0]["children"];
  EXPECT_EQ(clips[0]["media_reference"]["rate"], 25.0);
  for (const char* key : {"source_range", "media_reference"}) {
    const Json& range = key[0] == 's' ? clips[1][key] : clips[1][key]["available_range"];
    EXPECT_EQ(range["duration"]["rate"], 24000 / 1001.0);
  }
  EXPECT_EQ(clips[1]["markers"][0]["marked_range"]["duration"]["rate"], 24000 / 1001.0);
}

}  // namespace
}  // namespace neve::test

/// `neve render` from the outside: what it makes, and what it leaves alone.

#include "app/output/atomic_file.h"
#include "render/image/image.h"
#include "tests/cli/run_neve.h"

namespace neve::test {
namespace {

TEST_F(Cli, WarningsOfDoubtfulResultsAreRecorded) {
  std::string text = tiny_scene;
  text.replace(text.find("0.12, 0]"), 8, "0.02, 0]");
  folder.write("sunk.toml", text);
  const auto sunk = neve({"render", "sunk.toml", "--frames", "0", "--out", "sunk"});
  EXPECT_EQ(sunk.exit_code, 0) << sunk.errors;
  EXPECT_TRUE(contains(sunk.errors, "starts inside collider floor")) << sunk.errors;
  const app::Json warnings = json_of("sunk/run.json")["warnings"];
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_TRUE(contains(warnings[0].get<std::string>(), "inside collider floor"));
  // c dt/h of more than 1.5, whatever comes of it.
  const auto fast = neve({"render", "scene.toml", "--frames", "1", "--out", "fast", "--set",
                          "solver.time_step=fixed", "--set", "solver.dt=2.5e-3"});
  const std::string kept = json_of("fast/run.json")["warnings"].dump();
  EXPECT_TRUE(contains(kept, "the acoustic CFL reached")) << kept << fast.errors;
  EXPECT_TRUE(contains(kept, "false, though no rule stops fixed steps for it; try")) << kept;
  // It waited for a retry that never comes.
  const auto retried = neve({"render", "scene.toml", "--frames", "1", "--out", "retried", "--set",
                             "solver.time_step=fixed", "--set", "solver.dt=2.5e-3", "--set",
                             "solver.on_divergence=retry"});
  EXPECT_TRUE(contains(retried.errors, "no rule stops or retries fixed steps for it"))
      << retried.errors;
  const auto again = neve({"render", "scene.toml", "--frames", "1", "--out", "fast", "--resume",
                           "--set", "solver.time_step=fixed", "--set", "solver.dt=2.5e-3"});
  EXPECT_EQ(again.exit_code, 0) << again.errors;  // it was complete
  EXPECT_EQ(json_of("fast/run.json")["warnings"].dump(), kept);
  ASSERT_EQ(neve({"render", "scene.toml", "--frames", "0", "--out", "good"}).exit_code, 0);
  EXPECT_TRUE(json_of("good/run.json")["warnings"].empty());
}

TEST_F(Cli, RenderMakesPicturesMovieAndRunJson) {
  const auto result = neve({"render", "scene.toml"});
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_EQ(result.output, "") << "stdout is for data";
  for (const char* file : {"0000.png", "0004.png"})
    EXPECT_TRUE(exists(std::string("out/scene/particles/") + file));
  EXPECT_FALSE(exists("out/scene/particles/0005.png"));
  EXPECT_EQ(exists("out/scene/particles.mp4"), app::output::find_program("ffmpeg").has_value());
  const app::Json run = json_of("out/scene/run.json");
  EXPECT_EQ(run["status"], "ok");
  ASSERT_EQ(run["frames"].size(), 5u);
  EXPECT_GT(run["frames"][4]["steps"], 0);
  EXPECT_NEAR(run["frames"][4]["time"].get<double>(), 4 / 24.0, 1e-12);
  EXPECT_EQ(run["frames"][4]["state_hash"].get<std::string>().size(), 16u);
}

/// Settings of --fast are changes like any other: run.json, the picture and its copy have them.
TEST_F(Cli, FastRunsSayWhatWasSetAndTheirPicturesMakeThemselvesAgain) {
  const auto result = neve({"render", "scene.toml", "--fast", "--frames", "2", "--out", "fast"});
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_TRUE(contains(result.errors, "--fast sets solver.acoustic_cfl=0.85")) << result.errors;
  const app::Json run = json_of("fast/run.json");
  EXPECT_EQ(run["overrides"][0], "solver.acoustic_cfl=0.85");
  const std::string picture = "fast/particles/0002.png";
  EXPECT_TRUE(contains(neve({"info", picture}).output, "solver.acoustic_cfl=0.85"));
  ASSERT_EQ(neve({"render", picture, "--out", "again"}).exit_code, 0);
  EXPECT_EQ(json_of("again/run.json")["frames"][0]["state_hash"], run["frames"][2]["state_hash"]);
  EXPECT_NE(run["frames"][2]["steps"],
            (neve({"render", "scene.toml", "--frames", "2", "--out", "slow"}),
             json_of("slow/run.json")["frames"][2]["steps"]));
  // The same command continues it.
  EXPECT_EQ(neve({"render", "scene.toml", "--fast", "--frames", "3", "--out", "fast", "--resume"})
                .exit_code,
            0);
  const app::Json check = app::parse_json(neve({"check", "scene.toml", "--json"}).output);
  EXPECT_EQ(check["fast"]["is_set"], false);
  EXPECT_EQ(check["fast"]["overrides"][0], "solver.acoustic_cfl=0.85");
  EXPECT_LT(check["fast"]["work"], 1);
}

TEST_F(Cli, RenderDrawsOnlyTheFramesAskedForFromTheSameSimulation) {
  ASSERT_EQ(neve({"render", "scene.toml", "--out", "all"}).exit_code, 0);
  ASSERT_EQ(neve({"render", "scene.toml", "--out", "one", "--frames", "3-3"}).exit_code, 0);
  EXPECT_FALSE(exists("one/particles/0002.png"));
  EXPECT_EQ(read_text(folder / "one/particles/0003.png"),
            read_text(folder / "all/particles/0003.png"));
}

TEST_F(Cli, ANewRunRemovesTheFramesOfTheOldOne) {
  ASSERT_EQ(neve({"render", "scene.toml"}).exit_code, 0);
  folder.write("out/scene/particles/mine.txt", "keep");
  ASSERT_EQ(
      neve({"render", "scene.toml", "--frames", "1", "--set", "seed=2", "--replace"}).exit_code, 0);
  EXPECT_TRUE(exists("out/scene/particles/0001.png"));
  EXPECT_FALSE(exists("out/scene/particles/0002.png"));
  EXPECT_TRUE(exists("out/scene/particles/mine.txt"));
}

TEST_F(Cli, AMosaicIsAFolderOfPicturesAndAMovieLikeAView) {
  folder.write("mosaic.toml", std::string(tiny_scene) +
                                  "[[view]]\nname = \"snow\"\n[[view]]\nname = \"speed\"\n"
                                  "particles = { color_by = \"speed\" }\n"
                                  "[[mosaic]]\nname = \"both\"\nviews = [\"snow\", \"speed\"]\n");
  const auto result = neve({"render", "mosaic.toml", "--frames", "2", "--out", "a"});
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  for (const char* file : {"a/snow/0002.png", "a/speed/0002.png", "a/both/0002.png"})
    EXPECT_TRUE(exists(file)) << file;
  EXPECT_EQ(exists("a/both.mp4"), app::output::find_program("ffmpeg").has_value());
  EXPECT_EQ(json_of("a/run.json")["views"], (app::Json{"particles", "snow", "speed", "both"}));

  // A picture drawn alone, and again from itself, has the same bytes.
  ASSERT_EQ(
      neve({"render", "mosaic.toml", "--view", "both", "--frames", "2-2", "--out", "b"}).exit_code,
      0);
  EXPECT_FALSE(exists("b/snow/0002.png"));
  const auto again = neve({"render", "b/both/0002.png"});
  ASSERT_EQ(again.exit_code, 0) << again.errors;
  EXPECT_EQ(read_text(folder / "b/both/0002.png"),
            read_text(folder / "out/0002-again/both/0002.png"));
}

TEST_F(Cli, AMosaicHasTheCaptionThatIsAskedForAndTheCounterOfItsViews) {
  folder.write("plain.toml", std::string(tiny_scene) +
                                 "[[view]]\nname = \"snow\"\nlayers = [\"particles\"]\n"
                                 "[[mosaic]]\nname = \"both\"\nviews = [\"snow\", \"snow\"]\n");
  const auto drawn = [&](std::vector<std::string> more, const std::string& out) {
    more.insert(more.begin(), {"render", "plain.toml", "--view", "both", "--frames", "0-0", "--out",
                               out, "--quiet"});
    EXPECT_EQ(neve(more).exit_code, 0);
    const auto image =
        render::decode_png(app::output::read_file(folder / (out + "/both/0000.png")));
    more.insert(more.end(), {"--dry-run", "--replace"});
    const std::string plan = neve(more).output;
    EXPECT_NE(plan.find("both, " + std::to_string(image.width) + "x" +
                        std::to_string(image.height) + "\n"),
              std::string::npos)
        << plan;
    EXPECT_EQ(plan.find("view  "), std::string::npos) << "tiles are no pictures of their own";
    return image;
  };
  const render::Image with = drawn({}, "a"), without = drawn({"--no-caption"}, "b"),
                      counted = drawn({"--no-caption", "--set",
                                       "view.snow.layers=[\"particles\", \"counter\"]"},
                                      "c");
  EXPECT_GT(with.height, without.height + 20) << "the strip";
  // Its views alone: nothing at their upper left corner, where their names were.
  EXPECT_EQ(without.pixels[3 * (10 * static_cast<std::size_t>(without.width) + 10)],
            without.pixels[3 * (10 * static_cast<std::size_t>(without.width) + 11)]);
  EXPECT_GT(render::compare(without, counted).local, 20);
}

TEST_F(Cli, AMosaicWithoutACaptionIsMadeAgainWithoutOne) {
  folder.write("both.toml",
               std::string(tiny_scene) + "[[mosaic]]\nname = \"both\"\nviews = [\"particles\"]\n");
  ASSERT_EQ(
      neve({"render", "both.toml", "--frames", "0-0", "--no-caption", "--out", "a"}).exit_code, 0);
  for (const std::string view : {"both", "particles"}) {
    const auto again = neve({"render", "a/" + view + "/0000.png", "--out", "b"});
    ASSERT_EQ(again.exit_code, 0) << again.errors;
    const auto pixels = [&](const std::string& run) {
      const std::string file = run + "/" + view + "/0000.png";
      return render::decode_png(app::output::read_file(folder / file)).pixels;
    };
    EXPECT_TRUE(pixels("a") == pixels("b")) << view;
  }
}

TEST_F(Cli, TransparentPicturesHaveAlphaAndTheirMovieHasNot) {
  const auto result =
      neve({"render", "scene.toml", "--frames", "2", "--set", "output.background=transparent"});
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  const std::string png = read_text(folder / "out/scene/particles/0002.png");
  ASSERT_GT(png.size(), 26u);
  EXPECT_EQ(png[25], 6) << "the colour type of RGBA";
  EXPECT_EQ(exists("out/scene/particles.mp4"), app::output::find_program("ffmpeg").has_value())
      << result.errors;
}

TEST_F(Cli, StatesDoNotDependOnViewsSizeQualityOrThreads) {
  ASSERT_EQ(neve({"render", "scene.toml", "--out", "a", "--threads", "1"}).exit_code, 0);
  folder.write("views.toml", std::string(tiny_scene) +
                                 "[[view]]\nname = \"x\"\n[[view]]\nname = \"y\"\n"
                                 "particles = { color_by = \"von_mises\" }\n");
  const auto other = neve({"render", "views.toml", "--out", "b", "--threads", "2", "--size",
                           "64x48", "--quality", "final"});
  ASSERT_EQ(other.exit_code, 0) << other.errors;
  EXPECT_TRUE(exists("b/x/0004.png"));
  EXPECT_TRUE(exists("b/y/0004.png"));
  const auto same = neve({"compare", "a", "b"});
  EXPECT_EQ(same.exit_code, 0) << same.output;
}

TEST_F(Cli, APictureMakesItselfAgain) {
  ASSERT_EQ(neve({"render", "scene.toml", "--set", "material.snow.hardening=5"}).exit_code, 0);
  const std::string picture = "out/scene/particles/0002.png";
  const auto again = neve({"render", picture});
  ASSERT_EQ(again.exit_code, 0) << again.errors;
  EXPECT_EQ(read_text(folder / picture), read_text(folder / "out/0002-again/particles/0002.png"));
  EXPECT_FALSE(exists("out/0002-again/particles/0001.png"));
}

TEST_F(Cli, InfoPrintsTheSceneOfAPicture) {
  ASSERT_EQ(neve({"render", "scene.toml", "--frames", "0", "--set", "material.snow.hardening=5"})
                .exit_code,
            0);
  const auto info = neve({"info", "out/scene/particles/0000.png", "--json"});
  ASSERT_EQ(info.exit_code, 0) << info.errors;
  const app::Json json = app::parse_json(std::string_view(info.output));
  for (const char* key :
       {"scene", "overrides", "changes", "seed", "version", "state_hash", "frame", "view", "files"})
    EXPECT_TRUE(json.contains(key)) << key;
  EXPECT_EQ(json["overrides"][0], "material.snow.hardening=5");
  EXPECT_TRUE(contains(json["scene"].get<std::string>(), "hardening = 5"));
  EXPECT_TRUE(contains(json["scene"].get<std::string>(), "eye = ")) << "the camera is resolved";
  EXPECT_EQ(neve({"info", "out/scene"}).exit_code, 0);
}

TEST_F(Cli, DraftsAreHalfAsLargeAndSizesApplyToAllViews) {
  ASSERT_EQ(
      neve({"render", "scene.toml", "--frames", "0", "--size", "320x180", "--quality", "draft"})
          .exit_code,
      0);
  const auto same = neve({"render", "scene.toml", "--frames", "0", "--size", "160x90", "--out",
                          "small", "--reference", "out/scene/particles/0000.png"});
  EXPECT_EQ(same.exit_code, 0) << same.errors;
}

TEST_F(Cli, DryRunPrintsThePlanAndMakesNothing) {
  const auto result = neve({"render", "scene.toml", "--dry-run", "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  const app::Json plan = app::parse_json(std::string_view(result.output));
  EXPECT_GT(plan["particles"], 100);
  EXPECT_GT(plan["memory_bytes"], 0);
  EXPECT_FALSE(exists("out"));
}

TEST_F(Cli, CoarsenedRunsAreSmallerAndTheirPicturesMakeThemselvesAgain) {
  const auto coarse =
      neve({"render", "scene.toml", "--coarsen", "1.5", "--set", "solver.cell_size=0.03"});
  ASSERT_EQ(coarse.exit_code, 0) << coarse.errors;
  EXPECT_TRUE(contains(coarse.errors, "coarsened 1.5x")) << coarse.errors;
  ASSERT_EQ(
      neve({"render", "scene.toml", "--out", "full", "--set", "solver.cell_size=0.03"}).exit_code,
      0);
  const app::Json run = json_of("out/scene/run.json"), full = json_of("full/run.json");
  EXPECT_EQ(run["coarsen"], 1.5);
  EXPECT_EQ(full["coarsen"], 1);
  EXPECT_TRUE(contains(run["scene"].get<std::string>(), "cell_size = 0.045"));
  EXPECT_LT(run["frames"][0]["particles"].get<int>(),
            full["frames"][0]["particles"].get<int>() / 2);
  const std::string picture = "out/scene/particles/0002.png";
  ASSERT_EQ(neve({"render", picture}).exit_code, 0);
  EXPECT_EQ(read_text(folder / picture), read_text(folder / "out/0002-again/particles/0002.png"));
  const auto info = neve({"info", picture, "--json"});
  EXPECT_EQ(app::parse_json(std::string_view(info.output))["coarsen"], 1.5);
  // A picture can be coarsened further.
  ASSERT_EQ(neve({"render", picture, "--coarsen", "2", "--replace"}).exit_code, 0);
  EXPECT_EQ(json_of("out/0002-again/run.json")["coarsen"], 3);
}

TEST_F(Cli, DryRunShowsTheEffectOfCoarsening) {
  const auto plan = [&](const char* factor) {
    const auto result = neve({"render", "scene.toml", "--dry-run", "--json", "--coarsen", factor});
    return app::parse_json(std::string_view(result.output));
  };
  EXPECT_EQ(plan("2")["cell_size"], 0.08);
  EXPECT_EQ(plan("2")["coarsen"], 2);
  EXPECT_NEAR(plan("1")["particles"].get<double>() / plan("2")["particles"].get<double>(), 8, 0.3);
  EXPECT_TRUE(contains(neve({"render", "scene.toml", "--dry-run", "--coarsen", "2"}).output,
                       "0.08 m, coarsened 2x"));
}

TEST_F(Cli, QuietRunsPrintNothing) {
  const auto result = neve({"render", "scene.toml", "--quiet", "--frames", "0"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_EQ(result.errors + result.output, "");
}

TEST_F(Cli, ADecimalCommaInTheLocaleChangesNothing) {
  ASSERT_EQ(neve({"render", "scene.toml", "--frames", "0", "--out", "a"}).exit_code, 0);
  ::setenv("LC_ALL", "de_DE.UTF-8", 1);
  const auto result = neve({"render", "scene.toml", "--frames", "0", "--out", "b"});
  ::unsetenv("LC_ALL");
  ASSERT_EQ(result.exit_code, 0);
  EXPECT_EQ(read_text(folder / "a/particles/0000.png"), read_text(folder / "b/particles/0000.png"));
}

TEST_F(Cli, DoctorAndParamsAreJson) {
  const auto doctor = neve({"doctor", "--json"});
  EXPECT_EQ(doctor.exit_code, 0) << doctor.output;
  const app::Json report = app::parse_json(std::string_view(doctor.output));
  ASSERT_GE(report["backends"].size(), 3u);
  for (const char* key : {"name", "available", "version", "renderer", "software", "reason"})
    EXPECT_TRUE(report["backends"][0].contains(key)) << key;
  EXPECT_TRUE(report["physics"].is_array());
  const auto params = neve({"params", "--json"});
  EXPECT_EQ(params.exit_code, 0);
  EXPECT_GT(app::parse_json(std::string_view(params.output)).size(), 20u);
}

/// With four threads and more the next frame is simulated while one is drawn.
TEST_F(Cli, DrawingBesideTheSimulationChangesNoBit) {
  for (const char* threads : {"1", "4"})
    ASSERT_EQ(neve({"render", "scene.toml", "--threads", threads, "--out", threads,
                    "--checkpoint-every", "3"})
                  .exit_code,
              0);
  const auto read = [&](const char* threads, int frame) {
    return app::output::read_file(
        folder / (std::string(threads) + "/particles/000" + std::to_string(frame) + ".png"));
  };
  const app::Json one = json_of("1/run.json"), four = json_of("4/run.json");
  ASSERT_EQ(one["frames"].size(), 5u);
  for (int frame = 0; frame <= 4; ++frame) {
    EXPECT_EQ(read("1", frame), read("4", frame)) << frame;
    const auto k = static_cast<std::size_t>(frame);
    for (const char* key : {"state_hash", "steps", "dt_min", "kinetic_energy"})
      EXPECT_EQ(one["frames"][k][key], four["frames"][k][key]) << key << " of frame " << frame;
  }
}

TEST_F(Cli, ATitleThatTheFontLacksIsSaidOnce) {
  const auto said = [&](const std::string& title) {
    const auto result = neve({"render", "scene.toml", "--frames", "0-1", "--no-movie", "--out",
                              "titled", "--replace", "--set", "title=\"" + title + "\""});
    EXPECT_EQ(result.exit_code, 0) << result.errors;
    return result.errors;
  };
  const std::string japanese = said("雪 névé 雪");
  const std::size_t first = japanese.find("lacks 雪:");
  EXPECT_NE(first, std::string::npos) << japanese;
  EXPECT_EQ(japanese.find("lacks", first + 1), std::string::npos) << japanese;
  EXPECT_FALSE(contains(said("снег névé"), "lacks"));
}

}  // namespace
}  // namespace neve::test

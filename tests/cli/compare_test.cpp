/// Two runs against each other as pictures, movies and numbers.

#include <fmt/core.h>

#include <cmath>

#include "app/compare/series.h"
#include "app/output/atomic_file.h"
#include "render/image/image.h"
#include "tests/cli/run_neve.h"

namespace neve::test {
namespace {

class Compare : public Cli {
 protected:
  void render(const char* out, const std::vector<std::string>& more = {}) {
    std::vector<std::string> words{"render", "scene.toml", "--out", out, "--quiet", "--no-movie"};
    words.insert(words.end(), more.begin(), more.end());
    const auto done = neve(words);
    ASSERT_EQ(done.exit_code, 0) << done.errors;
  }

  /// Both runs in out folders a and b, which differ in the speed of a ball that rises.
  void render_both() {
    ASSERT_NO_FATAL_FAILURE(render("a", {"--set", "body.ball.velocity=[0, 1, 0]"}));
    ASSERT_NO_FATAL_FAILURE(render("b", {"--set", "body.ball.velocity=[0, 1.5, 0]"}));
  }

  app::output::ProcessResult compare(const char* a, const char* b,
                                     const std::vector<std::string>& more) {
    std::vector<std::string> words{"compare", a, b};
    words.insert(words.end(), more.begin(), more.end());
    return neve(words);
  }

  render::Image picture(const std::string& file) {
    return render::decode_png(app::output::read_file(folder / file));
  }

  std::string hash_of(const char* run, std::size_t frame) {
    return json_of(run + std::string("/run.json"))["frames"][frame]["state_hash"];
  }
};

/// Pixels of a picture that are clearly red or blue.
struct Tint {
  std::size_t red = 0, blue = 0;
};
Tint tint_of(const render::Image& image) {
  Tint tint;
  const auto channels = static_cast<std::size_t>(image.channels);
  for (std::size_t k = 0; k < image.pixels.size(); k += channels) {
    const int red = image.pixels[k], blue = image.pixels[k + 2];
    if (red > blue + 30) ++tint.red;
    if (blue > red + 30) ++tint.blue;
  }
  return tint;
}

TEST_F(Compare, AFolderGetsEveryModeOfEveryFrameAndTheNumbers) {
  ASSERT_NO_FATAL_FAILURE(render_both());
  const auto done = compare("a", "b", {"--out", "both", "--json"});
  ASSERT_EQ(done.exit_code, 0) << done.errors;
  for (const char* mode : {"beside", "wipe", "displacement", "mass"})
    for (const char* frame : {"0000", "0002", "0004"})
      EXPECT_TRUE(exists(std::string("both/") + mode + "/" + frame + ".png")) << mode;
  EXPECT_TRUE(exists("both/metrics.png"));
  const app::Json json = app::parse_json(std::string_view(done.output));
  EXPECT_EQ(json["differing"], app::Json::array({"body.ball.velocity"}));
  ASSERT_EQ(json["frames"].size(), 5u);
  // One ball is half a metre a second faster: in flight the particles part at that speed.
  const app::Json& first = json["frames"][1];
  EXPECT_NEAR(first["displacement_mean"].get<double>(), 0.5 / 24, 1e-3);
  EXPECT_EQ(json["frames"][0]["displacement_largest"], 0.0);
  EXPECT_EQ(first["particles_only_a"], 0.0);
  EXPECT_GT(first["mass_more_a"].get<double>(), 0.0);
  EXPECT_NEAR(first["mass_more_a"].get<double>(), first["mass_more_b"].get<double>(),
              0.05 * first["mass_more_a"].get<double>());
  const app::Json run = json_of("a/run.json");
  EXPECT_NEAR(json["frames"][4]["spread_a"].get<double>(), run["frames"][4]["spread"].get<double>(),
              1e-12);
  const std::string csv = read_text(folder / "both/metrics.csv");
  EXPECT_TRUE(csv.starts_with("frame,time,spread_a,spread_b,")) << csv.substr(0, 80);
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 6);
}

TEST_F(Compare, PicturesAreDrawnWithOneCamera) {
  ASSERT_NO_FATAL_FAILURE(render("a"));
  ASSERT_NO_FATAL_FAILURE(
      render("other", {"--set", "camera.eye=[3, 2, 1]", "--set", "camera.target=[0, 0.1, 0]"}));
  // The same snow: with one camera and light both halves are equal.
  ASSERT_EQ(compare("a", "other", {"--out", "x.png"}).exit_code, 0);
  const render::Image beside = picture("x.png");
  const int half = (beside.width - 4) / 2;
  EXPECT_EQ(half, 160);
  int different = 0;
  for (int y = 60; y < beside.height - 40; ++y)
    for (int x = 0; x < half; ++x)
      for (int c = 0; c < 3; ++c) {
        const auto at = [&](int column) {
          return beside.pixels[static_cast<std::size_t>((y * beside.width + column) * 3 + c)];
        };
        different += at(x) != at(x + half + 4);
      }
  EXPECT_EQ(different, 0);
}

TEST_F(Compare, MassDifferenceIsRedWhereBHasMoreAndBlueWhereAHas) {
  ASSERT_NO_FATAL_FAILURE(render("a"));
  ASSERT_NO_FATAL_FAILURE(render("aside", {"--set", "body.ball.velocity=[1, -2, 0]"}));
  ASSERT_EQ(compare("a", "aside", {"--out", "x.png", "--mode", "mass"}).exit_code, 0);
  const Tint both = tint_of(picture("x.png"));
  EXPECT_GT(both.red, 50u);
  EXPECT_GT(both.blue, 50u);
  ASSERT_EQ(compare("a", "a", {"--out", "y.png", "--mode", "mass"}).exit_code, 0);
  const Tint none = tint_of(picture("y.png"));
  EXPECT_EQ(none.red, 0u);
  EXPECT_EQ(none.blue, 0u);
}

TEST_F(Compare, WipeShowsAOnTheLeftAndBOnTheRight) {
  ASSERT_NO_FATAL_FAILURE(render_both());
  const auto wipe = [&](const char* share, const char* out) {
    ASSERT_EQ(compare("a", "b", {"--out", out, "--mode", "wipe", "--wipe", share}).exit_code, 0);
  };
  wipe("1", "only_a.png");
  wipe("0", "only_b.png");
  wipe("0.5", "half.png");
  const render::Image a = picture("only_a.png"), b = picture("only_b.png"),
                      half = picture("half.png");
  ASSERT_EQ(half.pixels.size(), a.pixels.size());
  int wrong = 0;
  for (int y = 60; y < half.height - 40; ++y)
    for (int x = 0; x < half.width; ++x) {
      const auto k = static_cast<std::size_t>((y * half.width + x) * 3);
      if (x > 3 && x < 76) wrong += half.pixels[k] != a.pixels[k];
      if (x > 84 && x < 156) wrong += half.pixels[k] != b.pixels[k];
    }
  EXPECT_EQ(wrong, 0);
}

/// They have one legend, which cannot be that of two frames.
TEST_F(Compare, BothRunsAreColouredByTheRangeOfTheScene) {
  for (const std::string from : {"scene", "frame"}) {
    folder.write("scene.toml", std::string(tiny_scene) +
                                   "[[view]]\nname = \"cut\"\nlayers = [\"heatmap\", \"legend\"]\n"
                                   "slice = { scalar = \"speed\", range_from = \"" +
                                   from + "\" }\n");
    ASSERT_NO_FATAL_FAILURE(render("a", {"--view", "cut", "--frames", "1", "--replace"}));
    ASSERT_NO_FATAL_FAILURE(render("b", {"--view", "cut", "--frames", "1", "--replace", "--set",
                                         "body.ball.velocity=[0, -6, 0]"}));
    const auto done =
        compare("a", "b", {"--out", (from + ".png").c_str(), "--mode", "wipe", "--view", "cut"});
    ASSERT_EQ(done.exit_code, 0) << done.errors;
  }
  EXPECT_EQ(picture("scene.png").pixels, picture("frame.png").pixels);
}

TEST_F(Compare, PicturesAreMadeAgainFromTheirScenes) {
  ASSERT_NO_FATAL_FAILURE(render_both());
  const auto done =
      compare("a/particles/0003.png", "b", {"--out", "x.png", "--mode", "displacement", "--json"});
  ASSERT_EQ(done.exit_code, 0) << done.errors;
  const app::Json json = app::parse_json(std::string_view(done.output));
  ASSERT_EQ(json["frames"].size(), 1u);
  EXPECT_EQ(json["frames"][0]["frame"], 3);
  // No warning of another state: both are what the runs list.
  EXPECT_FALSE(contains(done.errors, "has another state")) << done.errors;
  const auto metrics = compare("a/particles/0003.png", "b", {"--out", "y.csv"});
  EXPECT_EQ(metrics.exit_code, 2);
  EXPECT_TRUE(contains(metrics.errors, "a picture has no metrics over time")) << metrics.errors;
}

TEST_F(Compare, AMovieAndATableAreSingleFiles) {
  ASSERT_NO_FATAL_FAILURE(render_both());
  ASSERT_EQ(compare("a", "b", {"--out", "table.csv"}).exit_code, 0);
  EXPECT_TRUE(contains(read_text(folder / "table.csv"), "kinetic_energy_a"));
  if (!app::output::find_program("ffmpeg")) GTEST_SKIP() << "no ffmpeg";
  const auto movie = compare("a", "b", {"--out", "x.mp4", "--mode", "mass"});
  ASSERT_EQ(movie.exit_code, 0) << movie.errors;
  EXPECT_GT(std::filesystem::file_size(folder / "x.mp4"), 1000u);
  // Its pictures are gone.
  for (const auto& entry : std::filesystem::directory_iterator(folder.path()))
    EXPECT_FALSE(entry.path().filename().string().starts_with(".x.mp4")) << entry.path();
}

TEST_F(Compare, AnotherComparisonReplacesTheFilesOfTheOneBefore) {
  ASSERT_NO_FATAL_FAILURE(render_both());
  ASSERT_EQ(compare("a", "b", {"--out", "both", "--mode", "beside"}).exit_code, 0);
  folder.write("both/beside/mine.txt", "kept");
  // Files of another comparison need --replace; those that are made again need no word.
  const auto refused = [&](const char* a, std::vector<std::string> words, const std::string& part) {
    words.insert(words.begin(), {"--out", "both", "--mode"});
    const auto result = compare(a, "b", words);
    EXPECT_EQ(result.exit_code, 2) << result.errors;
    EXPECT_TRUE(contains(result.errors, part)) << result.errors;
    EXPECT_TRUE(exists("both/beside/0002.png"));
  };
  refused("a", {"beside", "--frames", "1-2"}, "both has a comparison with other frames or modes");
  refused("a", {"metrics"}, "files, from beside");
  refused("b", {"beside"}, "both has a comparison of other runs; it would replace");
  ASSERT_EQ(compare("a", "b", {"--out", "both", "--mode", "beside"}).exit_code, 0);
  ASSERT_EQ(compare("a", "b", {"--out", "both", "--mode", "beside", "--frames", "1-2", "--replace"})
                .exit_code,
            0);
  EXPECT_TRUE(exists("both/beside/0002.png"));
  EXPECT_FALSE(exists("both/beside/0004.png"));
  EXPECT_TRUE(exists("both/beside/mine.txt"));
  // One that was killed had listed what it was to make.
  app::Json list = json_of("both/compare.json");
  list["files"] = app::Json::object();
  list["begun"] = {"beside/0001.png", "beside/0002.png"};
  list["is_whole"] = false;
  folder.write("both/compare.json", list.dump());
  EXPECT_TRUE(contains(neve({"verify", "both"}).output, "the comparison is not finished"));
  refused("a", {"metrics"}, "files, from beside/0001.png");
  // A folder with files that no comparison made is refused too.
  folder.write("results/metrics.csv", "mine");
  const auto foreign = compare("a", "b", {"--out", "results", "--mode", "metrics"});
  EXPECT_EQ(foreign.exit_code, 2) << foreign.errors;
  EXPECT_TRUE(contains(foreign.errors, "results has files that no neve compare there has made"))
      << foreign.errors;
  EXPECT_EQ(read_text(folder / "results/metrics.csv"), "mine");
}

TEST_F(Compare, ItsFolderIsVerifiedAsThoseOfRunsAre) {
  ASSERT_NO_FATAL_FAILURE(render_both());
  ASSERT_EQ(compare("a", "b", {"--out", "c", "--mode", "beside", "--mode", "metrics"}).exit_code,
            0);
  // Completion in a shell writes a slash.
  EXPECT_EQ(
      compare("a/", (folder / "b").c_str(), {"--out", "c", "--mode", "beside", "--mode", "metrics"})
          .exit_code,
      0);
  const auto whole = neve({"verify", "c"});
  EXPECT_EQ(whole.exit_code, 0) << whole.output << whole.errors;
  folder.write("c/metrics.csv", "");
  std::filesystem::remove(folder / "c/beside/0002.png");
  const auto damaged = neve({"verify", "c"});
  EXPECT_EQ(damaged.exit_code, 9) << damaged.errors;
  EXPECT_TRUE(contains(damaged.output, "c/metrics.csv is empty")) << damaged.output;
  EXPECT_TRUE(contains(damaged.output, "c/beside/0002.png is missing")) << damaged.output;
}

TEST_F(Compare, RunsOfOtherLengthAreComparedAsFarAsBothGo) {
  ASSERT_NO_FATAL_FAILURE(render("a"));
  ASSERT_NO_FATAL_FAILURE(render("short", {"--frames", "0-2"}));
  const auto done = compare("a", "short", {"--out", "x.csv"});
  ASSERT_EQ(done.exit_code, 0) << done.errors;
  EXPECT_TRUE(contains(done.errors,
                       "a has frames 0 to 4 and short has frames 0 to 2: frames 0 to "
                       "2 are compared"))
      << done.errors;
  const auto late = compare("a", "short", {"--out", "x.csv", "--frames", "1-4"});
  EXPECT_EQ(late.exit_code, 2);
  EXPECT_TRUE(contains(late.errors, "expected frames that both have: frames 0 to 2"))
      << late.errors;
}

TEST_F(Compare, FramesOfOneMomentAreComparedWhateverTheirNumber) {
  ASSERT_NO_FATAL_FAILURE(render("a"));
  ASSERT_NO_FATAL_FAILURE(render("b", {"--set", "first_frame=1001"}));
  const auto same = compare("a", "b", {});
  EXPECT_EQ(same.exit_code, 0) << same.output;
  EXPECT_TRUE(contains(same.output, "the same states in")) << same.output;
  ASSERT_NO_FATAL_FAILURE(
      render("c", {"--set", "first_frame=1001", "--set", "material.snow.hardening=3"}));
  const auto other = compare("a", "c", {});
  EXPECT_EQ(other.exit_code, app::exit_check_failed) << other.output;
  EXPECT_TRUE(contains(other.output, " of A, 10")) << other.output;
}

/// Hashes are of the snow, which dust leaves as it is.
TEST_F(Compare, OtherDustOfTheSameSnowIsTold) {
  const std::vector<std::string> dusty{"--set", "material.snow.dust=0.3",
                                       "--set", "dust.speed=0.01",
                                       "--set", "dust.strain_rate=0.01"};
  const auto with_life = [&](const char* life) {
    std::vector<std::string> all = dusty;
    all.insert(all.end(), {"--set", std::string("dust.life=") + life});
    return all;
  };
  ASSERT_NO_FATAL_FAILURE(render("a", with_life("0.01")));
  ASSERT_NO_FATAL_FAILURE(render("b", with_life("9")));
  const auto other = compare("a", "b", {});
  EXPECT_EQ(other.exit_code, app::exit_check_failed) << other.output;
  EXPECT_TRUE(contains(other.output, "the snow has the same states in 5 frames; its dust differs"))
      << other.output;
}

TEST_F(Compare, RunsThatCannotBeComparedAreRefusedWithTheReason) {
  ASSERT_NO_FATAL_FAILURE(render("a"));
  ASSERT_NO_FATAL_FAILURE(render("slow", {"--set", "fps=12"}));
  ASSERT_NO_FATAL_FAILURE(render("fine", {"--set", "solver.cell_size=0.03"}));
  ASSERT_NO_FATAL_FAILURE(render("seeded", {"--set", "seed=2"}));
  ASSERT_NO_FATAL_FAILURE(render("late", {"--frames", "4-4"}));
  ASSERT_NO_FATAL_FAILURE(render("early", {"--frames", "1-1"}));
  const auto refused = [&](const char* a, const char* b, const std::vector<std::string>& more,
                           const char* why) {
    const auto done = compare(a, b, more);
    EXPECT_EQ(done.exit_code, 2) << done.errors;
    EXPECT_TRUE(contains(done.errors, why)) << done.errors;
  };
  refused("a", "slow", {"--out", "x.png"}, "their frames are at different times");
  refused("a", "slow", {}, "frame 1 of a is at ");
  refused("a", "fine", {"--out", "x.png", "--mode", "mass"}, "solver.cell_size is 0.04 m in A");
  refused("a", "fine", {"--out", "x.png", "--mode", "displacement"},
          "no particle of A is the same piece of snow");
  refused("a", "seeded", {"--out", "x.png", "--mode", "displacement"}, "seed is 1 in A and 2 in B");
  refused("late", "early", {"--out", "x.png"},
          "they have no frame in common, at 0.167 to 0.167 s and at 0.0417 to 0.0417 s");
  refused("a", "a/particles", {"--out", "x.png"}, "is not the folder of a run");
  ASSERT_EQ(neve({"strip", "a", "--at", "0.1", "--out", "strip.png"}).exit_code, 0);
  refused("strip.png", "a/particles/0004.png", {"--out", "x.png"}, "is a strip of 1 moment");
  refused("a", "a", {"--out", "a"}, "a is the folder of a run");
  refused("a", "a", {"--mode", "wipe"}, "needs pictures");
  refused("a", "a", {"--out", "x.png", "--mode", "wip"}, "did you mean wipe?");
  refused("a", "a", {"--out", "x.mp4", "--mode", "metrics"}, "not a movie");
  // A folder takes the modes that are possible, and says which are not.
  const auto rest = compare("a", "fine", {"--out", "rest"});
  EXPECT_EQ(rest.exit_code, 0) << rest.errors;
  EXPECT_TRUE(contains(rest.errors, "no mass: solver.cell_size")) << rest.errors;
  EXPECT_TRUE(contains(rest.errors, "no displacement: no particle")) << rest.errors;
  EXPECT_TRUE(exists("rest/wipe/0004.png"));
  EXPECT_FALSE(exists("rest/mass/0004.png"));
}

TEST_F(Compare, PicturesWithoutAStateAreShownBesideEachOtherOrWiped) {
  render::Image image{64, 48, 3, std::vector<std::uint8_t>(64 * 48 * 3, 90)};
  app::output::write_file(folder / "p.png", render::encode_png(image));
  image.pixels.assign(image.pixels.size(), 200);
  app::output::write_file(folder / "q.png", render::encode_png(image));
  ASSERT_EQ(compare("p.png", "q.png", {"--out", "x.png"}).exit_code, 0);
  const render::Image beside = picture("x.png");
  EXPECT_EQ(beside.width, 132);
  const auto at = [&](int x) {
    return beside.pixels[static_cast<std::size_t>((beside.height / 2 * beside.width + x) * 3)];
  };
  EXPECT_EQ(at(30), 90);
  EXPECT_EQ(at(100), 200);
  const auto mass = compare("p.png", "q.png", {"--out", "y.png", "--mode", "mass"});
  EXPECT_EQ(mass.exit_code, 2);
  EXPECT_TRUE(contains(mass.errors, "hold no scene of neve")) << mass.errors;
}

TEST_F(Compare, PicturesOfOtherSizesOrChannelsAreToldApart) {
  const auto write = [&](const char* file, int width, int channels) {
    render::Image image{width, 48, channels, {}};
    image.pixels.assign(static_cast<std::size_t>(width * 48 * channels), 90);
    app::output::write_file(folder / file, render::encode_png(image));
  };
  write("p.png", 64, 3);
  write("wide.png", 80, 3);
  write("clear.png", 64, 4);
  const auto wide = compare("p.png", "wide.png", {}), clear = compare("p.png", "clear.png", {});
  EXPECT_EQ(wide.exit_code, 9) << wide.errors;
  EXPECT_TRUE(contains(wide.errors, "different sizes: 64x48 and 80x48")) << wide.errors;
  EXPECT_EQ(clear.exit_code, 9) << clear.errors;
  EXPECT_TRUE(contains(clear.errors, "p.png has 3 channels and clear.png has 4")) << clear.errors;
}

TEST_F(Compare, RunsOfASweepAreNamedByTheirFolders) {
  const auto sweep =
      neve({"sweep", "scene.toml", "-p", "material.snow.hardening=5,10", "--out", "study.cdb"});
  ASSERT_EQ(sweep.exit_code, 0) << sweep.errors;
  const auto done = compare("study.cdb/runs/0000", "study.cdb/runs/0001",
                            {"--out", "x.png", "--mode", "displacement", "--json"});
  ASSERT_EQ(done.exit_code, 0) << done.errors;
  const app::Json json = app::parse_json(std::string_view(done.output));
  EXPECT_EQ(json["differing"], app::Json::array({"material.snow.hardening"}));
  const auto whole = compare("study.cdb", "study.cdb", {"--out", "y.png"});
  EXPECT_EQ(whole.exit_code, 2);
  EXPECT_TRUE(contains(whole.errors, "is the folder of a sweep")) << whole.errors;
}

TEST(CompareMeasures, DisplacementIsOfTheSameIds) {
  sim::ParticleArrays a, b;
  a.x = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
  a.id = {3, 5, 9};
  b.x = {{1, 0, 3}, {2, 4, 0}};
  b.id = {5, 9};
  const app::compare::Displacement d = app::compare::displacement(a, b);
  EXPECT_EQ(d.in_both, 2u);
  EXPECT_EQ(d.only_a, 1u);
  EXPECT_EQ(d.only_b, 0u);
  EXPECT_DOUBLE_EQ(d.mean, 3.5);
  EXPECT_DOUBLE_EQ(d.largest, 4.0);
  a.id = {1, 2, 4};
  const app::compare::Displacement none = app::compare::displacement(a, b);
  EXPECT_EQ(none.in_both, 0u);
  EXPECT_TRUE(std::isnan(none.mean) && std::isnan(none.largest)) << "they were 0, as of one state";
}

TEST(CompareMeasures, MassDifferenceSumsOverBlocksOfBothRuns) {
  const auto samples = [](std::vector<Vec3i> blocks, float density) {
    app::picture::FieldSamples s;
    auto lattice = std::make_shared<render::NodeLattice>();
    lattice->spacing = 0.5f;
    lattice->block = std::move(blocks);
    s.density.assign(64 * lattice->block.size(), density);
    s.lattice = lattice;
    return s;
  };
  const auto difference = app::compare::mass_difference(samples({{0, 0, 0}, {1, 0, 0}}, 2),
                                                        samples({{1, 0, 0}, {2, 0, 0}}, 3));
  // 64 nodes of 1/8 m3 each: 2 only in A, 1 more in B in the middle, 3 only in B.
  EXPECT_DOUBLE_EQ(difference.more_in_a, 16.0);
  EXPECT_DOUBLE_EQ(difference.more_in_b, 32.0);
  ASSERT_EQ(difference.smoke.nodes->block.size(), 3u);
  EXPECT_EQ(difference.smoke.value[0], -2.0f);
  EXPECT_EQ(difference.smoke.value[64], 1.0f);
  EXPECT_EQ(difference.smoke.density[64], 1.0f);
  EXPECT_EQ(difference.smoke.value[130], 3.0f);
}

/// Particles of an emitter are numbered in the order of their births.
TEST_F(Compare, BirthsAreTheSameSnowOnlyWhereTheirOrderSaysSo) {
  const auto emitter = [](const std::string& name, const std::string& x, const std::string& y) {
    return "[[emitter]]\nname = \"" + name + "\"\nshape = { box = { center = [" + x + ", " + y +
           ", 0], size = [0.16, 0.08, 0.16] } }\nvelocity = [0, -2, 0]\nrate = 15\n";
  };
  const std::string left = emitter("left", "-0.5", "0.6");
  const auto compare_with_steps = [&](const std::string& emitters, const char* set) {
    folder.write("scene.toml", tiny_scene + emitters);
    render("a", {"--replace"});
    render("b", {"--replace", "--set", set});
    return compare("a", "b", {"--out", "x.png", "--mode", "displacement", "--json"});
  };
  const auto expect_refused = [&](const std::string& emitters, const char* set, const char* why) {
    const auto done = compare_with_steps(emitters, set);
    EXPECT_EQ(done.exit_code, 2) << set;
    EXPECT_TRUE(contains(done.errors, why)) << done.errors;
  };
  const auto same = compare_with_steps(left, "solver.max_dt=2e-4");
  ASSERT_EQ(same.exit_code, 0) << same.errors;
  // Snow in flight is where it is for any steps.
  const app::Json json = app::parse_json(std::string_view(same.output));
  EXPECT_LT(json["frames"][0]["displacement_mean"].get<double>(), 0.01);
  expect_refused(left + emitter("right", "0.5", "0.6"), "solver.max_dt=2e-4",
                 "which of several emitters");
  expect_refused(left, "emitter.left.rate=20", "emitter.left.rate differs");
  expect_refused(left, "material.snow.density=300", "materials of other densities");
  // The emitter lies in the floor: its snow cannot leave.
  expect_refused(emitter("left", "-0.5", "0.02"), "solver.max_dt=2e-4",
                 "snow was in the way of emitter.left");
}

/// Ids are the order in which places were drawn or read: as many particles are not yet the same
/// snow.
TEST_F(Compare, BodiesAreTheSameSnowOnlyWhereTheirParticlesHaveTheSamePlaces) {
  const auto refused = [&](const char* b, const char* why) {
    const auto done = compare("a", b, {"--out", "x.png", "--mode", "displacement"});
    EXPECT_EQ(done.exit_code, 2) << b;
    EXPECT_TRUE(contains(done.errors, why)) << done.errors;
  };
  const std::string box =
      "frames = 1\n[solver]\ncell_size = 0.08\n[[body]]\nname = \"ball\"\n"
      "shape = { box = { center = [0, 0.3, 0], size = [0.16, 0.16, 0.16] } }\n";
  folder.write("scene.toml", box + "[output]\nsize = [160, 90]\n");
  ASSERT_NO_FATAL_FAILURE(render("a"));
  ASSERT_NO_FATAL_FAILURE(render("lattice", {"--set", "body.ball.sampling=lattice"}));
  refused("lattice", "body ball begins with particles in other places: body.ball.sampling differs");
  // A body that was moved, turned, or is of another material is the same snow.
  ASSERT_NO_FATAL_FAILURE(
      render("moved", {"--set", "body.ball.shape.box.center=[0.05, 0.3, 0]", "--set",
                       "material.snow.density=300", "--set", "solver.gravity=[0, -1, 0]"}));
  const auto moved = compare(
      "a", "moved", {"--out", "x.png", "--mode", "displacement", "--frames", "0-0", "--json"});
  ASSERT_EQ(moved.exit_code, 0) << moved.errors;
  EXPECT_NEAR(app::parse_json(std::string_view(moved.output))["frames"][0]["displacement_mean"],
              0.05, 1e-6);
  ASSERT_NO_FATAL_FAILURE(render("turned", {"--set", "body.ball.shape.box.rotation=[0, 30, 0]"}));
  EXPECT_EQ(compare("a", "turned", {"--out", "x.png", "--mode", "displacement"}).exit_code, 0);
  // The points of a file in another order.
  std::string points = "x,y,z\n", other = points;
  for (int k = 0; k < 27; ++k) {
    const auto line = [](int n) {
      return fmt::format("{},{},{}\n", 0.04 * (n % 3), 0.3 + 0.04 * (n / 3 % 3), 0.04 * (n / 9));
    };
    points += line(k), other += line(26 - k);
  }
  folder.write("points.csv", points);
  folder.write("other.csv", other);
  for (const auto& [run, file] : {std::pair{"a", "points.csv"}, {"b", "other.csv"}}) {
    folder.write("scene.toml",
                 fmt::format("frames = 1\n[solver]\ncell_size = 0.08\n[[body]]\nname = "
                             "\"ball\"\nshape = {{ points = {{ file = \"{}\", spacing "
                             "= 0.04 }} }}\n[output]\nsize = [160, 90]\n",
                             file));
    ASSERT_NO_FATAL_FAILURE(render(run, {"--replace"}));
  }
  refused("b", "body.ball.shape.points.file differs");
}

TEST_F(Compare, BurnInsSayWhatWasChanged) {
  const auto drawn = [&](const std::string& burn_in, const char* a, const char* b) {
    folder.write("scene.toml", tiny_scene + burn_in);
    render(a);
    render(b, {"--set", "material.snow.hardening=11"});
    EXPECT_EQ(compare(a, b, {"--out", "x.png", "--mode", "wipe", "--wipe", "0"}).exit_code, 0);
    render::Image image = picture("x.png");
    // The words around the picture name the runs, so these rows are cut off.
    const std::ptrdiff_t row = image.width * image.channels;
    image.pixels.erase(image.pixels.begin(), image.pixels.begin() + 60 * row);
    image.pixels.resize(static_cast<std::size_t>(80 * row));
    image.height = 80;
    return image;
  };
  const render::Image without = drawn("", "a", "b"),
                      with = drawn("[burn_in]\nbottom = \"{changes}\"\n", "c", "d");
  EXPECT_GT(render::compare(without, with).max, 50);
}

}  // namespace
}  // namespace neve::test

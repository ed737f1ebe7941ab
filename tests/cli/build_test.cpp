/// The origin of the program: in its version, its runs, its pictures, and the keys of sweeps.

#include "app/record/run_json.h"
#include "tests/cli/run_neve.h"
#include "tests/support/needs.h"

namespace neve::test {
namespace {

class BuildOrigin : public Cli {
 protected:
  /// Returns the source that cmake/WriteBuildOrigin.cmake writes for the folder `checkout`.
  std::string origin() {
    const auto cmake = app::output::find_program("cmake");
    const auto result = app::output::run_process(
        *cmake,
        {"-DSOURCE=" + (folder / "checkout").string(), "-DFOLDERS=sim|shaders",
         "-DOUTPUT=" + (folder / "origin.cpp").string(), "-P",
         NEVE_SOURCE_DIR "/cmake/WriteBuildOrigin.cmake"},
        folder.path());
    EXPECT_EQ(result.exit_code, 0) << result.errors;
    return read_text(folder / "origin.cpp");
  }
  static std::string value(const std::string& origin, const std::string& name) {
    const std::string start = name + " = \"";
    const std::size_t at = origin.rfind(start) + start.size();
    return origin.substr(at, origin.find('"', at) - at);
  }
  std::string sources() { return value(origin(), "build_sources"); }
  std::string commit() { return value(origin(), "build_commit"); }
  void git(const std::string& words) {
    const auto result = app::output::run_process(
        "/bin/bash",
        {"-c", "git -c user.name=a -c user.email=a@b -c init.defaultBranch=main " + words},
        folder / "checkout");
    EXPECT_EQ(result.exit_code, 0) << words << result.errors;
  }
};

TEST_F(BuildOrigin, VersionRunAndPictureNameIt) {
  const auto version = neve({"--version"});
  for (const char* part : {"neve ", "commit ", "GCC "})
    EXPECT_TRUE(contains(version.output, part)) << version.output;
  const app::Json json = app::parse_json(std::string_view(neve({"version", "--json"}).output));
  ASSERT_EQ(
      neve({"render", "scene.toml", "--out", "out", "--frames", "0-1", "--no-movie"}).exit_code, 0);
  const app::Json run = json_of("out/run.json");
  EXPECT_EQ(run["build"], json["build"]);
  EXPECT_EQ(run["simd"], json["simd"]);
  const auto info = neve({"info", "out/particles/0001.png", "--json"});
  const std::string build =
      app::parse_json(std::string_view(info.output))["build"].get<std::string>();
  for (const char* key : {"commit", "type", "compiler"}) {
    const auto part = json["build"][key].get<std::string>();
    EXPECT_TRUE(contains(build, part)) << build;
    EXPECT_TRUE(contains(version.output, part)) << version.output;
    EXPECT_TRUE(contains(neve({"info", "out"}).output, part)) << part;
  }
  EXPECT_TRUE(contains(build, run["simd"].get<std::string>())) << build;
}

TEST_F(BuildOrigin, OnlySourcesThatChangeResultsChangeTheFingerprint) {
  if (!app::output::find_program("cmake")) SKIP_OR_FAIL("no cmake in PATH");
  for (const char* file : {"sim/step.cpp", "sim/deep/kernel.h", "shaders/light.glsl", "docs/a.md"})
    folder.write(std::string("checkout/") + file, "text");
  const std::string first = sources();
  EXPECT_EQ(first.size(), 16u);
  folder.write("checkout/docs/a.md", "another text");
  EXPECT_EQ(sources(), first);
  for (const char* file : {"sim/deep/kernel.h", "shaders/light.glsl", "sim/new.cpp"}) {
    const std::string before = sources();
    folder.write(std::string("checkout/") + file, "another text");
    EXPECT_NE(sources(), before) << file;
  }
}

TEST_F(BuildOrigin, ItsCommitIsThatOfItsOwnCheckout) {
  if (!app::output::find_program("cmake")) SKIP_OR_FAIL("no cmake in PATH");
  if (!app::output::find_program("git")) SKIP_OR_FAIL("no git in PATH");
  folder.write("checkout/sim/step.cpp", "text");
  EXPECT_EQ(commit(), "unknown");
  git("init -q && git add . && git -c user.name=a -c user.email=a@b commit -qm first");
  const std::string clean = commit();
  EXPECT_EQ(clean.size(), 12u);
  const auto written = std::filesystem::last_write_time(folder / "origin.cpp");
  EXPECT_EQ(commit(), clean);
  EXPECT_EQ(std::filesystem::last_write_time(folder / "origin.cpp"), written)
      << "nothing is compiled again where nothing has changed";
  folder.write("checkout/sim/step.cpp", "another text");
  EXPECT_EQ(commit(), clean + " with changes");
  std::filesystem::rename(folder / "checkout", folder / "outer");
  folder.write("outer/inner/sim/step.cpp", "text");
  std::filesystem::create_directory_symlink(folder / "outer/inner", folder / "checkout");
  EXPECT_EQ(commit(), "unknown") << "a copy in somebody's checkout is none of it";
}

/// Keys hold the fingerprint: the runs of other sources are unknown to this build.
TEST_F(BuildOrigin, ASweepSaysThatAnotherBuildMadeItsRuns) {
  const std::vector<std::string> words{"sweep",    "scene.toml", "-p",    "seed=1,2",
                                       "--frames", "0-1",        "--out", "s"};
  ASSERT_EQ(neve(words).exit_code, 0);
  const auto again = neve(words);
  EXPECT_FALSE(contains(again.errors, "another build")) << again.errors;
  EXPECT_FALSE(exists("s/runs/0002"));
  std::string manifest = read_text(folder / "s/manifest.json");
  for (const char* run : {"0000", "0001"}) {
    const std::string file = std::string("s/runs/") + run + "/status.json";
    app::Json status = json_of(file);
    const auto key = status["key"].get<std::string>();
    const std::string other = "0123456789abcde" + std::string(run).substr(3);
    manifest.replace(manifest.find(key), key.size(), other);
    status["key"] = other;
    status.erase("hash");
    folder.write(file, app::record::with_own_hash(status));
  }
  const auto sources = app::parse_json(std::string_view(manifest))["sources"].get<std::string>();
  manifest.replace(manifest.find(sources), sources.size(), "0000000000000000");
  app::Json list = app::parse_json(std::string_view(manifest));
  list.erase("hash");
  folder.write("s/manifest.json", app::record::with_own_hash(list));
  const auto other = neve(words);
  EXPECT_EQ(other.exit_code, 0) << other.errors;
  EXPECT_TRUE(contains(other.errors, "another build of neve made the 2 finished runs here"))
      << other.errors;
  EXPECT_TRUE(exists("s/runs/0003/run.json"));
}

}  // namespace
}  // namespace neve::test

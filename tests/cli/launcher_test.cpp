/// ./neve, the launcher, with a compiler and a package manager that only say that they were called.

#include <unistd.h>

#include <chrono>

#include "tests/cli/run_neve.h"
#include "tests/support/needs.h"

namespace neve::test {
namespace {

namespace fs = std::filesystem;

constexpr const char* false_cmake = R"(#!/bin/bash
echo "$@" >> "$CALLS"
if [ "$1" = --build ]; then
  printf '#!/bin/bash\necho "built $*"\n' > "$2/neve"
  chmod +x "$2/neve"
  exit
fi
while [ "$1" != -B ]; do shift || exit 1; done
mkdir -p "$2"
touch "$2/build.ninja" "$2/CMakeCache.txt"
)";

constexpr const char* false_dpkg = R"(#!/bin/bash
shift 3
for package; do [ "$package" = "$MISSING" ] || echo "installed $package"; done
)";

class Launcher : public Cli {
 protected:
  Launcher() {
    for (const char* name : {"app/a.cpp", "sim/a.cpp", "render/a.cpp", "shaders/a.frag",
                             "CMakeLists.txt", "CMakePresets.json"})
      folder.write(std::string("checkout/") + name, "");
    fs::copy_file(NEVE_SOURCE_DIR "/neve", folder / "checkout/neve");
    program("cmake", false_cmake);
    program("dpkg-query", false_dpkg);
    program("apt-get", "#!/bin/bash\necho \"apt-get $*\" >> \"$CALLS\"\n");
    program("sudo", "#!/bin/bash\nexec \"$@\"\n");
    fs::create_directories(folder / "home");
    fs::permissions(folder.path(), fs::perms(0755));
    fs::permissions(folder / "home", fs::perms(0777));
  }

  void program(const std::string& name, const std::string& text) {
    folder.write("bin/" + name, text);
    fs::permissions(folder / ("bin/" + name), fs::perms(0755));
  }

  /// Another user may read the checkout, and write only at home.
  app::output::ProcessResult launch(const std::vector<std::string>& arguments,
                                    const std::string& missing = "") {
    const std::string here = folder.path().string();
    std::vector<std::string> words;
    if (::geteuid() == 0) words = {"--reuid=65534", "--regid=65534", "--clear-groups", "--"};
    for (const std::string& word :
         {std::string("/usr/bin/env"), "HOME=" + here + "/home", "XDG_CACHE_HOME=" + here + "/home",
          "CALLS=" + here + "/home/calls", "MISSING=" + missing,
          "PATH=" + here + "/bin:/usr/bin:/bin", here + "/checkout/neve"})
      words.push_back(word);
    words.insert(words.end(), arguments.begin(), arguments.end());
    if (::geteuid() == 0)
      return app::output::run_process("/usr/bin/setpriv", words, folder / "home");
    const std::string env = words.front();
    words.erase(words.begin());
    return app::output::run_process(env, words, folder / "home");
  }

  std::string calls() {
    const std::string text = exists("home/calls") ? read_text(folder / "home/calls") : "";
    fs::remove(folder / "home/calls");
    return text;
  }

  void let_others_write(bool may_write) {
    const fs::perms all = fs::perms(may_write ? 0777 : 0555);
    fs::permissions(folder / "checkout", all);
  }
};

TEST_F(Launcher, AReadOnlyCheckoutIsBuiltInAFolderOfTheUser) {
  if (::geteuid() == 0 && !fs::exists("/usr/bin/setpriv")) SKIP_OR_FAIL("no setpriv (util-linux)");
  let_others_write(false);
  const auto first = launch({"version"});
  EXPECT_EQ(first.output, "built version\n") << first.errors;
  EXPECT_FALSE(exists("checkout/build"));
  EXPECT_TRUE(contains(calls(), (folder / "home/neve").string()));
  // Nothing has changed: nothing is called.
  EXPECT_EQ(launch({"doctor"}).output, "built doctor\n");
  EXPECT_EQ(calls(), "");
  // A source is newer.
  fs::last_write_time(folder / "checkout/app/a.cpp",
                      fs::file_time_type::clock::now() + std::chrono::hours(1));
  EXPECT_EQ(launch({"doctor"}).output, "built doctor\n");
  EXPECT_TRUE(contains(calls(), "--build"));
  let_others_write(true);
}

TEST_F(Launcher, ABuiltCheckoutOfAnotherUserIsUsedAsItIs) {
  if (::geteuid() == 0 && !fs::exists("/usr/bin/setpriv")) SKIP_OR_FAIL("no setpriv (util-linux)");
  folder.write("checkout/build/release/neve", "#!/bin/bash\necho theirs\n");
  fs::permissions(folder / "checkout/build/release/neve", fs::perms(0755));
  folder.write("checkout/build/release/.up-to-date", "");
  let_others_write(false);
  EXPECT_EQ(launch({"version"}).output, "theirs\n");
  EXPECT_EQ(calls(), "");
  let_others_write(true);
}

TEST_F(Launcher, HelpEndsAsTheProgramDoes) {
  if (::geteuid() == 0 && !fs::exists("/usr/bin/setpriv")) SKIP_OR_FAIL("no setpriv (util-linux)");
  let_others_write(true);
  const auto all = launch({"help"}), one = launch({"help", "render"});
  EXPECT_EQ(all.exit_code, 0) << all.errors;
  EXPECT_TRUE(contains(all.output, "Tests: ./neve test")) << all.output;
  EXPECT_EQ(one.exit_code, 0) << one.errors;
  EXPECT_EQ(one.output, "built help render\n");
}

TEST_F(Launcher, PackagesAreInstalledOnlyWhereSomeAreMissing) {
  if (::geteuid() == 0 && !fs::exists("/usr/bin/setpriv")) SKIP_OR_FAIL("no setpriv (util-linux)");
  let_others_write(true);
  EXPECT_EQ(launch({"version"}).output, "built version\n");
  EXPECT_FALSE(contains(calls(), "apt-get"));
  EXPECT_TRUE(exists("checkout/build/release/neve"));
  fs::remove(folder / "checkout/build/release/.up-to-date");
  const auto again = launch({"version"}, "libfmt-dev");
  EXPECT_EQ(again.output, "built version\n") << again.errors;
  EXPECT_TRUE(contains(calls(), "apt-get install -y --no-install-recommends libfmt-dev\n"));
}

/// A machine may have its own ffmpeg, or none.
TEST_F(Launcher, WhatOnlyDrawsAndFilmsIsNoReasonToStop) {
  if (::geteuid() == 0 && !fs::exists("/usr/bin/setpriv")) SKIP_OR_FAIL("no setpriv (util-linux)");
  if (fs::exists("/usr/bin/sudo")) GTEST_SKIP() << "this machine has sudo";
  let_others_write(true);
  fs::remove(folder / "bin/sudo");
  const auto refused = launch({"version"}, "libfmt-dev"), built = launch({"version"}, "ffmpeg");
  EXPECT_NE(refused.exit_code, 0);
  EXPECT_EQ(built.output, "built version\n") << built.errors;
  EXPECT_TRUE(contains(built.errors, "goes on without ffmpeg: not root and no sudo"));
}

TEST_F(Launcher, ABuildThatCannotStartOrIsOfElsewhereIsMadeAnew) {
  if (::geteuid() == 0 && !fs::exists("/usr/bin/setpriv")) SKIP_OR_FAIL("no setpriv (util-linux)");
  let_others_write(true);
  EXPECT_EQ(launch({"version"}).output, "built version\n");
  calls();
  const auto is_made_anew = [&](const char* why) {
    const auto again = launch({"doctor"}, "libfmt-dev");
    const std::string called = calls();
    EXPECT_EQ(again.output, "built doctor\n") << why << again.errors;
    EXPECT_TRUE(contains(called, "--fresh --preset release")) << why << called;
    EXPECT_TRUE(contains(called, "apt-get install")) << why << called;
    EXPECT_EQ(launch({"doctor"}).output, "built doctor\n");
    EXPECT_EQ(calls(), "") << why;
  };
  // The program is for another machine's instruction set, or misses a library.
  for (const char* code : {"2", "127"}) {
    folder.write("checkout/build/release/neve", std::string("#!/bin/bash\nexit ") + code + "\n");
    fs::last_write_time(folder / "checkout/build/release/.up-to-date",
                        fs::file_time_type::clock::now());
    is_made_anew(code);
  }
  folder.write("checkout/build/release/CMakeCache.txt", "CMAKE_HOME_DIRECTORY:INTERNAL=/old\n");
  fs::remove(folder / "checkout/build/release/.up-to-date");
  is_made_anew("moved");
}

TEST_F(Launcher, NewPresetsConfigureAgain) {
  if (::geteuid() == 0 && !fs::exists("/usr/bin/setpriv")) SKIP_OR_FAIL("no setpriv (util-linux)");
  let_others_write(true);
  EXPECT_EQ(launch({"version"}).output, "built version\n");
  calls();
  fs::last_write_time(folder / "checkout/CMakePresets.json",
                      fs::file_time_type::clock::now() + std::chrono::hours(1));
  EXPECT_EQ(launch({"version"}).output, "built version\n");
  EXPECT_TRUE(contains(calls(), "--fresh --preset release"));
}

}  // namespace
}  // namespace neve::test

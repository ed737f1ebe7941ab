/// The Debian package of cpack, as lintian sees it, and the program in it.

#include "tests/cli/run_neve.h"
#include "tests/support/needs.h"

namespace neve::test {
namespace {

namespace fs = std::filesystem;

class Package : public Cli {
 protected:
  app::output::ProcessResult shell(const std::string& command) {
    return app::output::run_process("/bin/bash", {"-c", command}, folder.path());
  }
};

TEST_F(Package, LintianFindsNothingAndTheProgramInItRuns) {
  for (const char* program : {"cpack", "lintian", "dpkg-deb"})
    if (!app::output::find_program(program))
      SKIP_OR_FAIL(std::string("no ") + program + " in PATH; install cmake, lintian, dpkg");
  const std::string build = fs::path(NEVE_BINARY).parent_path().string();
  const auto packed = shell("cpack -G DEB -B pack --config '" + build + "/CPackConfig.cmake'");
  ASSERT_EQ(packed.exit_code, 0) << packed.output << packed.errors;
  const auto looked = shell("lintian --allow-root --fail-on error,warning pack/neve_*.deb");
  EXPECT_EQ(looked.exit_code, 0) << looked.output << looked.errors;
  EXPECT_EQ(looked.output, "");
  ASSERT_EQ(shell("dpkg-deb -x pack/neve_*.deb there").exit_code, 0);
  const auto check = app::output::run_process(folder / "there/usr/bin/neve",
                                              {"check", "--coarsen", "3"}, folder.path());
  EXPECT_EQ(check.exit_code, 0) << check.errors;
  EXPECT_TRUE(contains(check.output, (folder / "there/usr/share/neve").string())) << check.output;
  const auto page = shell("zcat there/usr/share/man/man1/neve-export.1.gz");
  EXPECT_TRUE(contains(page.output, ".SH NAME\nneve\\-export")) << page.output << page.errors;
}

}  // namespace
}  // namespace neve::test

/// Every mistake, built and run; makes docs/mistakes.md.

#include <gtest/gtest.h>

#include <fstream>

#include "tests/mutation/page.h"
#include "tests/support/temporary_folder.h"

namespace neve::test {
namespace {

TEST(Mistakes, AllAreNoticedAndEveryCheckNoticesSome) {
  const std::vector<Mistake> mistakes = all_mistakes();
  const TemporaryFolder folder;
  const std::vector<Finding> findings = Laboratory(folder.path()).examine(mistakes);
  for (std::size_t k = 0; k < mistakes.size(); ++k) {
    EXPECT_EQ(findings[k].trouble, "");
    EXPECT_TRUE(findings[k].is_caught()) << mistakes[k].name << " goes unnoticed";
  }
  for (const std::string& name : idle_checks(findings))
    ADD_FAILURE() << "the check " << name << " notices no mistake: it is decoration";
  const std::string made = page(mistakes, findings);
  const std::string file = "mistakes.md";  // in the folder of the build
  if (read_text(std::string(NEVE_SOURCE_DIR) + "/docs/mistakes.md") == made) return;
  std::ofstream(file, std::ios::binary) << made;
  ADD_FAILURE() << "docs/mistakes.md is not what was found; where that is right, copy "
                << std::filesystem::absolute(file).string() << " over it";
}

}  // namespace
}  // namespace neve::test

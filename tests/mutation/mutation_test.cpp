/// Some of the classic mistakes, built and run: the checks notice them, as docs/mistakes.md says.

#include <gtest/gtest.h>

#include "tests/mutation/page.h"
#include "tests/support/temporary_folder.h"

namespace neve::test {
namespace {

TEST(Mistakes, MistakesAreNoticedAsDocumentedAndCorrectCodePasses) {
  std::vector<Mistake> mistakes{{"none", "none", {}}};
  for (const Mistake& mistake : all_mistakes())
    if (mistake.is_in_fast_run) mistakes.push_back(mistake);
  const TemporaryFolder folder;
  const std::vector<Finding> findings = Laboratory(folder.path()).examine(mistakes);
  const std::string documented = read_text(std::string(NEVE_SOURCE_DIR) + "/docs/mistakes.md");
  EXPECT_EQ(findings[0].trouble, "");
  EXPECT_FALSE(findings[0].is_caught()) << row(mistakes[0], findings[0]);
  for (std::size_t k = 1; k < mistakes.size(); ++k) {
    ASSERT_EQ(findings[k].trouble, "");
    EXPECT_TRUE(findings[k].is_caught()) << mistakes[k].name << " goes unnoticed";
    const std::string line = row(mistakes[k], findings[k]);
    EXPECT_NE(documented.find(line), std::string::npos)
        << "docs/mistakes.md says otherwise; ./neve test --all makes it again:\n"
        << line;
  }
}

}  // namespace
}  // namespace neve::test

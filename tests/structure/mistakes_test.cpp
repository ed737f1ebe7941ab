/// The deliberate mistakes of the mutation tests still have their places in the sources.

#include <gtest/gtest.h>

#include <string>

#include "tests/mutation/edits.h"

namespace neve::test {
namespace {

TEST(Structure, MistakesHaveTheirPlacesInTheSources) {
  for (const Mistake& mistake : all_mistakes())
    for (const Edit& edit : mistake.edits)
      if (const std::string lost = lost_place(mistake, edit); !lost.empty()) ADD_FAILURE() << lost;
}

TEST(Structure, EditsOfMistakesIgnoreLayout) {
  const std::string text = "int twice(int a) {\n  return a *\n         2;\n}\n";
  const Edit edit{"none", "return a * 2;\n", "return a;\n"};
  EXPECT_EQ(edited(text, edit), "int twice(int a) {\n  return a;\n\n}\n");
  EXPECT_EQ(places_of("2;", text).size(), 1u);
  EXPECT_EQ(places_of("a", text).size(), 2u);
  EXPECT_TRUE(places_of("b", text).empty());
}

TEST(Structure, LostPlacesOfMistakesSayWhichTextToUpdate) {
  const Mistake mistake{"force_sign", "", {}};
  const Edit moved{"sim/kernels/bspline.h", "const V factor = V0 * (-inv_h * inertia * scale);",
                   ""};
  EXPECT_NE(lost_place(mistake, moved).find("The text is in sim/kernels/stages.h now"),
            std::string::npos)
      << lost_place(mistake, moved);
  const Edit changed{"sim/kernels/stages.h", "const V factor = V0 * (-inv_h * inertia * size);",
                     ""};
  const std::string message = lost_place(mistake, changed);
  EXPECT_TRUE(message.starts_with("tests/mutation/mistakes_grid.cpp:")) << message;
  EXPECT_NE(message.find("up to \"const V factor = V0 * (-inv_h * inertia * s\""),
            std::string::npos)
      << message;
}

}  // namespace
}  // namespace neve::test

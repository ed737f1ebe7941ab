/// Time codes against the rules of SMPTE 12M.

#include <gtest/gtest.h>

#include "app/support/film_rate.h"

namespace neve::test {
namespace {

using app::frames_of_time_code;
using app::time_code_text;

TEST(TimeCode, CountsFramesOfTheNominalRate) {
  EXPECT_EQ(time_code_text(1001, 24, false), "00:00:41:17");
  EXPECT_EQ(time_code_text(1001, 23.976, false), "00:00:41:17");
  EXPECT_EQ(frames_of_time_code("01:00:00:00", 25), 90000);
  EXPECT_EQ(time_code_text(-8, 24, false), "23:59:59:16");
}

/// The first two numbers of a minute are left out, but those of each tenth minute.
TEST(TimeCode, DropsNumbersAt2997) {
  EXPECT_EQ(time_code_text(1799, 29.97, true), "00:00:59;29");
  EXPECT_EQ(time_code_text(1800, 29.97, true), "00:01:00;02");
  EXPECT_EQ(time_code_text(17982, 29.97, true), "00:10:00;00");
  EXPECT_EQ(time_code_text(3600, 59.94, true), "00:01:00;04");
  for (long frame = 0; frame < 200000; frame += 7)
    EXPECT_EQ(frames_of_time_code(time_code_text(frame, 29.97, true), 29.97), frame);
}

TEST(TimeCode, RefusesWhatIsNone) {
  for (const char* text : {"", "1001", "01:00:00", "01:00:00:24", "24:00:00:00", "00:60:00:00",
                           "01:00:00:00x", "-1:00:00:00", "01:00:00;00" /* 24 drops nothing */})
    EXPECT_FALSE(frames_of_time_code(text, 24)) << text;
  EXPECT_FALSE(frames_of_time_code("00:01:00;00", 29.97)) << "a number that is left out";
  EXPECT_FALSE(frames_of_time_code("00:00:00:00", 12.5)) << "no code has this rate";
  EXPECT_EQ(time_code_text(100, 12.5, false), "");
}

}  // namespace
}  // namespace neve::test

/// Whole numbers of JSON that a stranger wrote.

#include "app/support/json.h"

#include <gtest/gtest.h>

namespace {

using namespace neve::app;

TEST(Json, WholeNumbersAreReadOrRefused) {
  EXPECT_EQ(whole_number<int>(Json(7)), 7);
  EXPECT_EQ(whole_number<int>(Json(-7)), -7);
  EXPECT_EQ(whole_number<int>(Json(3.0)), 3);
  EXPECT_EQ(whole_number<std::size_t>(Json(std::uint64_t{1} << 63)), std::size_t{1} << 63);
  // The first one was found by a search for inputs that break a reader.
  for (const char* text : {"4.44444e127", "-1e300", "2147483648", "-2147483649", "0.5",
                           "18446744073709551615", "1e400", "null", "\"3\"", "[1]", "true"})
    EXPECT_ANY_THROW(whole_number<int>(parse_json(std::string_view(text)))) << text;
  EXPECT_THROW(whole_number<std::size_t>(Json(-1)), std::runtime_error);
}

}  // namespace

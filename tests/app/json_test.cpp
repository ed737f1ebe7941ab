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

/// Objects of files of neve have a key for each picture.
TEST(Json, ObjectsAreReadAsTheyAreWritten) {
  const Json json = parse_json(std::string_view(R"({"b": 1, "a": [1, {"c": null}], "b": 2})"));
  EXPECT_EQ(to_text(json, -1), R"({"b":2,"a":[1,{"c":null}]})") << "the last of two counts";
  EXPECT_EQ(parse_json(std::string_view("7")), Json(7));
  EXPECT_ANY_THROW(parse_json(std::string_view("{\"a\": 1")));
  EXPECT_ANY_THROW(parse_json(std::string_view("1e999")));
}

TEST(Json, ValuesBelowTheDeepestLevelAreLeftOut) {
  const auto nested = [](int levels) {
    return std::string(static_cast<std::size_t>(levels), '[') + "1" +
           std::string(static_cast<std::size_t>(levels), ']');
  };
  EXPECT_EQ(to_text(parse_json(std::string_view(nested(64))), -1), nested(64));
  EXPECT_NO_THROW(parse_json(std::string_view(nested(100'000))));
}

/// Ten times the keys take about ten times as long: 200 000 took minutes.
TEST(Json, ManyKeysTakeNoTimeToSpeakOf) {
  std::string text = "{";
  for (int k = 0; k < 200'000; ++k) text += (k ? ",\"" : "\"") + std::to_string(k) + "\":0";
  EXPECT_EQ(parse_json(std::string_view(text + "}")).size(), 200'000u);
}

/// Terminals obey them; JSON may write them out.
TEST(Json, ControlsAreWrittenOut) {
  EXPECT_EQ(to_text(Json("a\x1b\xc2\x9b"
                         "b\x7f\xc3\xa9"),
                    -1),
            "\"a\\u001b\\u009bb\\u007f\xc3\xa9\"");
}

}  // namespace

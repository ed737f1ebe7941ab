// The guard in front of the TOML parser: what it lets through, and where it says things are.
#include <gtest/gtest.h>

#include "app/scene/toml/error.h"
#include "app/scene/toml/toml_source.h"
#include "app/scene/toml/toml_text.h"

namespace neve::app {
namespace {

std::string toml_error(std::string_view text) {
  try {
    app::scene::toml::parse_toml(text, "f");
  } catch (const app::scene::toml::SceneError& error) {
    return error.what();
  }
  return "no error";
}

std::string string_of(std::string_view text) {
  return std::get<std::string>(app::scene::toml::parse_toml(text, "f").entries.at(0).value.data);
}

TEST(TomlText, CheckedTextIsAscii) {
  const app::scene::toml::AsciiToml toml = app::scene::toml::to_ascii_toml("a = \"é😀\" # ü\n", "f");
  EXPECT_EQ(toml.text, "a = \"\\u00E9\\U0001F600\" # ?\n");
}

TEST(TomlText, ColumnsAreThoseOfTheUser) {
  const app::scene::toml::AsciiToml toml = app::scene::toml::to_ascii_toml("a = \"é😀\" x", "f");
  EXPECT_EQ(toml.original(1, 5).column, 5);    // the quote
  EXPECT_EQ(toml.original(1, 6).column, 6);    // é
  EXPECT_EQ(toml.original(1, 11).column, 6);   // still é
  EXPECT_EQ(toml.original(1, 12).column, 7);   // the face
  EXPECT_EQ(toml.original(1, 22).column, 8);   // the closing quote
  EXPECT_EQ(toml.original(1, 24).column, 10);  // x
  EXPECT_EQ(toml.original(2, 24).column, 24);  // another line
}

TEST(TomlText, StringsKeepTheirContent) {
  EXPECT_EQ(string_of("t = \"Boule de névé\""), "Boule de névé");
  EXPECT_EQ(string_of("t = \"\\\"é\\\\é\""), "\"é\\é");
  EXPECT_EQ(string_of("t = \"\"\"é\"\"\"\"\""), "é\"\"");
  EXPECT_EQ(string_of("t = \"\"\"\"\"é\"\"\""), "\"\"é");
  EXPECT_EQ(string_of("t = \"\"\"a\\\n   é\"\"\""), "aé");
  EXPECT_EQ(string_of("t = \"\"\"a\\\r\n\r\n é\"\"\""), "aé");
  EXPECT_EQ(string_of("t = \"\"\"\né\\\"\"\"\"\""), "é\"\"") << "an escaped quote closes nothing";
  EXPECT_EQ(string_of("t = '\\'"), "\\");
  EXPECT_EQ(string_of("t = '''a'b''c'''"), "a'b''c");
  EXPECT_EQ(string_of("t = \"# no comment\" # but this is: é"), "# no comment");
  EXPECT_EQ(string_of("t = ''\n# é"), "");
  EXPECT_EQ(string_of("t = \"\"\nu = \"é\""), "");
}

TEST(TomlText, MarksAndLineEndingsAreAccepted) {
  EXPECT_EQ(string_of("\xEF\xBB\xBFt = \"a\"\r\nu = 1\r\n"), "a");
  EXPECT_EQ(toml_error("\xEF\xBB\xBFt = \"a\"\r\nu 1\r\n"),
            "f:2:3: error: cannot parse key-value pair: expected '=', saw '1'");
}

TEST(TomlText, MoreThanAsciiOutsideBasicStringsIsLocated) {
  const std::string hint =
      "; only comments and strings in \"double quotes\" may contain non-ASCII characters";
  EXPECT_EQ(toml_error("title = \"é\"\nné = 1"), "f:2:2: error: U+00E9 outside a string" + hint);
  EXPECT_EQ(toml_error("t = 'né'"), "f:1:7: error: U+00E9 in a literal string" + hint);
  EXPECT_EQ(toml_error("t = '''\nné'''"), "f:2:2: error: U+00E9 in a literal string" + hint);
  EXPECT_EQ(toml_error("t = \"é\" ｻ"), "f:1:9: error: U+FF7B outside a string" + hint);
}

TEST(TomlText, BackslashBeforeMoreThanAsciiIsLocated) {
  EXPECT_EQ(toml_error("t = \"\"\"\\é\"\"\""), "f:1:9: error: a backslash cannot escape U+00E9");
  EXPECT_NE(toml_error("t = \"\"\"\\ é\"\"\""), "no error");
}

TEST(TomlText, UnclosedStringsAreBlamedOnTheirQuote) {
  EXPECT_EQ(toml_error("a = 1\nt = \"abc\nb = 2"), "f:2:5: error: string is never closed");
  EXPECT_EQ(toml_error("t = 'abc"), "f:1:5: error: string is never closed");
  EXPECT_EQ(toml_error("t = \"\"\"abc\"\"\n"), "f:1:5: error: string is never closed");
  EXPECT_EQ(toml_error("t = '''abc"), "f:1:5: error: string is never closed");
  EXPECT_EQ(toml_error("t = \"abc\\\""), "f:1:5: error: string is never closed");
}

TEST(TomlText, BadBytesAreLocated) {
  const std::string save = "invalid UTF-8; save the file as UTF-8 in your editor";
  EXPECT_EQ(toml_error("t = \"é\xFF\""), "f:1:7: error: " + save);
  EXPECT_EQ(toml_error("# \xC0\x80"), "f:1:3: error: " + save) << "overlong";
  EXPECT_EQ(toml_error("# \xED\xA0\x80"), "f:1:3: error: " + save) << "surrogate";
  EXPECT_EQ(toml_error("# \xF4\x90\x80\x80"), "f:1:3: error: " + save) << "beyond U+10FFFF";
  EXPECT_EQ(toml_error("# \xE2\x82"), "f:1:3: error: " + save) << "cut off";
  EXPECT_EQ(toml_error(std::string_view("\xFF\xFE#\0", 4)),
            "f:1:1: error: invalid UTF-8; the file is UTF-16; save it as UTF-8");
  EXPECT_EQ(toml_error(std::string_view("\x90\0\1", 3)),
            "f:1:1: error: invalid UTF-8; this is not a text file; name a scene, which is one");
  EXPECT_EQ(toml_error("[\x1b"), "f:1:2: error: control character U+001B");
  EXPECT_EQ(toml_error(std::string_view("a\0", 2)), "f:1:2: error: control character U+0000");
  EXPECT_EQ(toml_error("a = 1\rb = 2"), "f:1:6: error: carriage return without line feed");
}

TEST(TomlText, SizeAndDepthAreBounded) {
  EXPECT_EQ(toml_error(std::string(app::scene::toml::max_text_bytes + 1, '#')),
            "f: error: larger than 16 MiB");
  EXPECT_EQ(toml_error(std::string(app::scene::toml::max_toml_bytes, '#')), "no error");
  EXPECT_EQ(toml_error("a" + std::string(65, '.')), "f:1:66: error: more than 64 dots in one key");
  EXPECT_EQ(toml_error("# " + std::string(65, '.')), "no error");
  EXPECT_EQ(toml_error("a.b = {" + std::string(64, '.')),
            "f:1:71: error: more than 64 dots in one key")
      << "keys in braces are below the key before";
  EXPECT_EQ(toml_error("a = " + std::string(33, '[')), "f:1:37: error: nested more than 32 deep");
}

TEST(TomlText, NumbersOfAnyCountFitInALine) {
  std::string numbers = "a = [", keyframes = "k = [";
  for (int k = 0; k < 100; ++k) {
    numbers += (k > 0 ? ", " : "") + std::to_string(k) + ".5";
    keyframes += std::string(k > 0 ? ", " : "") + "{ place.time = " + std::to_string(k) +
                 ".25, place.eye = [0.5, 1.5, -2.5] }";
  }
  EXPECT_EQ(toml_error(numbers + "]"), "no error");
  EXPECT_EQ(toml_error(keyframes + "]"), "no error");
}

TEST(TomlText, AssertionsOfTheParserDoNotAbort) {
  EXPECT_EQ(toml_error("[\\"),
            "f:1:2: error: cannot parse key: expected bare key starting character or string "
            "delimiter, saw '\\'");
}

TEST(TomlSource, TomlSourceKeepsTheOrderOfTheFile) {
  const app::scene::toml::Table root =
      app::scene::toml::parse_toml("z = 1\na = 2\n[m]\nb = 1\na = [{y = 1, x = 2}]", "f");
  ASSERT_EQ(root.entries.size(), 3u);
  EXPECT_EQ(root.entries[0].key, "z");
  EXPECT_EQ(root.entries[1].key, "a");
  EXPECT_EQ(root.entries[2].key, "m");
  EXPECT_EQ(app::scene::toml::toml_document(root),
            "z = 1\na = 2\n\n[m]\nb = 1\na = [{ y = 1, x = 2 }]\n");
}

TEST(TomlSource, TomlSourceKnowsWhereEveryValueIs) {
  const app::scene::toml::Table root =
      app::scene::toml::parse_toml("t = \"é\"\nlist = [\"é\", { \"é\" = 5 }]", "f");
  const app::scene::toml::Array& list =
      std::get<app::scene::toml::Array>(root.entries[1].value.data);
  EXPECT_EQ(root.entries[1].where.line, 2);
  EXPECT_EQ(root.entries[1].value.where.column, 8);
  EXPECT_EQ(list[1].where.column, 14);
  const app::scene::toml::Entry& inner = std::get<app::scene::toml::Table>(list[1].data).entries[0];
  EXPECT_EQ(inner.where.column, 16);
  EXPECT_EQ(inner.value.where.column, 22);
}

}  // namespace
}  // namespace neve::app

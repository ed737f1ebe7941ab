/// The words of docs/glossary.md are kept: its last section lists phrases to avoid, and no text
/// that a user sees has one of those between backticks.

#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <regex>
#include <string>
#include <string_view>
#include <vector>

#include "tests/structure/sources.h"
#include "tests/structure/texts.h"

namespace neve::test {
namespace {

namespace fs = std::filesystem;

/// A place where a phrase is right; without a file it is right everywhere.
struct Allowed {
  std::string_view phrase, context, file, reason;
};

constexpr Allowed all_allowed[] = {
    {"is no", "there is no", "", "says that something is missing"},
    {"are no", "there are no", "", "says that something is missing"},
    {"is no", "is no longer", "", "says that something has ended"},
    {"study", "parameter study", "docs/glossary.md", "defines the word sweep"},
    {"goes on", "the program goes on", "docs/developers.md", "quotes what a test of a fuzzer asks"},
};

/// Names of code that must not have these words, and the names that may.
constexpr std::string_view banned_in_names =
    "(most|least)_[a-zA-Z]|_(most|least)$|[Cc]heckup|[Ss]tud(y|ies)";
constexpr std::string_view allowed_names[] = {
    "at_most", "at_least",
    "least_J_P",     // a member of sim::Warnings, named so in saved states
    "include_most",  // nearly all, not the greatest
};

bool is_word(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) || c == '_';
}

/// Lower case, and one blank for any blanks.
std::string plain(std::string_view text) {
  std::string result;
  for (const char c : text) {
    const bool is_blank = std::isspace(static_cast<unsigned char>(c));
    if (!is_blank)
      result += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    else if (!result.empty() && result.back() != ' ')
      result += ' ';
  }
  return result;
}

bool is_allowed(const std::string& text, std::size_t at, std::string_view phrase,
                const std::string& file) {
  return std::any_of(std::begin(all_allowed), std::end(all_allowed), [&](const Allowed& allowed) {
    if (allowed.phrase != phrase || (!allowed.file.empty() && allowed.file != file)) return false;
    const std::size_t before = allowed.context.find(phrase);
    return at >= before && text.compare(at - before, allowed.context.size(), allowed.context) == 0;
  });
}

/// The first place of a phrase in plain text, as whole words that are no part of a path or an
/// identifier; npos without.
std::size_t place_of(std::string_view phrase, const std::string& text, const std::string& file) {
  const auto is_joined = [&](char c) { return is_word(c) || c == '/' || c == '-'; };
  for (std::size_t at = text.find(phrase); at != text.npos; at = text.find(phrase, at + 1)) {
    const std::size_t end = at + phrase.size();
    const bool has_dot = end + 1 < text.size() && text[end] == '.' && is_word(text[end + 1]);
    if (at > 0 && (is_joined(text[at - 1]) || text[at - 1] == '.')) continue;
    if (has_dot || (end < text.size() && is_joined(text[end]))) continue;
    if (!is_allowed(text, at, phrase, file)) return at;
  }
  return std::string::npos;
}

struct Avoided {
  std::string phrase, instead;
};

/// The rows "| `phrase`, `phrase` | instead |" below "## Words to avoid".
std::vector<Avoided> words_to_avoid(const std::vector<SourceLine>& glossary) {
  std::vector<Avoided> words;
  bool is_in_section = false;
  const std::regex row(R"(^\| (.*) \| (.*) \|$)"), quoted("`([^`]+)`");
  for (const SourceLine& line : glossary) {
    if (line.text.starts_with("## ")) is_in_section = line.text == "## Words to avoid";
    std::smatch cells;
    if (!is_in_section || !std::regex_match(line.text, cells, row)) continue;
    const std::string avoid = cells[1];
    for (std::sregex_iterator at(avoid.begin(), avoid.end(), quoted), end; at != end; ++at)
      words.push_back({(*at)[1], cells[2]});
  }
  return words;
}

void expect_no_avoided(const std::vector<Avoided>& words, const std::vector<Text>& texts) {
  for (const Text& text : texts) {
    const std::string read = plain(text.text);
    for (const Avoided& word : words)
      if (const std::size_t at = place_of(word.phrase, read, text.file); at != std::string::npos)
        ADD_FAILURE() << text.file << ":" << text.line << ": \"" << word.phrase << "\" in \"..."
                      << read.substr(at < 40 ? 0 : at - 40, 90) << "...\"; write " << word.instead;
  }
}

TEST(Words, MessagesHaveNoneThatTheGlossaryAvoids) {
  std::vector<Text> texts;
  for (const std::string& file : sources_below({"app", "render", "sim"}))
    for (Text& text : literals_of_cpp(text_of(file), file)) texts.push_back(std::move(text));
  EXPECT_GT(texts.size(), 5000u) << "the sources are not read as they are written";
  const std::size_t literals = texts.size();
  // Its first column has the words of users, after the colon is the answer.
  for (const SourceLine& line : lines_of("app/advice/words.txt"))
    if (const std::size_t colon = line.text.find(" : "); colon != std::string::npos)
      texts.push_back({line.file, line.number, line.text.substr(colon + 3)});
  EXPECT_GT(texts.size(), literals + 30) << "the answers are not read as they are written";
  expect_no_avoided(words_to_avoid(lines_of("docs/glossary.md")), texts);
}

TEST(Words, PagesOfTheWebHaveNoneThatTheGlossaryAvoids) {
  std::vector<Text> texts;
  for (const char* folder : {"app/view/web", "app/sweep/sheet/report"})
    for (const auto& entry : fs::directory_iterator(source_root() / folder)) {
      const std::string file = entry.path().lexically_relative(source_root()).generic_string();
      if (file.ends_with(".html"))
        for (Text& text : texts_of_html(text_of(file), file)) texts.push_back(std::move(text));
      if (file.ends_with(".js"))
        for (Text& text : LiteralReader(text_of(file), "\"'`", file).read())
          texts.push_back(std::move(text));
    }
  EXPECT_GT(texts.size(), 500u) << "the pages are not read as they are written";
  expect_no_avoided(words_to_avoid(lines_of("docs/glossary.md")), texts);
}

/// The answers are messages, read above. The reports tell what happened once.
TEST(Words, TheDocumentationHasNoneThatTheGlossaryAvoids) {
  std::vector<Text> texts = paragraphs_of(lines_of("README.md"));
  for (const auto& entry : fs::directory_iterator(source_root() / "docs")) {
    const std::string name = entry.path().filename().string();
    if (entry.path().extension() != ".md" || name == "answers.md") continue;
    std::vector<SourceLine> lines = lines_of("docs/" + name);
    const auto avoided = std::find_if(lines.begin(), lines.end(), [](const SourceLine& line) {
      return line.text == "## Words to avoid";
    });
    if (name == "glossary.md") lines.erase(avoided, lines.end());
    for (Text& text : paragraphs_of(lines)) texts.push_back(std::move(text));
  }
  EXPECT_GT(texts.size(), 600u) << "the pages are not read as they are written";
  expect_no_avoided(words_to_avoid(lines_of("docs/glossary.md")), texts);
}

TEST(Words, NamesSayMaxMinAndSweep) {
  const std::regex banned{std::string(banned_in_names)}, name("[A-Za-z_][A-Za-z0-9_]*");
  std::size_t names = 0;
  for (const std::string& file : sources_below({"app", "render", "sim"}))
    for (const SourceLine& line : lines_of(file))
      for (std::sregex_iterator at(line.text.begin(), line.text.end(), name), end; at != end;
           ++at) {
        const std::string found = at->str();
        ++names;
        const bool is_fine =
            !std::regex_search(found, banned) ||
            std::any_of(std::begin(allowed_names), std::end(allowed_names),
                        [&](std::string_view fine) { return found.find(fine) != found.npos; });
        EXPECT_TRUE(is_fine) << file << ":" << line.number << ": " << found
                             << "; write max_, min_, check or sweep";
      }
  EXPECT_GT(names, 100'000u) << "the sources are not read as they are written";
}

/// A comment is read without the line below it: no sentence begins as a part of one.
TEST(Words, NoSentenceOfACommentBeginsAsAFragment) {
  const std::regex comment(R"(^\s*//+<? ?(.*)$)"), begins("^(What|Of|Where|How)\\b"),
      inside("[.] (What|Of|Where|How)\\b");
  std::size_t sentences = 0;
  for (const std::string& file : sources_below({"app", "render", "sim", "tests"})) {
    bool is_new = true;
    for (const SourceLine& line : lines_of(file)) {
      std::smatch found;
      if (!std::regex_match(line.text, found, comment)) {
        is_new = true;
        continue;
      }
      const std::string text = found[1];
      sentences += is_new ? 1 : 0;
      EXPECT_FALSE((is_new && std::regex_search(text, begins)) || std::regex_search(text, inside))
          << file << ":" << line.number << ": " << text << "; write a subject and a verb";
      is_new = text.ends_with('.');
    }
  }
  EXPECT_GT(sentences, 5000u) << "the sources are not read as they are written";
}

TEST(Words, TheGlossaryIsReadAsItIsWritten) {
  const std::vector<Avoided> words = words_to_avoid(lines_of("docs/glossary.md"));
  EXPECT_GT(words.size(), 20u);
  for (const Avoided& word : words) {
    EXPECT_EQ(plain(word.phrase), word.phrase) << "phrases are in lower case";
    EXPECT_NE(word.instead, "") << word.phrase;
  }
  const std::vector<Avoided> two =
      words_to_avoid({{"g", 1, "## Words to avoid"},
                      {"g", 2, "| avoid | write |"},
                      {"g", 3, "| `go on`, `went on`, and so on | go |"},
                      {"g", 4, "## Other"},
                      {"g", 5, "| `c` | d |"}});
  ASSERT_EQ(two.size(), 2u);
  EXPECT_EQ(two[1].phrase, "went on");
  EXPECT_EQ(two[1].instead, "go");
}

TEST(Words, PhrasesAreFoundInWhateverHasThem) {
  const auto has = [](std::string_view phrase, const std::vector<Text>& texts) {
    return std::any_of(texts.begin(), texts.end(), [&](const Text& text) {
      return place_of(phrase, plain(text.text), text.file) != std::string::npos;
    });
  };
  const auto cpp = [](const char* source) { return literals_of_cpp(source, "f.cpp"); };
  EXPECT_TRUE(has("go on", cpp("say(\"you may Go \"  // why\n    \"on here\");")));
  EXPECT_TRUE(has("go on", cpp("auto x = R\"(a \" b\ngo on)\";")));
  EXPECT_TRUE(has("go on", cpp("int n = 100'000; char q = '\"'; say(\"go\\non\");")));
  EXPECT_FALSE(has("go on", cpp("// \"go on\"\n/* \"go on\" */ go_on(\"go\", \"on\");")));
  EXPECT_TRUE(has("is no", cpp("\"it is no file\"")));
  EXPECT_FALSE(has("is no", cpp("\"there is no file\"")));
  EXPECT_FALSE(has("study", cpp("\"out/study.cdb dt_study.toml page/study\"")));
  EXPECT_TRUE(has("study", cpp("\"the study.\"")));
  EXPECT_TRUE(
      has("go on", paragraphs_of({{"p.md", 1, "they"}, {"p.md", 2, "go"}, {"p.md", 3, "on."}})));
  EXPECT_FALSE(
      has("go on", paragraphs_of({{"p.md", 1, "go"}, {"p.md", 2, ""}, {"p.md", 3, "on."}})));
  const char* page =
      "<style>p{go on}</style><p>wait</p><script>go; on; say('let it stop')</script>";
  EXPECT_TRUE(has("wait", texts_of_html(page, "p.html")));
  EXPECT_TRUE(has("stop", texts_of_html(page, "p.html")));
  EXPECT_FALSE(has("go on", texts_of_html(page, "p.html")));
}

}  // namespace
}  // namespace neve::test

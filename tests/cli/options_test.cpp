/// Every option of every command: read, written as words, and read again as the same.

#include <functional>
#include <regex>
#include <sstream>

#include "app/cli/command_line.h"
#include "app/options/arguments.h"
#include "app/options/languages.h"
#include "app/options/option.h"
#include "app/run/render_options.h"
#include "app/sweep/plan/sweep_options.h"
#include "tests/cli/run_neve.h"

namespace neve::test {
namespace {

using app::cli::Entry;
using app::options::Option;
using Words = std::vector<std::string>;

void for_each_command(const Entry& entry, const std::function<void(const Words&)>& use,
                      const Words& path = {}) {
  if (entry.run) use(path);
  for (const Entry& part : entry.parts) {
    Words longer = path;
    longer.push_back(part.name());
    for_each_command(part, use, longer);
  }
}

/// The command with options that nobody has changed.
Entry fresh(const Words& path) {
  Entry root = app::cli::program();
  Entry* found = &root;
  for (const std::string& name : path) found = found->part(name);
  return std::move(*found);
}

std::string sample(const Option& option) {
  return option.example.empty() ? "some text" : option.example;
}

/// The words of a command after its name.
Words words_of(const Entry& entry, const Words& path) {
  Words words = app::options::words_of(entry.command, fresh(path).command);
  words.erase(words.begin(), words.begin() + static_cast<std::ptrdiff_t>(path.size()));
  return words;
}

/// Reads the words again, and compares all values.
void expect_same_again(const Entry& entry, const Words& path) {
  const Words words = words_of(entry, path);
  const std::string said = entry.command.name + ": " + app::joined(words, " ");
  Entry again = fresh(path);
  EXPECT_EQ(app::options::parse(again.command, words), Words{}) << said;
  for (std::size_t k = 0; k < entry.command.options.size(); ++k)
    EXPECT_EQ(entry.command.options[k].write(), again.command.options[k].write())
        << said << ": " << entry.command.options[k].name();
  EXPECT_EQ(words_of(again, path), words);
}

TEST(Options, AnAddressMayHaveColonsAndAPort) {
  for (const auto& [given, said] :
       {std::pair{"::1", "[::1]"}, std::pair{"[::1]:8080", "[::1]:8080"},
        std::pair{"2001:db8::5", "[2001:db8::5]"}, std::pair{":8080", ":8080"},
        std::pair{"127.0.0.1:0", "127.0.0.1"}, std::pair{"localhost", "localhost"}}) {
    Entry view = fresh({"view"});
    EXPECT_EQ(app::options::parse(view.command, {"--listen", given}), Words{}) << given;
    const auto listen = std::ranges::find_if(
        view.command.options, [](const Option& option) { return option.name() == "--listen"; });
    EXPECT_EQ(listen->write(), Words{said}) << given;
  }
}

TEST(Options, OfNobodyHaveNoWords) {
  int commands = 0;
  for_each_command(app::cli::program(), [&](const Words& path) {
    EXPECT_EQ(words_of(fresh(path), path), Words{}) << app::joined(path, " ");
    ++commands;
  });
  EXPECT_GT(commands, 25);
}

TEST(Options, OfEveryCommandAreTheSameAfterTheWayToWordsAndBack) {
  int options = 0;
  for_each_command(app::cli::program(), [&](const Words& path) {
    Entry all = fresh(path);
    for (std::size_t k = 0; k < all.command.options.size(); ++k) {
      Entry one = fresh(path);
      Option& option = one.command.options[k];
      if (option.name() == "--help") continue;
      for (Option& other : one.command.options)  // the second argument is one behind the first
        if (other.is_argument() && other.is_required && &other != &option)
          other.read(sample(other));
      for (const auto& read : {option.read, all.command.options[k].read})
        for (int time = 0; time < (option.is_repeatable ? 2 : 1); ++time) read(sample(option));
      EXPECT_NE(words_of(one, path), Words{}) << one.command.name << " " << option.name();
      expect_same_again(one, path);
      ++options;
    }
    expect_same_again(all, path);
  });
  EXPECT_GT(options, 250);
}

TEST(Options, KeepValuesThatLookLikeFlags) {
  for (const char* text : {"-1", "--quiet", "-", "a b", "=", "--set=x"}) {
    app::run::RenderOptions options;
    options.plate = options.scene = text;
    options.overrides = {text, text};
    const Words words = app::options::words_of(options);
    app::run::RenderOptions again;
    app::options::Command command;
    describe(command, again);
    EXPECT_EQ(app::options::parse(command, Words(words.begin() + 1, words.end())), Words{});
    EXPECT_EQ(again.plate, text);
    EXPECT_EQ(again.overrides, options.overrides);
    if (options.scene != "-") {
      EXPECT_EQ(std::filesystem::path(again.scene).filename(), text);
    }
  }
}

TEST(Options, OfAMovieSayNoMoreThanWasAskedFor) {
  const auto read = [](const Words& words) {
    app::sweep::plan::CollectOptions options;
    app::options::Command command;
    describe(command, options);
    EXPECT_EQ(app::options::parse(command, words), Words{});
    return app::options::words_of(options);
  };
  for (const Words& words :
       {Words{"--movie-quality", "80"}, Words{"--movie", "gif"}, Words{"--movie", "none"},
        Words{"--movie-quality", "30", "--movie-fps", "12.5"}}) {
    Words expected{"sweep", "collect"};
    expected.insert(expected.end(), words.begin(), words.end());
    EXPECT_EQ(read(words), expected);
  }
  EXPECT_EQ(read({"--movie", "webm", "--movie-quality", "80"}),
            (Words{"sweep", "collect", "--movie", "vp9"}));
}

TEST_F(Cli, WordsAreReadInEveryWayThatShellsWriteThem) {
  for (const Words& words :
       {Words{"--frames", "2-3", "--quiet", "s.toml"}, Words{"s.toml", "--frames=2-3", "-q"},
        Words{"-q", "--frames", "2-3", "--", "s.toml"}, Words{"-qq", "--frames=2-3", "s.toml"}}) {
    app::run::RenderOptions options;
    app::options::Command command;
    describe(command, options);
    EXPECT_EQ(app::options::parse(command, words), Words{});
    EXPECT_EQ(app::options::shell_line(app::options::words_of(options)),
              "neve render s.toml --frames 2-3 --quiet");
  }
  app::sweep::plan::SweepOptions options;
  app::options::Command command;
  describe(command, options);
  EXPECT_EQ(app::options::parse(
                command, {"-pseed=1,2", "-p", "fps=24", "-p=frames=1", "--nope", "s.toml", "more"}),
            (Words{"--nope", "more"}));
  EXPECT_TRUE(options.axes.empty()) << "nothing is read where a word is wrong";
}

/// Flags behind "neve COMMAND" in a line of a page.
void check_flags(const std::string& line, const std::string& place, Entry& root, int& flags) {
  const std::regex call(R"((?:^|[`\s(/])neve ([a-z]+)((?: [^`|#;]*)?))");
  for (std::sregex_iterator at(line.begin(), line.end(), call), end; at != end; ++at) {
    Entry* entry = root.part((*at)[1]);
    if (!entry) continue;
    const std::string words = (*at)[2];
    const std::regex flag(R"((?:^|[\s\[])(--[a-z][a-z-]*))");
    for (std::sregex_iterator f(words.begin(), words.end(), flag); f != end; ++f) {
      const std::string name = (*f)[1];
      bool is_known = entry->command.find(name) != nullptr;
      for (const Entry& part : entry->parts) is_known |= part.command.find(name) != nullptr;
      EXPECT_TRUE(is_known) << place << ": neve " << entry->name() << " has no " << name;
      ++flags;
    }
  }
}

/// Advice where a file cannot be written: --out only where the command has it, NEVE_OUT only where
/// outputs go there.
TEST(Options, OfAdviceOnAnotherPlaceExist) {
  for_each_command(app::cli::program(), [&](const Words& path) {
    const app::options::Command command = fresh(path).command;
    std::istringstream words(command.other_place);
    for (std::string word; words >> word;) {
      if (word.starts_with("--")) {
        EXPECT_TRUE(command.find(word)) << command.name << ": " << command.other_place;
      }
      if (word == "NEVE_OUT") {
        EXPECT_TRUE(contains(command.find("--out")->help, "instead of out/")) << command.name;
      }
    }
  });
}

TEST(Options, OfTheDocumentsExist) {
  namespace fs = std::filesystem;
  std::vector<fs::path> pages{fs::path(NEVE_SOURCE_DIR) / "README.md"};
  for (const auto& entry : fs::directory_iterator(fs::path(NEVE_SOURCE_DIR) / "docs"))
    // The pages of mistakes have wrong ones.
    if (entry.path().extension() == ".md" && entry.path().stem() != "answers" &&
        entry.path().stem() != "trial")
      pages.push_back(entry.path());
  Entry root = app::cli::program();
  int flags = 0;
  for (const fs::path& page : pages) {
    std::istringstream lines(read_text(page));
    std::string whole;
    for (std::string line; std::getline(lines, line);) {
      whole += line;
      if (whole.ends_with('\\')) {
        whole.pop_back();
        continue;
      }
      check_flags(whole, page.filename().string(), root, flags);
      whole.clear();
    }
  }
  EXPECT_GT(flags, 100);
}

}  // namespace
}  // namespace neve::test

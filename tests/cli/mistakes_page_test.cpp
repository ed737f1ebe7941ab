/// The answers in docs/answers.md are those of the program.

#include <cstring>
#include <sstream>

#include "app/output/atomic_file.h"
#include "app/support/errors.h"
#include "tests/cli/run_neve.h"

namespace neve::test {
namespace {

const std::filesystem::path page_folder = std::filesystem::path(NEVE_SOURCE_DIR) / "docs/answers";

/// Lines that are not empty, with another word for the folder of the test.
std::vector<std::string> answer_lines(const std::string& text, const std::string& folder) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) {
    for (std::size_t at; (at = line.find(folder)) != std::string::npos;)
      line.replace(at, folder.size(), "FOLDER");
    if (line.find_first_not_of(" \t") != std::string::npos) lines.push_back(line);
  }
  return lines;
}

/// Returns the lines on standard error; without any, the warnings and errors of neve check.
std::vector<std::string> answer_of(const app::output::ProcessResult& result,
                                   const std::string& folder) {
  std::vector<std::string> said = answer_lines(result.errors, folder);
  if (!said.empty()) return said;
  said = answer_lines(result.output, folder);
  std::erase_if(said, [](const std::string& line) {
    return !contains(line, "warning") && !contains(line, "error");
  });
  return said;
}

TEST(MistakesPage, EveryAnswerIsTheProgramsOwn) {
  const app::Json entries = app::parse_json(read_text(page_folder / "answers.json"));
  const std::string page = read_text(page_folder / "../answers.md");
  EXPECT_GE(entries.size(), 131u);
  EXPECT_TRUE(contains(read_text(page_folder / "../../README.md"),
                       "answers to " + std::to_string(entries.size()) + " mistakes"));
  for (const app::Json& entry : entries) {
    const TemporaryFolder folder;
    for (const auto& [name, content] : entry["files"].items())
      folder.write(name, content.get<std::string>());
    const auto arguments = entry["arguments"].get<std::vector<std::string>>();
    const auto result = app::output::run_process(NEVE_BINARY, arguments, folder.path());
    const std::string name = entry.dump();
    EXPECT_EQ(result.exit_code, entry["exit_code"].get<int>()) << name;
    const auto said = answer_of(result, std::filesystem::canonical(folder.path()).string());
    EXPECT_EQ(said, entry["answer"].get<std::vector<std::string>>()) << name;
    EXPECT_FALSE(said.empty()) << name << ": a mistake has an answer";
    for (std::string line : said) {
      for (const auto& [sign, other] : {std::pair{"|", "\\|"}, std::pair{"`", "'"}})
        for (std::size_t at = 0; (at = line.find(sign, at)) != std::string::npos;
             at += std::strlen(other))
          line.replace(at, 1, other);
      EXPECT_TRUE(contains(page, line)) << "docs/answers/make writes the page: " << line;
    }
  }
}

}  // namespace
}  // namespace neve::test

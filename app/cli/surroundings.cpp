#include "app/cli/command_line.h"

#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <iostream>

#include "app/advice/suggest.h"
#include "app/support/machine.h"
#include "app/support/progress.h"
#include "app/support/text.h"

namespace neve::app::cli {

namespace {

/// Variables that the program reads; tests and the launcher read more.
const std::vector<std::string> known{"NEVE_OUT", "NEVE_MAX_MEMORY", "NEVE_MAX_PARTICLES",
                                     "NEVE_SIMD", "NEVE_PARTICLES"};

/// "--max-views" of NEVE_MAX_VIEWS.
std::string flag_like(std::string variable) {
  variable.erase(0, std::string("NEVE_").size());
  for (char& c : variable)
    c = c == '_' ? '-' : static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return "--" + variable;
}

/// "" if the number fits the machine.
std::string many_threads(const options::Command& command) {
  constexpr int worth_a_word = 4;
  const options::Option* option = command.find("--threads");
  if (!option || !option->is_given()) return {};
  const int threads = number_of<int>(option->given.front()).value_or(0), cores = core_count(0);
  if (threads <= worth_a_word * cores) return {};
  return fmt::format(
      "--threads {}: this machine has {}; more threads take memory and time and gain nothing",
      threads, count_text(cores, "core"));
}

/// Sentences on variables that look like those of neve and are read by nothing.
/// @param environment  "NAME=VALUE"
/// @param flags        of the command, as in "--threads"
std::vector<std::string> misnamed_variables(const std::vector<std::string>& environment,
                                            const std::vector<std::string>& flags) {
  std::vector<std::string> sentences;
  for (const std::string& variable : environment) {
    const std::string name = variable.substr(0, variable.find('='));
    if (!name.starts_with("NEVE_") || std::find(known.begin(), known.end(), name) != known.end())
      continue;
    const std::string question = advice::suggest(name, {"", known}), flag = flag_like(name);
    if (std::find(flags.begin(), flags.end(), flag) != flags.end())
      sentences.push_back(name + " in the environment is not read; use " + flag);
    else if (!question.empty())
      sentences.push_back(name + " in the environment is not read; " + question);
  }
  return sentences;
}

}  // namespace

void warn_of_surroundings(const options::Command& command, const ErrorOutput& output) {
  std::vector<std::string> environment;
  for (char** variable = environ; *variable; ++variable) environment.emplace_back(*variable);
  std::vector<std::string> sentences = misnamed_variables(environment, command.flags());
  if (std::string threads = many_threads(command); !threads.empty())
    sentences.push_back(std::move(threads));
  if (sentences.empty()) return;
  Progress progress(std::cerr, Verbosity::quiet, false, {output.is_progress_json, output.log});
  for (const std::string& sentence : sentences) progress.warning(sentence);
}

}  // namespace neve::app::cli

#include "app/cli/usage_hints.h"

#include <algorithm>
#include <utility>

#include "app/setup/foreign_flags.h"
#include "app/support/errors.h"
#include "app/support/text.h"

namespace neve::app::cli {

namespace {

std::string suggestion(const std::string& wrong, const std::vector<std::string>& names,
                       const std::string& otherwise) {
  const std::string nearest = nearest_name(wrong, names);
  return nearest.empty() ? otherwise : "did you mean " + nearest + "?";
}

/// Names in other programs, with the options here; the first existing option wins.
constexpr std::pair<const char*, const char*> names_elsewhere[] = {{"-o", "--out"},
                                                                   {"--output", "--out"},
                                                                   {"--output-dir", "--out"},
                                                                   {"-j", "--jobs"},
                                                                   {"-j", "--threads"},
                                                                   {"--jobs", "--threads"},
                                                                   {"-t", "--threads"},
                                                                   {"--cores", "--threads"},
                                                                   {"-f", "--frames"},
                                                                   {"-s", "--set"},
                                                                   {"-n", "--dry-run"},
                                                                   {"-V", "--version"},
                                                                   {"--resolution", "--size"},
                                                                   {"--port", "--listen"}};

std::string hint_for(const std::string& word, const std::vector<std::string>& flags,
                     const std::string& otherwise) {
  const auto is_flag = [&](const std::string& name) {
    return std::find(flags.begin(), flags.end(), name) != flags.end();
  };
  // Sweeps, collects and exports go on by themselves.
  if (word == "--resume" && !is_flag(word)) return "the same command continues; leave it away";
  for (const auto& [other, ours] : names_elsewhere)
    if (word == other && is_flag(ours)) return std::string("did you mean ") + ours + "?";
  if (std::string advice = setup::foreign_flag_advice(word, flags); !advice.empty()) return advice;
  const std::string nearest = nearest_name(word, flags);
  if (!nearest.empty()) return "did you mean " + nearest + "?";
  // The beginning of exactly one.
  std::vector<std::string> longer;
  for (const std::string& flag : flags)
    if (word.size() > 3 && flag.starts_with(word)) longer.push_back(flag);
  return longer.size() == 1 ? "did you mean " + longer.front() + "?" : otherwise;
}

struct Expected {
  const char *flag, *text;
};

/// Where "a number" says too little.
constexpr Expected expectations[] = {
    {"--threads", "a whole number; 0 is one thread per core, the default"},
    {"--jobs", "a whole number; 0 is as many as keep the cores busy, the default"},
    {"--checkpoint-every", "a whole number of frames"},
    {"--shutter", "degrees without a unit, as in --shutter 180"},
    {"--scale", "a number: units per metre, as in --scale 100 for centimetres"},
    {"--surface-cell", "a number of particle spacings, as in --surface-cell 0.5"},
    {"--surface-smoothing", "a number of particle spacings, as in --surface-smoothing 1"},
    {"--wipe", "a share of the width, as in --wipe 0.3"},
    {"--range", "a number of metres, as in --range 0.1"}};

std::string expectation_of(const std::string& option, bool is_fraction) {
  for (const Expected& known : expectations)
    if (option == known.flag) return known.text;
  return is_fraction ? "a number" : "a whole number";
}

/// The innermost command that was called, with those above it in its name.
std::pair<const CLI::App*, std::string> called(const CLI::App& app) {
  std::pair<const CLI::App*, std::string> inner{&app, app.get_name()};
  while (!inner.first->get_subcommands().empty()) {
    const CLI::App* next = inner.first->get_subcommands().front();
    inner = {next, inner.second + " " + next->get_name()};
  }
  return inner;
}

/// "$SCENE" of a shell in which SCENE is not set must not mean the default.
void check_empty_names(const CLI::App& command) {
  for (const CLI::Option* option : command.get_options())
    for (const std::string& word : option->results())
      if (option->get_positional() && word.empty())
        throw UsageError(option->get_name(), "the name is empty",
                         "expected a file or folder; is a variable of the shell not "
                         "set?");
}

/// @param name of the command with those above it
void check_leftovers_of(const CLI::App& command, const std::string& name) {
  for (const CLI::App* inner : command.get_subcommands())
    check_leftovers_of(*inner, name + " " + inner->get_name());
  check_empty_names(command);
  std::vector<std::string> leftovers = command.remaining();
  // What follows -- is no option; it has been taken already.
  std::erase(leftovers, "--");
  if (leftovers.empty()) return;
  const std::string help = name + " --help lists its arguments";
  std::vector<std::string> flags;
  for (const CLI::Option* option : command.get_options())
    for (const std::string& flag : option->get_lnames()) flags.push_back("--" + flag);
  std::string word = leftovers.front();
  if (!word.starts_with("-")) {
    const std::string advice = setup::stray_word_advice(word, flags);
    throw UsageError("", "unexpected argument \"" + word + "\"", advice.empty() ? help : advice);
  }
  word = word.starts_with("--") ? word.substr(0, word.find('=')) : word.substr(0, 2);
  throw UsageError("", "unknown option " + word, hint_for(word, flags, help));
}

}  // namespace

std::vector<std::string> subcommand_names(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::App* inner : command.get_subcommands([](const CLI::App*) { return true; }))
    names.push_back(inner->get_name());
  return names;
}

void check_subcommand(const CLI::App& app, int argc, char** argv) {
  if (argc < 2) return;
  const std::string word = argv[1];
  const std::vector<std::string> names = subcommand_names(app);
  if (word.starts_with("-")) return;
  if (word == "completion" || word == "completions" || word == "man")
    throw UsageError(
        "", "unknown subcommand \"" + word + "\"",
        "neve manual DIR writes the manual pages and the completions for bash, zsh and fish");
  const bool is_file = word.ends_with(".toml") || word.ends_with(".png");
  const std::string meant = is_file ? "neve render " + word : setup::command_meant(word);
  if (!meant.empty())
    throw UsageError("", "unknown subcommand \"" + word + "\"", "did you mean " + meant + "?");
  if (std::find(names.begin(), names.end(), word) == names.end())
    throw UsageError("", "unknown subcommand \"" + word + "\"",
                     suggestion(word, names, "neve --help lists them"));
  const CLI::App& command = *app.get_subcommand(word);
  const std::vector<std::string> parts = subcommand_names(command);
  if (command.get_require_subcommand_min() == 0) return;
  const std::string known = joined(parts, ", ");
  const std::string part = argc < 3 ? "" : argv[2];
  if (part == "-h" || part == "--help" ||
      std::find(parts.begin(), parts.end(), part) != parts.end())
    return;
  if (part.empty() || part.starts_with("-"))
    throw UsageError(word, "which part?", "expected one of " + known);
  throw UsageError(word + " " + part, "unknown part", "expected one of " + known);
}

void fail_parse(const CLI::App& app, const CLI::ParseError& error) {
  const auto [command, name] = called(app);
  const std::string help = "see " + name + " --help", conversion = "Could not convert: ";
  std::string text = error.what();
  // "--at: At Most 1 required but received 2"
  const std::string too_many = ": At Most 1 required but received ";
  if (const std::size_t at = text.find(too_many); at != std::string::npos)
    throw UsageError(text.substr(0, at),
                     "takes one value and was given " + text.substr(at + too_many.size()), help);
  // "fast was given a disallowed flag override": --fast=no
  if (const std::size_t at = text.find(" was given a disallowed flag"); at != std::string::npos)
    throw UsageError("--" + text.substr(0, at), "takes no value",
                     "it is on where it is given; " + help);
  // "--progress: 1 required NAME missing"
  if (const std::size_t at = text.find(": 1 required "); at != std::string::npos)
    throw UsageError(
        text.substr(0, at), "has no value",
        "expected " + text.substr(at + 13, text.rfind(" missing") - at - 13) + "; " + help);
  // "NAME is required"
  if (const std::size_t at = text.find(" is required"); at != std::string::npos)
    throw UsageError("", name + " needs " + text.substr(0, at), help);
  // "The following argument was not expected: --json"
  const std::string unexpected = "not expected: ";
  if (const std::size_t at = text.find(unexpected); at != std::string::npos)
    throw UsageError("", "no command is before " + text.substr(at + unexpected.size()),
                     "flags follow the command, as in neve render SCENE --quiet");
  if (!text.starts_with(conversion)) throw UsageError("", text, help);
  // "Could not convert: --threads = x"
  text.erase(0, conversion.size());
  const std::size_t equals = text.find(" = ");
  const std::string option = text.substr(0, equals);
  const std::string value = equals == std::string::npos ? "" : text.substr(equals + 3);
  const CLI::Option* found = command->get_option_no_throw(option);
  // Only MEAN is a fraction.
  const bool is_fraction = found && found->get_type_name() == "MEAN";
  throw UsageError(option, "cannot use \"" + value + "\"",
                   "expected " + expectation_of(option, is_fraction) + "; " + help);
}

void check_leftovers(const CLI::App& app) {
  check_leftovers_of(app, app.get_name());
}

std::string help_of(const CLI::App& app, const std::vector<std::string>& words) {
  const CLI::App* command = &app;
  std::string name;
  for (const std::string& word : words) {
    if (word.starts_with("-")) continue;  // neve help --help
    const std::vector<std::string> names = subcommand_names(*command);
    name += (name.empty() ? "" : " ") + command->get_name();
    if (std::find(names.begin(), names.end(), word) == names.end())
      throw UsageError("help", "there is no " + name + " " + word,
                       suggestion(word, names, name + " --help lists them"));
    command = command->get_subcommand(word);
  }
  return command->help(name);
}

}  // namespace neve::app::cli

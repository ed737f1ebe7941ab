#include "app/cli/usage_hints.h"

#include <algorithm>
#include <utility>

#include "app/advice/suggest.h"
#include "app/scene/search.h"
#include "app/scene/toml/error.h"
#include "app/support/text.h"

namespace neve::app::cli {

namespace {

bool has_flag(const std::vector<std::string>& flags, const std::string& flag) {
  return std::find(flags.begin(), flags.end(), flag) != flags.end();
}

/// @param value that was typed; "VALUE" where it is not known
std::string as_setting(const std::string& word, const std::string& value,
                       const std::vector<std::string>& flags) {
  if (!has_flag(flags, "--set")) return {};
  const std::vector<std::string> addresses = scene::parameters_named(word);
  if (addresses.empty()) return {};
  if (addresses.size() == 1) return "it is a parameter: --set " + addresses.front() + "=" + value;
  return "several parameters have this name; neve params " + word + " lists them, for --set";
}

/// The first line of the table that the command has a flag for; "": none.
std::string from_table(const std::string& word, const std::vector<std::string>& flags) {
  for (const advice::Entry& entry : advice::entries_of("flag")) {
    if (!entry.has(word) || (!entry.flag.empty() && !has_flag(flags, entry.flag))) continue;
    if (!entry.sentence.empty()) return entry.sentence;
    for (const std::string& name : entry.names)
      if (has_flag(flags, name)) return advice::did_you_mean(name);
  }
  return {};
}

/// The only flag that begins so.
std::string longer_flag(const std::string& word, const std::vector<std::string>& flags) {
  std::vector<std::string> longer;
  for (const std::string& flag : flags)
    if (word.size() > 3 && flag.starts_with(word)) longer.push_back(flag);
  return longer.size() == 1 ? longer.front() : "";
}

/// What an unknown flag is here, and how to write it.
/// @param word   "--motion-blur", without a value
/// @param flags  of the command
std::string flag_advice(const std::string& word, const std::vector<std::string>& flags,
                        const std::string& otherwise) {
  if (std::string known = from_table(word, flags); !known.empty()) return known;
  if (word.starts_with("--")) {
    std::string name = word.substr(2);
    std::replace(name.begin(), name.end(), '-', '_');
    if (std::string setting = as_setting(name, "VALUE", flags); !setting.empty()) return setting;
  }
  std::string nearest = advice::nearest_name(word, flags);
  if (nearest.empty()) nearest = longer_flag(word, flags);
  return nearest.empty() ? otherwise : advice::did_you_mean(nearest);
}

/// Advice for a word that no flag takes: "hardening=5". "": nothing is known.
std::string stray_word_advice(const std::string& word, const std::vector<std::string>& flags) {
  const std::size_t equals = word.find('=');
  if (equals != std::string::npos && equals > 0)
    return as_setting(word.substr(0, equals), word.substr(equals + 1), flags);
  if (word.ends_with(".toml") && has_flag(flags, "--set"))
    return "one scene at a time; a loop of the shell takes several: for s in *.toml; do neve ... "
           "$s; done";
  return has_flag(flags, "--shard")
             ? "values of -p have commas between them and no blanks, as in -p "
               "ADDRESS=A,B"
             : "";
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
        throw scene::toml::UsageError(option->get_name(), "the name is empty",
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
    const std::string hint = stray_word_advice(word, flags);
    throw scene::toml::UsageError("", "unexpected argument \"" + word + "\"",
                                  hint.empty() ? help : hint);
  }
  word = word.starts_with("--") ? word.substr(0, word.find('=')) : word.substr(0, 2);
  throw scene::toml::UsageError("", "unknown option " + word, flag_advice(word, flags, help));
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
    throw scene::toml::UsageError(
        "", "unknown subcommand \"" + word + "\"",
        "neve manual DIR writes the manual pages and the completions for bash, zsh and fish");
  const bool is_file = word.ends_with(".toml") || word.ends_with(".png");
  if (std::find(names.begin(), names.end(), word) == names.end())
    throw scene::toml::UsageError(
        "", "unknown subcommand \"" + word + "\"",
        is_file ? advice::did_you_mean("neve render " + word)
                : advice::suggest(word, {"command", names}, "neve --help lists them"));
  const CLI::App& command = *app.get_subcommand(word);
  const std::vector<std::string> parts = subcommand_names(command);
  if (command.get_require_subcommand_min() == 0) return;
  const std::string known = joined(parts, ", ");
  const std::string part = argc < 3 ? "" : argv[2];
  if (part == "-h" || part == "--help" ||
      std::find(parts.begin(), parts.end(), part) != parts.end())
    return;
  if (part.empty() || part.starts_with("-"))
    throw scene::toml::UsageError(word, "which part?", "expected one of " + known);
  throw scene::toml::UsageError(word + " " + part, "unknown part", "expected one of " + known);
}

void fail_parse(const CLI::App& app, const CLI::ParseError& error) {
  const auto [command, name] = called(app);
  const std::string help = "see " + name + " --help", conversion = "Could not convert: ";
  std::string text = error.what();
  // "--at: At Most 1 required but received 2"
  const std::string too_many = ": At Most 1 required but received ";
  if (const std::size_t at = text.find(too_many); at != std::string::npos)
    throw scene::toml::UsageError(
        text.substr(0, at), "takes one value and was given " + text.substr(at + too_many.size()),
        help);
  // "fast was given a disallowed flag override": --fast=no
  if (const std::size_t at = text.find(" was given a disallowed flag"); at != std::string::npos)
    throw scene::toml::UsageError("--" + text.substr(0, at), "takes no value",
                                  "it is on where it is given; " + help);
  // "--progress: 1 required NAME missing"
  if (const std::size_t at = text.find(": 1 required "); at != std::string::npos)
    throw scene::toml::UsageError(
        text.substr(0, at), "has no value",
        "expected " + text.substr(at + 13, text.rfind(" missing") - at - 13) + "; " + help);
  // "NAME is required"
  if (const std::size_t at = text.find(" is required"); at != std::string::npos)
    throw scene::toml::UsageError("", name + " needs " + text.substr(0, at), help);
  // "The following argument was not expected: --json"
  const std::string unexpected = "not expected: ";
  if (const std::size_t at = text.find(unexpected); at != std::string::npos)
    throw scene::toml::UsageError("", "no command is before " + text.substr(at + unexpected.size()),
                                  "flags follow the command, as in neve render SCENE --quiet");
  if (!text.starts_with(conversion)) throw scene::toml::UsageError("", text, help);
  // "Could not convert: --threads = x"
  text.erase(0, conversion.size());
  const std::size_t equals = text.find(" = ");
  const std::string option = text.substr(0, equals);
  const std::string value = equals == std::string::npos ? "" : text.substr(equals + 3);
  const CLI::Option* found = command->get_option_no_throw(option);
  const advice::Entry* known = advice::entry_of("value of a flag", option);
  // Only MEAN is a fraction.
  const bool is_fraction = found && found->get_type_name() == "MEAN";
  throw scene::toml::UsageError(option, "cannot use \"" + value + "\"",
                                "expected " +
                                    (known         ? known->sentence
                                     : is_fraction ? "a number"
                                                   : "a whole number") +
                                    "; " + help);
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
      throw scene::toml::UsageError(
          "help", "there is no " + name + " " + word,
          advice::suggest(word, {"command", names}, name + " --help lists them"));
    command = command->get_subcommand(word);
  }
  return command->help(name);
}

}  // namespace neve::app::cli

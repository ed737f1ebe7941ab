#include "app/cli/command_line.h"

#include <algorithm>
#include <filesystem>

#include "app/advice/suggest.h"
#include "app/scene/search.h"
#include "app/support/errors.h"
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

/// "--flag" of "--flag=VALUE"; "-size" where --size is meant, else the first letter that is no
/// flag.
std::string unknown_flag(const options::Command& command, const std::string& word) {
  std::string flag = word.substr(0, word.find('='));
  if (word.starts_with("--") || command.find("-" + flag)) return flag;
  const auto letter = std::find_if(word.begin() + 1, word.end(), [&](char c) {
    return !command.find({'-', c});
  });
  return letter == word.end() ? flag : std::string{'-', *letter};
}

/// The only flag that begins so.
std::string longer_flag(const std::string& word, const std::vector<std::string>& flags) {
  std::vector<std::string> longer;
  for (const std::string& flag : flags)
    if (word.size() > 3 && flag.starts_with(word)) longer.push_back(flag);
  return longer.size() == 1 ? longer.front() : "";
}

/// Tells what an unknown flag is here, and how to write it.
/// @param word   "--motion-blur", without a value
/// @param flags  of the command
std::string flag_advice(const std::string& word, const std::vector<std::string>& flags,
                        const std::string& otherwise) {
  if (has_flag(flags, "-" + word)) return advice::did_you_mean("-" + word);
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
    return "a command takes one scene; a loop of the shell runs it for several: for s in *.toml; "
           "do neve ... "
           "$s; done";
  return has_flag(flags, "--shard")
             ? "separate the values of -p by commas without blanks, as in -p ADDRESS=A,B"
             : "";
}

/// A word for the manual pages, or a file.
void refuse_known_word(const std::string& word) {
  const std::string unknown = "unknown subcommand \"" + word + "\"";
  if (word == "completion" || word == "completions" || word == "man")
    throw UsageError(
        "", unknown,
        "neve manual DIR writes the manual pages and the completions for bash, zsh and fish");
  if (word.ends_with(".toml") || word.ends_with(".png"))
    throw UsageError("", unknown, advice::did_you_mean("neve render " + word));
}

/// A scene has another name, or is there.
void refuse_near_part(const Entry& entry, const std::string& word) {
  std::error_code error;
  if (word.empty() || word.find_first_of("-./=") != std::string::npos ||
      std::filesystem::exists(word, error))
    return;
  const std::string nearest = advice::nearest_name(word, entry.part_names());
  if (!nearest.empty())
    throw UsageError(entry.name() + " " + word, "unknown subcommand, and no file",
                     advice::did_you_mean("neve " + entry.name() + " " + nearest));
}

}  // namespace

void check_command(Entry& program, const std::vector<std::string>& words) {
  const std::string& word = words.front();
  if (word.starts_with("-"))
    throw UsageError("", "no command comes before " + word,
                     "flags follow the command, as in neve render SCENE --quiet");
  Entry* entry = program.part(word);
  if (!entry) {
    refuse_known_word(word);
    throw UsageError(
        "", "unknown subcommand \"" + word + "\"",
        advice::suggest(word, {"command", program.part_names()}, "neve --help lists them"));
  }
  const std::string part = words.size() > 1 ? words[1] : "";
  if (part == "-h" || part == "--help" || entry->part(part)) return;
  if (entry->run) return refuse_near_part(*entry, part);
  const std::string known = "expected one of " + joined(entry->part_names(), ", ");
  if (part.empty() || part.starts_with("-"))
    throw UsageError(word, "a subcommand is missing", known);
  throw UsageError(word + " " + part, "unknown subcommand", known);
}

void refuse_leftover(const Entry& entry, const std::string& word) {
  const std::vector<std::string> flags = entry.command.flags();
  const std::string help = entry.command.full_name() + " --help lists its arguments";
  if (word.starts_with("-")) {
    const std::string flag = unknown_flag(entry.command, word);
    std::error_code error;
    throw UsageError("", "unknown option " + flag,
                     std::filesystem::exists(word, error) ? "the file of this name is ./" + word
                                                          : flag_advice(flag, flags, help));
  }
  std::string hint = entry.command.advice_for(word);
  if (hint.empty()) hint = stray_word_advice(word, flags);
  throw UsageError("", "unexpected argument \"" + word + "\"", hint.empty() ? help : hint);
}

void refuse_help(const Entry& entry, const std::string& word) {
  const std::string name = entry.command.full_name();
  throw UsageError(
      "help", "there is no " + name + " " + word,
      advice::suggest(word, {"command", entry.part_names()}, name + " --help lists them"));
}

}  // namespace neve::app::cli

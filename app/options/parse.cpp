#include "app/options/option.h"

#include <algorithm>

#include "app/support/errors.h"

namespace neve::app::options {

namespace {

class Parser {
 public:
  Parser(Command& command, const std::vector<std::string>& words)
      : command_(command), words_(words), help_("; see " + command.full_name() + " --help") {}

  std::vector<std::string> run() {
    bool has_flags = true;
    while (at_ < words_.size()) {
      const std::string& word = words_[at_++];
      if (has_flags && word == "--")
        has_flags = false;
      else if (!has_flags || !word.starts_with('-') || word == "-")
        take_argument(word);
      else if (word.starts_with("--"))
        take_flag(word);
      else
        take_letters(word);
    }
    if (leftovers_.empty()) read_values();
    return leftovers_;
  }

 private:
  void take_argument(const std::string& word) {
    for (Option& option : command_.options) {
      if (!option.is_argument() || (option.is_given() && !option.is_repeatable)) continue;
      // "$SCENE" of a shell in which SCENE is not set must not mean the default.
      if (word.empty())
        throw UsageError(option.name(), "is empty", "is a variable of the shell not set?");
      return option.given.push_back(word);
    }
    leftovers_.push_back(word);
  }

  /// "--flag", "--flag=VALUE"
  void take_flag(const std::string& word) {
    const std::size_t equals = std::min(word.find('='), word.size());
    Option* option = command_.find(word.substr(0, equals));
    if (!option) return leftovers_.push_back(word);
    if (equals == word.size()) return take_value(*option);
    if (option->is_flag) refuse_value(*option, word.substr(equals + 1));
    if (equals + 1 == word.size()) refuse_missing(*option, "");
    option->given.push_back(word.substr(equals + 1));
  }

  /// "-q", "-qv", "-p VALUE", "-pVALUE"
  void take_letters(const std::string& word) {
    for (std::size_t k = 1; k < word.size(); ++k) {
      Option* option = command_.find({'-', word[k]});
      if (!option) return leftovers_.push_back(word);
      if (!option->is_flag && k + 1 < word.size())
        return option->given.push_back(word.substr(k + (word[k + 1] == '=' ? 2 : 1)));
      take_value(*option);
    }
  }

  /// The next word, for an option that has a value.
  void take_value(Option& option) {
    if (!option.needs_value()) return option.given.push_back(option.alone);
    if (at_ == words_.size()) refuse_missing(option, "");
    const std::string& word = words_[at_++];
    if (word.starts_with('-') && command_.find(word.substr(0, word.find('='))))
      refuse_missing(option, ": the flag " + word + " follows it");
    option.given.push_back(word);
  }

  [[noreturn]] void refuse_missing(const Option& option, const std::string& why) const {
    const std::string example =
        option.example.empty() ? "" : ", as in " + option.name() + " " + option.example;
    throw UsageError(option.name(), "has no value" + why,
                     "expected " + option.type + example + help_);
  }

  [[noreturn]] void refuse_value(Option& option, const std::string& value) const {
    option.given.emplace_back();
    const std::string advice = command_.advice_for(value);
    throw UsageError(option.name(), "takes no value",
                     advice.empty() ? "the flag alone turns it on" + help_ : advice);
  }

  void read_values() {
    for (const Option& option : command_.options) {
      const std::size_t count = option.given.size();
      if (count > 1 && !option.is_flag && !option.is_repeatable)
        throw UsageError(option.name(), "takes one value and was given " + std::to_string(count),
                         help_.substr(2));
      for (const std::string& value : option.given) option.read(value);
    }
  }

  Command& command_;
  const std::vector<std::string>& words_;
  std::string help_;
  std::size_t at_ = 0;
  std::vector<std::string> leftovers_;
};

}  // namespace

std::vector<std::string> parse(Command& command, const std::vector<std::string>& words) {
  return Parser(command, words).run();
}

}  // namespace neve::app::options

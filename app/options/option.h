#pragma once
/// Every option of every command, once.
///
/// A struct of options has a function `describe(Command&, Options&)` that visits its members:
///   visit.about(name, help)                   the command: "sweep run"
///   visit(names, member, language, help)      an option with a value, in the language of the value
///   visit(names, member, help)                a flag that is on where it is given
///   visit.sets(names, member, value, help)    a flag that sets another value than true
///   visit.custom(...)                         one that several members keep
///   visit.check(function)                     to be called when all words have been read
/// Parser, --help, man pages, completions, JSON and the words for child processes read the list
/// that the visits make; there is no second one.

#include <algorithm>
#include <functional>
#include <iterator>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "app/support/json.h"
#include "app/support/out_folder.h"

namespace neve::app::options {

/// A value as text: how it is read, and written so that it is read as the same.
template <class T>
struct Language {
  std::string type;     ///< as help shows it: "A-B"
  std::string example;  ///< of a value: "1-48"
  std::function<T(const std::string& flag, const std::string& text)> read;  ///< throws UsageError
  std::function<std::string(const T&)> write;
};

/// A flag of a command, or an argument.
struct Option {
  /// Names as typed, the usual one first: {"-p", "--parameter"}; of an argument {"SCENE"}.
  std::vector<std::string> names;
  std::string type, example, help;
  std::string alone;  ///< value where it is given without one; otherwise after "=" only
  bool is_flag = false, is_repeatable = false, is_required = false, shows_default = false;
  std::function<void(const std::string&)> read;     ///< one value
  std::function<std::vector<std::string>()> write;  ///< all values; of a flag that is on one, ""
  std::vector<std::string> given;                   ///< values on the command line

  /// Refuses it with any of these flags, or without all of them.
  struct Rule {
    bool is_with;
    std::vector<std::string> flags;
    std::string message, hint;
  };
  std::vector<Rule> rules;

  bool is_given() const { return !given.empty(); }
  bool is_argument() const { return !names.front().starts_with('-'); }
  bool needs_value() const { return !is_flag && alone.empty(); }
  const std::string& name() const { return names.front(); }
  /// "--parameter"; "" for an argument
  std::string long_name() const;
  /// The default, as a list for several; "" if there is none.
  std::string default_text() const;

  /// Lets the option have one value, although the member holds several.
  Option& once() { return is_repeatable = false, *this; }
  Option& required() { return is_required = true, *this; }
  Option& with_default() { return shows_default = true, *this; }
  /// Gives the value that the option has if it is given without one.
  Option& or_alone(const std::string& value) { return alone = value, *this; }
  Option& excludes(const std::vector<std::string>& flags, const std::string& hint);
  Option& needs(const std::string& flag, const std::string& message, const std::string& hint) {
    return rules.push_back({false, {flag}, message, hint}), *this;
  }
};

/// A command and its options, bound to the struct that was visited.
struct Command {
  std::string name, help;  ///< "sweep run"
  std::vector<Option> options;
  /// Advice where a file cannot be written, see or_other_place().
  std::string other_place = usual_other_place;
  std::vector<std::function<void()>> checks;  ///< called when all words have been read
  /// Advice on a word that no option takes, or that a flag without a value was given as one; "":
  /// nothing is known.
  std::function<std::string(const Command&, const std::string& word)> word_advice{};

  void about(const std::string& command, const std::string& sentence);

  /// @param member  a T; an optional T, absent where it is not given; or Ts, of a repeatable option
  template <class Member, class T>
  Option& operator()(const char* names, Member& member, const Language<T>& language,
                     const std::string& sentence);
  Option& operator()(const char* names, bool& member, const std::string& sentence) {
    return sets(names, member, true, sentence);
  }
  template <class T>
  Option& sets(const char* names, T& member, T value, const std::string& sentence);
  /// An option that several members keep. @param write  "" if it is not needed
  Option& custom(const char* names, const std::string& type, const std::string& example,
                 std::function<void(const std::string&)> read, std::function<std::string()> write,
                 const std::string& sentence);
  void check(std::function<void()> function) { checks.push_back(std::move(function)); }

  /// "neve sweep run"
  std::string full_name() const { return name.empty() ? "neve" : "neve " + name; }
  /// Finds an option by any of its names; null if there is none.
  Option* find(const std::string& name);
  const Option* find(const std::string& name) const {
    return const_cast<Command*>(this)->find(name);
  }
  bool has_given(const std::string& name) const {
    const Option* option = find(name);
    return option && option->is_given();
  }
  /// See word_advice.
  std::string advice_for(const std::string& word) const {
    return word_advice ? word_advice(*this, word) : "";
  }
  /// Names of all flags: "--frames".
  std::vector<std::string> flags() const;
  /// Holds the rules between options, and calls the checks. @throws UsageError
  void check_all() const;

  /// An option that is neither read nor written yet.
  Option& add(const char* names, const std::string& type, const std::string& example,
              const std::string& sentence);
};

/// @throws UsageError where an output would replace a file that is read
void refuse_input(const std::string& flag, const std::string& output, const std::string& input);

/// Reads words as they follow the name of the command: "--flag VALUE", "--flag=VALUE", "-fVALUE",
/// "-qv", arguments in their order; after "--" all words are arguments. Command::check_all() is
/// left to the caller.
/// @return words that no option takes; then no value has been read @throws UsageError
std::vector<std::string> parse(Command& command, const std::vector<std::string>& words);

/// The options of a command for people.
/// @param parts  commands below it
/// @param width  of the lines; 0: they are not broken
std::string help_text(const Command& command, const std::vector<const Command*>& parts, int width);

/// Name, help and options: a list of name, letter, type, default, help, is_repeatable, is_required.
Json to_json(const Command& command);

/// "neve sweep run [OPTIONS] DIR"
std::string usage_line(const Command& command, bool has_parts);

/// The help of an option, with its default.
std::string sentence_of(const Option& option);

template <class Member, class T>
Option& Command::operator()(const char* names, Member& member, const Language<T>& language,
                            const std::string& sentence) {
  constexpr bool is_list = std::is_same_v<Member, std::vector<T>>;
  Option& option = add(names, language.type, language.example, sentence);
  option.is_repeatable = is_list;
  option.read = [&member, read = language.read, flag = option.name()](const std::string& text) {
    if constexpr (is_list)
      member.push_back(read(flag, text));
    else
      member = read(flag, text);
  };
  option.write = [&member, write = language.write] {
    std::vector<std::string> values;
    if constexpr (is_list)
      std::transform(member.begin(), member.end(), std::back_inserter(values), write);
    else if constexpr (std::is_same_v<Member, T>)
      values.push_back(write(member));
    else if (member)
      values.push_back(write(*member));
    return values;
  };
  return option;
}

template <class T>
Option& Command::sets(const char* names, T& member, T value, const std::string& sentence) {
  Option& option = add(names, "", "", sentence);
  option.is_flag = true;
  option.read = [&member, value](const std::string&) { member = value; };
  option.write = [&member, value] { return std::vector<std::string>(member == value, ""); };
  return option;
}

}  // namespace neve::app::options

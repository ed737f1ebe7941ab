#pragma once
/// Answers to an unknown word, "did you mean hardening?", and to texts where numbers are expected:
/// units, quotes, commas, brackets.

#include <string>
#include <string_view>
#include <vector>

#include "app/scene/toml/value.h"

namespace neve::app::advice {

/// The place where a word was written.
struct Context {
  std::string name;                ///< in words.txt; empty: only the spelling counts
  std::vector<std::string> known;  ///< names that are right there
  bool has_quotes = false;         ///< names are written in quotes, as in a scene
};

/// The name closest to a misspelt one, or empty when none is close.
std::string nearest_name(const std::string& wrong, const std::vector<std::string>& names);

/// The known name that other programs call so; "": none.
std::string our_name(const std::string& word, const Context& context);

/// The known name that other programs call so, or that is spelt nearly so; "": none.
std::string meant_name(const std::string& word, const Context& context);

/// "did you mean hardening?"; "" of "".
std::string did_you_mean(const std::string& name, bool has_quotes = false);

/// A sentence of the table, or "did you mean ...?", or `otherwise`.
std::string suggest(const std::string& word, const Context& context,
                    const std::string& otherwise = "");

/// "did you mean a? expected a, b, c"
std::string expected_one_of(const std::vector<std::string>& known, const std::string& meant);
/// The same of a word; a sentence of the table takes the place of the question.
std::string suggest_one_of(const std::string& word, const Context& context);

// Lines of words.txt: what people write, and what it is called here.

/// A line of the table.
struct Entry {
  std::vector<std::string> words;
  std::string flag;                ///< that the command must have; empty: any command
  std::vector<std::string> names;  ///< here, the likeliest first
  std::string sentence;            ///< instead of names

  bool has(std::string_view word) const;
};

/// Lower-case words of a text: "Longest time_step." has longest, time and step.
std::vector<std::string> words_in(std::string_view text);

/// True if each is one of the words, or from three letters on begins one.
bool has_all(const std::vector<std::string>& words, const std::vector<std::string>& wanted);

/// Lines of a context; none of an unknown one.
const std::vector<Entry>& entries_of(const std::string& context);

/// The line of a context that has a word as it is written, in lower case, or without a dot before
/// it; null: none.
const Entry* entry_of(const std::string& context, const std::string& word);

/// "numbers have no unit: in Pa it is 1.4e+08" of "140 MPa"; "" if nothing is known about it.
/// @param unit  of the parameter, as in describe.h
std::string number_advice(std::string_view text, std::string_view unit);

/// "write [0, -9.81, 0]" of "0,-9.81,0" or -9.81 where a vector is expected; "": none.
std::string vector_advice(const scene::toml::Value& value, const std::string& address);

}  // namespace neve::app::advice

#pragma once
/// Answers to an unknown word: "did you mean hardening?"

#include <string>
#include <vector>

#include "app/advice/words.h"

namespace neve::app::advice {

/// Where a word was written.
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

}  // namespace neve::app::advice

#pragma once
/// words.txt: what people write, and what it is called here.

#include <string>
#include <string_view>
#include <vector>

namespace neve::app::advice {

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

}  // namespace neve::app::advice

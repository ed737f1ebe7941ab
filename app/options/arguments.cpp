#include "app/options/arguments.h"

#include <sstream>

#include "app/support/text.h"

namespace neve::app::options {

namespace {

void add_words(const Option& option, const std::string& value, std::vector<std::string>& words) {
  // A text that starts like a flag would be taken for one.
  const bool is_like_flag = value.starts_with('-') && value != "-";
  if (option.is_argument()) return words.push_back(is_like_flag ? "./" + value : value);
  if (is_like_flag || !option.alone.empty()) return words.push_back(option.name() + "=" + value);
  words.push_back(option.name());
  if (!option.is_flag) words.push_back(value);
}

}  // namespace

std::vector<std::string> words_of(const Command& command, const Command& usual) {
  std::vector<std::string> words;
  std::istringstream names(command.name);
  for (std::string name; names >> name;) words.push_back(name);
  // Arguments first, as people type them.
  for (const bool wants_arguments : {true, false})
    for (std::size_t k = 0; k < command.options.size(); ++k) {
      const Option& option = command.options[k];
      const std::vector<std::string> values = option.write();
      if (option.is_argument() != wants_arguments || values == usual.options[k].write()) continue;
      for (const std::string& value : values) add_words(option, value, words);
    }
  return words;
}

std::string shell_line(const std::vector<std::string>& words,
                       const std::filesystem::path& program) {
  std::string line = shell_word(program.string());
  for (const std::string& word : words) line += " " + shell_word(word);
  return line;
}

}  // namespace neve::app::options

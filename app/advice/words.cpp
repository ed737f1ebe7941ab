#include "app/advice/suggest.h"

#include <algorithm>
#include <cassert>
#include <cctype>
#include <map>
#include <utility>

#include "app/support/text.h"

namespace neve::app::advice {

std::string_view find_embedded_words(std::string_view name);

namespace {

using Table = std::map<std::string, std::vector<Entry>>;

/// Parts without the blanks around them.
std::vector<std::string> split(std::string_view text, char between) {
  std::vector<std::string> parts;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find(between), text.size());
    if (std::string part = trimmed(text.substr(0, end), " "); !part.empty())
      parts.push_back(std::move(part));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return parts;
}

Entry read_entry(std::string_view line) {
  Entry entry;
  const std::size_t names = line.find(" = "), sentence = line.find(" : ");
  const std::size_t end = std::min(names, sentence);
  assert(end != std::string_view::npos);
  std::string_view words = line.substr(0, end);
  if (const std::size_t flag = words.find(" ("); flag != std::string_view::npos) {
    entry.flag = words.substr(flag + 2, words.size() - flag - 3);
    words = words.substr(0, flag);
  }
  entry.words = split(words, ',');
  if (names < sentence)
    entry.names = split(line.substr(end + 3), ' ');
  else
    entry.sentence = line.substr(end + 3);
  return entry;
}

Table read_table() {
  Table table;
  std::vector<Entry>* context = nullptr;
  for (const std::string& line : split(find_embedded_words("words.txt"), '\n')) {
    if (line.starts_with('#')) continue;
    if (line.starts_with('['))
      context = &table[line.substr(1, line.size() - 2)];
    else
      context->push_back(read_entry(line));
  }
  return table;
}

/// A word, or from three letters on its beginning.
bool has_word(const std::vector<std::string>& words, const std::string& start) {
  return std::any_of(words.begin(), words.end(), [&](const std::string& word) {
    return word == start || (start.size() >= 3 && word.starts_with(start));
  });
}

}  // namespace

bool has_all(const std::vector<std::string>& words, const std::vector<std::string>& wanted) {
  return std::all_of(wanted.begin(), wanted.end(),
                     [&](const std::string& word) { return has_word(words, word); });
}

bool Entry::has(std::string_view word) const {
  return std::find(words.begin(), words.end(), word) != words.end();
}

std::vector<std::string> words_in(std::string_view text) {
  std::vector<std::string> words(1);
  for (const char c : lower_text(text)) {
    const bool is_part = std::isalnum(static_cast<unsigned char>(c)) != 0 || (c & 0x80) != 0;
    if (is_part)
      words.back() += c;
    else if (!words.back().empty())
      words.emplace_back();
  }
  if (words.back().empty()) words.pop_back();
  return words;
}

const std::vector<Entry>& entries_of(const std::string& context) {
  static const Table table = read_table();
  static const std::vector<Entry> none;
  const auto found = table.find(context);
  return found == table.end() ? none : found->second;
}

const Entry* entry_of(const std::string& context, const std::string& word) {
  const std::string lower = lower_text(word);
  for (const std::string& spelling : {word, lower, lower.substr(lower.starts_with('.') ? 1 : 0)})
    for (const Entry& entry : entries_of(context))
      if (entry.has(spelling)) return &entry;
  return nullptr;
}

}  // namespace neve::app::advice

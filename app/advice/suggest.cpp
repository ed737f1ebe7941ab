#include "app/advice/suggest.h"

#include <algorithm>
#include <array>
#include <numeric>

#include "app/scene/toml/value.h"
#include "app/support/text.h"

namespace neve::app::advice {

namespace {

/// Letters inserted, dropped, replaced, or swapped with their neighbour; `most` if they are more.
std::size_t edit_distance(const std::string& a, const std::string& b, std::size_t most) {
  std::vector<std::size_t> row(b.size() + 1), above(row.size()), above2(row.size());
  std::iota(row.begin(), row.end(), std::size_t{0});
  std::size_t min_above = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    above2.swap(above);
    above.swap(row);
    row[0] = i + 1;
    std::size_t least = row[0];
    for (std::size_t j = 0; j < b.size(); ++j) {
      std::size_t distance = std::min(above[j] + (a[i] != b[j]), row[j] + 1);
      distance = std::min(distance, above[j + 1] + 1);
      const bool is_swap = i > 0 && j > 0 && a[i] == b[j - 1] && a[i - 1] == b[j];
      if (is_swap) distance = std::min(distance, above2[j - 1] + 1);
      row[j + 1] = distance;
      least = std::min(least, distance);
    }
    // Rows to come are made from these two.
    if (std::min(least, min_above) >= most) return most;
    min_above = least;
  }
  return std::min(row[b.size()], most);
}

using Letters = std::array<int, 256>;

Letters letters_of(const std::string& text) {
  Letters letters{};
  for (const char c : text) ++letters[static_cast<unsigned char>(c)];
  return letters;
}

/// Letters that only one of two words has: no fewer changes make one of the other.
std::size_t min_distance(Letters letters, std::size_t size, const std::string& other) {
  std::size_t more = 0;
  for (const char c : other) more += --letters[static_cast<unsigned char>(c)] < 0;
  return std::max(more, size - (other.size() - more));
}

}  // namespace

std::string nearest_name(const std::string& wrong, const std::vector<std::string>& names) {
  const auto is_same = [lower = lower_text(wrong)](const std::string& name) {
    return lower_text(name) == lower;
  };
  if (const auto same = std::find_if(names.begin(), names.end(), is_same); same != names.end())
    return *same;
  std::string nearest;
  // A third of the letters wrong is still a typing error; more is another word.
  std::size_t best = std::max<std::size_t>(1, wrong.size() / 3) + 1;
  // Each letter is as near to any other.
  if (wrong.size() < 2 || wrong.size() > 64) return nearest;
  const Letters letters = letters_of(wrong);
  for (const std::string& name : names) {
    if (min_distance(letters, wrong.size(), name) >= best) continue;
    const std::size_t distance = edit_distance(wrong, name, best);
    if (distance < best) best = distance, nearest = name;
  }
  return nearest;
}

std::string our_name(const std::string& word, const Context& context) {
  const Entry* entry = context.name.empty() ? nullptr : entry_of(context.name, word);
  if (!entry) return {};
  const auto found = std::find_first_of(entry->names.begin(), entry->names.end(),
                                        context.known.begin(), context.known.end());
  return found == entry->names.end() ? "" : *found;
}

std::string meant_name(const std::string& word, const Context& context) {
  const std::string ours = our_name(word, context);
  return ours.empty() ? nearest_name(word, context.known) : ours;
}

std::string did_you_mean(const std::string& name, bool has_quotes) {
  if (name.empty()) return {};
  return "did you mean " + (has_quotes ? scene::toml::toml_string(name) : name) + "?";
}

std::string suggest(const std::string& word, const Context& context, const std::string& otherwise) {
  const Entry* entry = context.name.empty() ? nullptr : entry_of(context.name, word);
  if (entry && !entry->sentence.empty()) return entry->sentence;
  const std::string name = meant_name(word, context);
  return name.empty() ? otherwise : did_you_mean(name, context.has_quotes);
}

std::string expected_one_of(const std::vector<std::string>& known, const std::string& meant) {
  return (meant.empty() ? "" : did_you_mean(meant) + " ") + "expected " + joined(known, ", ");
}

std::string suggest_one_of(const std::string& word, const Context& context) {
  const Entry* entry = context.name.empty() ? nullptr : entry_of(context.name, word);
  if (entry && !entry->sentence.empty()) return entry->sentence;
  return expected_one_of(context.known, meant_name(word, context));
}

}  // namespace neve::app::advice

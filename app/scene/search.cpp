#include "app/scene/search.h"

#include <algorithm>
#include <cctype>
#include <utility>

#include "app/scene/wishes.h"
#include "app/support/lower_text.h"
#include "app/support/text.h"

namespace neve::app::scene {

namespace {

/// Shorter parts of words are in too many of them.
constexpr std::size_t shortest_part = 4;

/// A word, or from three letters on its beginning.
bool has_word(const std::vector<std::string>& words, const std::string& start) {
  return std::any_of(words.begin(), words.end(), [&](const std::string& word) {
    return word == start || (start.size() >= 3 && word.starts_with(start));
  });
}

/// True if each word begins one of these.
bool has_all(const std::vector<std::string>& words, const std::vector<std::string>& wanted) {
  return std::all_of(wanted.begin(), wanted.end(),
                     [&](const std::string& word) { return has_word(words, word); });
}

/// Up to the next dot, which is taken away with it.
std::string_view next_word(std::string_view& address) {
  const auto dot = std::min(address.find('.'), address.size());
  const std::string_view word = address.substr(0, dot);
  address.remove_prefix(std::min(dot + 1, address.size()));
  return word;
}

}  // namespace

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

std::string our_attribute(const std::string& name, const std::vector<std::string>& known) {
  constexpr std::pair<const char*, const char*> names[] = {{"velocity", "v"},
                                                           {"speed", "v"},
                                                           {"position", "x"},
                                                           {"vel", "v"},
                                                           {"pos", "x"},
                                                           {"P", "x"},
                                                           {"mass", "m"},
                                                           {"pressure", "stress"},
                                                           {"pressure", "kirchhoff"},
                                                           {"pscale", "radius"},
                                                           {"width", "radius"},
                                                           {"rho", "density"},
                                                           {"stress", "kirchhoff"},
                                                           {"kirchhoff", "stress"},
                                                           {"deformation", "F_E"},
                                                           {"plastic_volume", "J_P"},
                                                           {"forces", "force"},
                                                           {"F", "F_E"},
                                                           {"Fe", "F_E"},
                                                           {"F_e", "F_E"},
                                                           {"f", "force"},
                                                           {"J", "J_E"},
                                                           {"Jp", "J_P"}};
  for (const auto& [other, ours] : names)
    if (name == other && std::find(known.begin(), known.end(), ours) != known.end()) return ours;
  return {};
}

std::string attribute_advice(const std::string& name, const std::vector<std::string>& known) {
  const std::string ours = our_attribute(name, known);
  return ours.empty() ? names_advice(name, known)
                      : "did you mean " + ours + "? expected " + joined(known, ", ");
}

bool same_parameter(std::string_view pattern, std::string_view address) {
  while (!pattern.empty() && !address.empty()) {
    const std::string_view wanted = next_word(pattern), found = next_word(address);
    if (wanted != "NAME" && found != "NAME" && wanted != found) return false;
  }
  return pattern.empty() && address.empty();
}

Search::Search(const std::string& text) : text_(lower_text(text)), words_(words_in(text)) {
  if (words_.empty()) return;
  for (const Wish* wish : wishes_for(text))
    for (const WishChange& change : wish->changes) meant_.emplace_back(change.address);
  for (const EverydayName& name : everyday_names())
    if (has_all(words_in(name.words), words_))
      meant_.insert(meant_.end(), name.addresses.begin(), name.addresses.end());
}

bool Search::names(const std::string& address) const {
  if (same_parameter(text_, address)) return true;
  // An address, or the beginning of one, as it is written.
  const std::string written = lower_text(address);
  if (text_.find('.') != std::string::npos) return written.find(text_) != std::string::npos;
  if (has_all(words_in(address), words_)) return true;
  if (text_.size() >= shortest_part && written.find(text_) != std::string::npos) return true;
  return std::any_of(meant_.begin(), meant_.end(),
                     [&](const std::string& meant) { return same_parameter(meant, address); });
}

bool Search::finds(const std::string& address, std::string_view help) const {
  if (is_empty() || names(address)) return true;
  if (text_.find('.') != std::string::npos) return false;
  std::vector<std::string> words = words_in(address);
  for (std::string& word : words_in(help)) words.push_back(std::move(word));
  return has_all(words, words_);
}

}  // namespace neve::app::scene

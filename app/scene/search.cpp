#include "app/scene/search.h"

#include <algorithm>

#include "app/advice/suggest.h"
#include "app/advice/wishes.h"
#include "app/scene/params.h"
#include "app/support/text.h"

namespace neve::app::scene {

namespace {

/// Shorter parts of words are in too many of them.
constexpr std::size_t shortest_part = 4;

/// Takes a word up to the next dot, and the dot with it.
std::string_view next_word(std::string_view& address) {
  const auto dot = std::min(address.find('.'), address.size());
  const std::string_view word = address.substr(0, dot);
  address.remove_prefix(std::min(dot + 1, address.size()));
  return word;
}

}  // namespace

bool same_parameter(std::string_view pattern, std::string_view address) {
  while (!pattern.empty() && !address.empty()) {
    const std::string_view wanted = next_word(pattern), found = next_word(address);
    if (wanted != "NAME" && found != "NAME" && wanted != found) return false;
  }
  return pattern.empty() && address.empty();
}

Search::Search(const std::string& text) : text_(lower_text(text)), words_(advice::words_in(text)) {
  if (words_.empty()) return;
  for (const advice::Wish* wish : advice::wishes_for(text))
    for (const advice::WishChange& change : wish->changes) meant_.emplace_back(change.address);
  for (const advice::Entry& entry : advice::entries_of("parameter"))
    if (advice::has_all(advice::words_in(joined(entry.words, " ")), words_))
      meant_.insert(meant_.end(), entry.names.begin(), entry.names.end());
}

bool Search::names(const std::string& address) const {
  if (same_parameter(text_, address)) return true;
  // An address, or the beginning of one, as it is written.
  const std::string written = lower_text(address);
  if (text_.find('.') != std::string::npos) return written.find(text_) != std::string::npos;
  if (advice::has_all(advice::words_in(address), words_)) return true;
  if (text_.size() >= shortest_part && written.find(text_) != std::string::npos) return true;
  return std::any_of(meant_.begin(), meant_.end(),
                     [&](const std::string& meant) { return same_parameter(meant, address); });
}

bool Search::finds(const std::string& address, std::string_view help) const {
  if (is_empty() || names(address)) return true;
  if (text_.find('.') != std::string::npos) return false;
  std::vector<std::string> words = advice::words_in(address);
  for (std::string& word : advice::words_in(help)) words.push_back(std::move(word));
  return advice::has_all(words, words_);
}

std::vector<std::string> parameters_named(const std::string& word) {
  if (param_at(word)) return {word};
  std::vector<std::string> found;
  const auto depth = [](const std::string& address) {
    return std::count(address.begin(), address.end(), '.');
  };
  for (const ParamInfo& info : params()) {
    const std::string& address = info.address;
    if (address != word && !address.ends_with("." + word)) continue;
    if (!found.empty() && depth(address) > depth(found.front())) continue;
    if (!found.empty() && depth(address) < depth(found.front())) found.clear();
    found.push_back(address);
  }
  return found;
}

}  // namespace neve::app::scene

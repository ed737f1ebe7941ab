#include <algorithm>
#include <iostream>

#include "app/advice/suggest.h"
#include "app/advice/wishes.h"
#include "app/cli/commands.h"
#include "app/scene/params.h"
#include "app/scene/search.h"
#include "app/support/errors.h"
#include "app/support/text.h"
#include "app/sweep/read/read_sweep.h"

namespace neve::app::cli {

namespace {

/// Addresses, their parts and everyday words that look like it.
std::string nearest_filter(const std::string& filter, const std::vector<scene::ParamInfo>& list) {
  std::vector<std::string> names;
  for (const scene::ParamInfo& info : list) {
    names.push_back(info.address);
    names.push_back(info.address.substr(info.address.rfind('.') + 1));
    names.push_back(info.address.substr(0, info.address.find('.')));
  }
  for (const advice::Wish& wish : advice::wishes())
    for (const std::string& word : advice::words_in(std::string(wish.name) + " " + wish.words))
      names.push_back(word);
  for (const advice::Entry& entry : advice::entries_of("parameter"))
    for (const std::string& word : advice::words_in(joined(entry.words, " ")))
      names.push_back(word);
  return advice::nearest_name(filter, names);
}

/// Finds the words of a wish in "how do I make it sticky", or the flag of "motion blur"; "".
std::string advice_on_sentence(const std::string& filter) {
  std::string flag = "--" + filter;
  std::replace(flag.begin(), flag.end(), ' ', '-');
  for (const advice::Entry& entry : advice::entries_of("flag"))
    if (entry.has(flag) && !entry.sentence.empty()) return entry.sentence;
  std::vector<std::string> found;
  for (const std::string& word : advice::words_in(filter))
    if (word.size() > 3 && !advice::wishes_for(word).empty()) found.push_back(word);
  return found.empty() ? "" : "one word finds more: neve params " + joined(found, ", neve params ");
}

[[noreturn]] void fail_unfound(const std::string& what, const std::string& filter,
                               const std::string& nearest, const std::string& otherwise) {
  throw UsageError("params", what + " \"" + filter + "\"",
                   nearest.empty() ? otherwise : advice::did_you_mean(nearest));
}

void print_wishes(const ParamsOptions& options) {
  std::vector<const advice::Wish*> wishes = advice::wishes_for(options.filter);
  if (options.filter.empty())
    for (const advice::Wish& wish : advice::wishes()) wishes.push_back(&wish);
  if (wishes.empty()) {
    std::vector<std::string> names;
    for (const advice::Wish& wish : advice::wishes()) names.emplace_back(wish.name);
    fail_unfound("no wish is called", options.filter, "", "expected " + joined(names, ", "));
  }
  std::cout << (options.is_json       ? advice::wishes_json(wishes)
                : options.is_markdown ? advice::wishes_markdown(wishes)
                                      : advice::wishes_table(wishes));
}

}  // namespace

int run_params(const ParamsOptions& options) {
  if (options.is_wishes) {
    print_wishes(options);
    return exit_ok;
  }
  std::vector<scene::ParamInfo> list =
      options.is_sweep ? sweep::read::sweep_params() : scene::params();
  const std::string nearest = nearest_filter(options.filter, list);
  const scene::Search search(options.filter);
  std::erase_if(list, [&](const scene::ParamInfo& info) {
    return !search.finds(info.address, info.help) && info.unit != options.filter;
  });
  const std::string sentence = list.empty() ? advice_on_sentence(options.filter) : "";
  if (list.empty() && !sentence.empty())
    throw UsageError("params", "no parameter is called \"" + options.filter + "\"", sentence);
  if (list.empty())
    fail_unfound("no parameter has this in its address or description, or as its unit:",
                 options.filter, nearest, "neve params lists all of them");
  // Parameters with the word in their name come before parameters that only mention it.
  std::stable_partition(list.begin(), list.end(),
                        [&](const scene::ParamInfo& info) { return search.names(info.address); });
  std::cout << (options.is_json ? scene::params_json(list) : scene::params_table(list));
  const std::vector<const advice::Wish*> wishes = advice::wishes_for(options.filter);
  if (!options.is_json && !options.is_sweep && !wishes.empty())
    std::cout << "\n" << advice::wishes_table(wishes);
  return exit_ok;
}

}  // namespace neve::app::cli

#include <algorithm>
#include <iostream>

#include "app/cli/commands.h"
#include "app/scene/params.h"
#include "app/scene/search.h"
#include "app/scene/wishes.h"
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
  for (const scene::Wish& wish : scene::wishes())
    for (const std::string& word : scene::words_in(std::string(wish.name) + " " + wish.words))
      names.push_back(word);
  for (const scene::EverydayName& name : scene::everyday_names())
    for (const std::string& word : scene::words_in(name.words)) names.push_back(word);
  return nearest_name(filter, names);
}

[[noreturn]] void fail_unfound(const std::string& what, const std::string& filter,
                               const std::string& nearest, const std::string& otherwise) {
  throw UsageError("params", what + " \"" + filter + "\"",
                   nearest.empty() ? otherwise : "did you mean " + nearest + "?");
}

void print_wishes(const ParamsOptions& options) {
  std::vector<const scene::Wish*> wishes = scene::wishes_for(options.filter);
  if (options.filter.empty())
    for (const scene::Wish& wish : scene::wishes()) wishes.push_back(&wish);
  if (wishes.empty()) {
    std::vector<std::string> names;
    for (const scene::Wish& wish : scene::wishes()) names.emplace_back(wish.name);
    fail_unfound("no wish is called", options.filter, "", "expected " + joined(names, ", "));
  }
  std::cout << (options.is_json       ? scene::wishes_json(wishes)
                : options.is_markdown ? scene::wishes_markdown(wishes)
                                      : scene::wishes_table(wishes));
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
  std::erase_if(
      list, [&](const scene::ParamInfo& info) { return !search.finds(info.address, info.help); });
  if (list.empty())
    fail_unfound("no parameter has this in its address or description:", options.filter, nearest,
                 "neve params lists all of them");
  // Those that are called so come before those that only mention it.
  std::stable_partition(list.begin(), list.end(),
                        [&](const scene::ParamInfo& info) { return search.names(info.address); });
  std::cout << (options.is_json ? scene::params_json(list) : scene::params_table(list));
  const std::vector<const scene::Wish*> wishes = scene::wishes_for(options.filter);
  if (!options.is_json && !options.is_sweep && !wishes.empty())
    std::cout << "\n" << scene::wishes_table(wishes);
  return exit_ok;
}

}  // namespace neve::app::cli

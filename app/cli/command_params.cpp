#include <algorithm>
#include <iostream>

#include "app/cli/commands.h"
#include "app/scene/looks.h"
#include "app/scene/params.h"
#include "app/scene/search.h"
#include "app/scene/toml/error.h"
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
  for (const scene::Look& look : scene::looks())
    for (const std::string& word : scene::words_in(std::string(look.wish) + " " + look.words))
      names.push_back(word);
  for (const scene::EverydayName& name : scene::everyday_names())
    for (const std::string& word : scene::words_in(name.words)) names.push_back(word);
  return nearest_name(filter, names);
}

[[noreturn]] void fail_unfound(const std::string& what, const std::string& filter,
                               const std::string& nearest, const std::string& otherwise) {
  throw scene::toml::UsageError("params", what + " \"" + filter + "\"",
                                nearest.empty() ? otherwise : "did you mean " + nearest + "?");
}

void print_looks(const ParamsOptions& options) {
  std::vector<const scene::Look*> looks = scene::looks_for(options.filter);
  if (options.filter.empty())
    for (const scene::Look& look : scene::looks()) looks.push_back(&look);
  if (looks.empty()) {
    std::vector<std::string> wishes;
    for (const scene::Look& look : scene::looks()) wishes.emplace_back(look.wish);
    fail_unfound("no look is called", options.filter, "", "expected " + joined(wishes, ", "));
  }
  std::cout << (options.is_json       ? scene::looks_json(looks)
                : options.is_markdown ? scene::looks_markdown(looks)
                                      : scene::looks_table(looks));
}

}  // namespace

int run_params(const ParamsOptions& options) {
  if (options.is_looks) {
    print_looks(options);
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
  const std::vector<const scene::Look*> looks = scene::looks_for(options.filter);
  if (!options.is_json && !options.is_sweep && !looks.empty())
    std::cout << "\n" << scene::looks_table(looks);
  return exit_ok;
}

}  // namespace neve::app::cli

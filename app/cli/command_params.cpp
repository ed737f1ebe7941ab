#include <iostream>

#include "app/cli/commands.h"
#include "app/scene/params.h"
#include "app/scene/toml/error.h"
#include "app/support/errors.h"
#include "app/support/text.h"
#include "app/sweep/read/read_sweep.h"

namespace neve::app::cli {

namespace {

/// The addresses, their last words and their tables that look like it.
std::string nearest_filter(const std::string& filter, const std::vector<scene::ParamInfo>& list) {
  std::vector<std::string> names;
  for (const scene::ParamInfo& info : list) {
    names.push_back(info.address);
    names.push_back(info.address.substr(info.address.rfind('.') + 1));
    names.push_back(info.address.substr(0, info.address.find('.')));
  }
  return nearest_name(filter, names);
}

}  // namespace

int run_params(const std::string& filter, bool is_sweep, bool is_json) {
  std::vector<scene::ParamInfo> list = is_sweep ? sweep::read::sweep_params() : scene::params();
  const std::string nearest = nearest_filter(filter, list);
  std::erase_if(list, [&](const scene::ParamInfo& info) {
    return info.address.find(filter) == std::string::npos;
  });
  if (list.empty())
    throw scene::toml::UsageError(
        "params", "no address has \"" + filter + "\" in it",
        nearest.empty() ? "neve params lists all of them" : "did you mean " + nearest + "?");
  std::cout << (is_json ? scene::params_json(list) : scene::params_table(list));
  return exit_ok;
}

}  // namespace neve::app::cli

#include <iostream>

#include "app/commands.h"
#include "app/errors.h"
#include "app/scene/error.h"
#include "app/scene/params.h"
#include "app/sweep/read_sweep.h"
#include "app/text.h"

namespace neve::app {

namespace {

/// The addresses, their last words and their tables that look like it.
std::string nearest_filter(const std::string& filter, const std::vector<ParamInfo>& list) {
  std::vector<std::string> names;
  for (const ParamInfo& info : list) {
    names.push_back(info.address);
    names.push_back(info.address.substr(info.address.rfind('.') + 1));
    names.push_back(info.address.substr(0, info.address.find('.')));
  }
  return nearest_name(filter, names);
}

}  // namespace

int run_params(const std::string& filter, bool is_sweep, bool is_json) {
  std::vector<ParamInfo> list = is_sweep ? sweep_params() : params();
  const std::string nearest = nearest_filter(filter, list);
  std::erase_if(
      list, [&](const ParamInfo& info) { return info.address.find(filter) == std::string::npos; });
  if (list.empty())
    throw UsageError(
        "params", "no address has \"" + filter + "\" in it",
        nearest.empty() ? "neve params lists all of them" : "did you mean " + nearest + "?");
  std::cout << (is_json ? params_json(list) : params_table(list));
  return exit_ok;
}

}  // namespace neve::app

#include "app/scene/params.h"

#include <algorithm>

#include "app/scene/lister.h"

namespace neve::app::scene {
namespace {

/// Up to the next dot, which is taken away with it.
std::string_view next_word(std::string_view& address) {
  const auto dot = std::min(address.find('.'), address.size());
  const std::string_view word = address.substr(0, dot);
  address.remove_prefix(std::min(dot + 1, address.size()));
  return word;
}

bool matches(std::string_view pattern, std::string_view address) {
  while (!pattern.empty() && !address.empty()) {
    const std::string_view wanted = next_word(pattern), found = next_word(address);
    if (wanted != "NAME" && wanted != found) return false;
  }
  return pattern.empty() && address.empty();
}

}  // namespace

std::vector<ParamInfo> params() {
  std::vector<ParamInfo> list;
  Lister lister(list, "");
  Scene scene;
  describe(lister, scene);
  return list;
}

std::optional<ParamInfo> param_at(const std::string& address) {
  for (const ParamInfo& info : params())
    if (matches(info.address, address)) return info;
  return std::nullopt;
}

}  // namespace neve::app::scene

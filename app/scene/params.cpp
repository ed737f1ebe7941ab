#include "app/scene/params.h"

#include "app/scene/lister.h"
#include "app/scene/search.h"

namespace neve::app::scene {

const std::vector<ParamInfo>& params() {
  static const std::vector<ParamInfo> all = [] {
    std::vector<ParamInfo> list;
    Lister lister(list, "");
    Scene scene;
    describe(lister, scene);
    return list;
  }();
  return all;
}

std::optional<ParamInfo> param_at(const std::string& address) {
  for (const ParamInfo& info : params())
    if (same_parameter(info.address, address)) return info;
  return std::nullopt;
}

}  // namespace neve::app::scene

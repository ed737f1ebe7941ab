#include <algorithm>

#include "app/scene/names.h"
#include "app/scene/scene.h"

namespace neve::app::scene {

std::string folder_of(const Export& e) {
  const bool has_name =
      std::any_of(e.name.begin(), e.name.end(), [](char c) { return c < '0' || c > '9'; });
  return has_name ? e.name : name(e.format);
}

}  // namespace neve::app::scene

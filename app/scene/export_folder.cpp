#include <algorithm>

#include "app/scene/names.h"
#include "app/scene/scene.h"

namespace neve::app::scene {

std::string folder_of(const Export& e) {
  const bool has_name =
      std::any_of(e.name.begin(), e.name.end(), [](char c) { return c < '0' || c > '9'; });
  return has_name ? e.name : name(e.format);
}

bool is_of_dust(ExportAttribute attribute) {
  using enum ExportAttribute;
  return attribute == id || attribute == x || attribute == v || attribute == m ||
         attribute == radius || attribute == age;
}

std::vector<std::string> snow_sources(const Scene& scene) {
  std::vector<std::string> names;
  for (const sim::seeding::Body& body : scene.bodies) names.push_back(body.name);
  for (const sim::seeding::Emitter& emitter : scene.emitters) names.push_back(emitter.name);
  return names;
}

}  // namespace neve::app::scene

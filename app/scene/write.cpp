#include "app/scene/writer.h"

#include <utility>

#include "app/scene/read.h"

namespace neve::app::scene {

toml::Table scene_table(const Scene& scene) {
  Scene copy = scene;  // visitors take members they could change
  Writer writer;
  describe(writer, copy);
  return std::move(writer.table);
}

std::string write_scene(const Scene& scene) {
  return toml::toml_document(scene_table(scene));
}

}  // namespace neve::app::scene

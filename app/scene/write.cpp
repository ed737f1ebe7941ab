#include "app/scene/writer.h"

#include "app/scene/read.h"

namespace neve::app::scene {

std::string write_scene(const Scene& scene) {
  Scene copy = scene;  // visitors take members they could change
  Writer writer;
  describe(writer, copy);
  return toml::toml_document(writer.table);
}

}  // namespace neve::app::scene

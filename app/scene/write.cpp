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

std::string write_undrawn(const Scene& scene) {
  if (scene.undrawn_views.empty() && scene.undrawn_mosaics.empty()) return "";
  Scene undrawn;
  undrawn.views = scene.undrawn_views;
  undrawn.mosaics = scene.undrawn_mosaics;
  toml::Table table = scene_table(undrawn);
  std::erase_if(table.entries, [](const toml::Entry& entry) {
    return entry.key != "view" && entry.key != "mosaic";
  });
  return toml::toml_document(table);
}

}  // namespace neve::app::scene

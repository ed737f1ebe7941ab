#include "app/scene/read.h"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "app/scene/check.h"
#include "app/scene/reader.h"
#include "app/scene/toml_source.h"
#include "app/scene/toml_text.h"
#include "app/text.h"

namespace neve::app {
namespace {

/// What is there although no scene says so: a material and a view with the names of their
/// defaults. In the document, so that --set finds them too.
void add_built_ins(Table& root) {
  if (!root.find("material")) root.entries.push_back({"material", {}, {Table{}}});
  Table* materials = std::get_if<Table>(&root.find("material")->value.data);
  const std::string snow = sim::Material{}.name;
  if (materials && !materials->find(snow)) {
    materials->entries.insert(materials->entries.begin(), Entry{snow, {}, {Table{}}});
  }
  if (!root.find("view")) {
    Table view;
    view.entries.push_back({"name", {}, {View{}.name}});
    root.entries.push_back({"view", {}, {Array{Value{std::move(view)}}}});
  }
}

std::string read_text(const std::string& file) {
  std::error_code error;
  if (std::filesystem::is_directory(file, error)) {
    throw SceneError(file, 0, 0, "is a directory", "name a scene file");
  }
  errno = 0;
  std::ifstream in(file, std::ios::binary);
  if (!in) throw SceneError(file, 0, 0, errno ? std::strerror(errno) : "cannot be opened");
  // One byte more than allowed tells an oversized file without reading all of it.
  std::string text(max_toml_bytes + 1, '\0');
  in.read(text.data(), static_cast<std::streamsize>(text.size()));
  if (in.bad()) throw SceneError(file, 0, 0, errno ? std::strerror(errno) : "cannot be read");
  text.resize(static_cast<std::size_t>(in.gcount()));
  if (text.empty()) throw SceneError(file, 0, 0, "is empty", "a scene needs at least one [[body]]");
  return text;
}

}  // namespace

Scene read_scene_text(std::string_view text, const std::string& name, const std::string& base_dir,
                      const std::vector<Override>& overrides) {
  Table root = parse_toml(text, name);
  add_built_ins(root);
  for (std::size_t k = 0; k < overrides.size(); ++k) {
    apply_override(root, overrides[k], static_cast<int>(k));
  }
  Reading reading{{name, base_dir, overrides}, {}};
  Scene scene;
  Reader(reading, root, "").read([&](auto& visit) { describe(visit, scene); });
  if (const auto problem = find_problem(scene)) {
    reading.source.fail(reading.place_of(problem->address), problem->message, problem->hint);
  }
  return scene;
}

Scene read_scene_file(const std::string& file, const std::vector<Override>& overrides) {
  return read_scene_text(read_text(file), file, std::filesystem::path(file).parent_path().string(),
                         overrides);
}

View find_view(const Scene& scene, const std::string& name) {
  std::vector<std::string> names;
  for (const View& view : scene.views) {
    if (view.name == name) return view;
    names.push_back(view.name);
  }
  if (name == View{}.name) return View{};
  const std::string nearest = nearest_name(name, names);
  throw UsageError("--view " + name, "the scene has no such view",
                   "expected " + list_of(names) +
                       (nearest.empty() ? "" : "; did you mean " + toml_string(nearest) + "?"));
}

}  // namespace neve::app

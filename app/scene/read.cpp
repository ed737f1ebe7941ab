#include "app/scene/read.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "app/advice/suggest.h"
#include "app/scene/check.h"
#include "app/scene/reader.h"
#include "app/scene/scene_file.h"
#include "app/scene/toml/toml_source.h"
#include "app/scene/toml/toml_text.h"
#include "app/support/errors.h"
#include "app/support/film_rate.h"
#include "app/support/text.h"
#include "sim/shapes/world_place.h"

namespace neve::app::scene {

std::vector<View> built_in_views() {
  using enum Layer;
  const auto view = [](const char* name, const std::vector<Layer>& layers) {
    View built_in;
    built_in.name = name;
    built_in.layers = layers;
    return built_in;
  };
  View slice = view("slice", {ground, colliders, heatmap, arrows, scale, legend, caption});
  // Below arrows of the velocity, its magnitude would say the same again; and on pale packed snow
  // all of their colours can be told.
  slice.slice.scalar = ScalarField::density;
  slice.slice.scalar_colormap = render::ColorMap::coolwarm;
  return {View{}, view("smoke", {ground, colliders, smoke, legend, caption}), slice,
          view("snow", {ground, colliders, snow, dust, legend, caption})};
}

namespace {

toml::Table table_of(const std::string& built_in) {
  toml::Table view;
  view.entries.push_back({"name", {}, {built_in}});
  return view;
}

bool is_named(const toml::Table& view, const std::string& name) {
  const toml::Entry* entry = view.find("name");
  return entry && entry->value.is_text(name);
}

bool is_named(const toml::Value& view, const std::string& name) {
  const toml::Table* table = std::get_if<toml::Table>(&view.data);
  return table && is_named(*table, name);
}

/// Built-in views keep their layers, and what the heat map among them shows, where the scene names
/// none.
void add_layers(toml::Table& view) {
  if (view.find("layers")) return;
  for (const View& built_in : built_in_views()) {
    if (!is_named(view, built_in.name)) continue;
    view.entries.push_back({"layers", {}, to_value(built_in.layers)});
    if (!has_layer(built_in, Layer::heatmap)) return;
    if (!view.find("slice")) view.entries.push_back({"slice", {}, {toml::Table{}}});
    toml::Table* slice = std::get_if<toml::Table>(&view.find("slice")->value.data);
    if (!slice || slice->find("scalar")) return;
    slice->entries.push_back({"scalar", {}, to_value(built_in.slice.scalar)});
    if (!slice->find("scalar_colormap"))
      slice->entries.push_back({"scalar_colormap", {}, to_value(built_in.slice.scalar_colormap)});
    return;
  }
}

/// True if a [[mosaic]] lists the view.
bool is_in_mosaic(const toml::Table& root, const std::string& name) {
  const toml::Entry* entry = root.find("mosaic");
  const toml::Array* mosaics = entry ? std::get_if<toml::Array>(&entry->value.data) : nullptr;
  if (!mosaics) return false;
  for (const toml::Value& mosaic : *mosaics) {
    const toml::Table* table = std::get_if<toml::Table>(&mosaic.data);
    const toml::Entry* views = table ? table->find("views") : nullptr;
    const toml::Array* names = views ? std::get_if<toml::Array>(&views->value.data) : nullptr;
    if (names && std::ranges::any_of(*names, [&](const auto& item) { return item.is_text(name); }))
      return true;
  }
  return false;
}

/// The views that the scene has, or the one that is drawn when it has none; and built-in ones that
/// a --set or a mosaic speaks of. If a mosaic does, nothing else need be drawn.
void add_views(toml::Table& root, const std::vector<Override>& overrides) {
  const std::vector<View> built_in_ones = built_in_views();
  const bool are_in_mosaic =
      std::any_of(built_in_ones.begin(), built_in_ones.end(),
                  [&](const View& view) { return is_in_mosaic(root, view.name); });
  if (!root.find("view"))
    root.entries.push_back(
        {"view",
         {},
         {are_in_mosaic ? toml::Array{} : toml::Array{toml::Value{table_of(first_view)}}}});
  toml::Array* views = std::get_if<toml::Array>(&root.find("view")->value.data);
  if (!views) return;
  for (const View& built_in : built_in_ones) {
    const bool is_set = std::any_of(overrides.begin(), overrides.end(), [&](const Override& o) {
      return o.address.starts_with("view." + built_in.name + ".");
    });
    const bool is_there = std::any_of(views->begin(), views->end(), [&](const toml::Value& view) {
      return is_named(view, built_in.name);
    });
    const bool is_wanted = is_set || is_in_mosaic(root, built_in.name);
    if (is_wanted && !is_there) views->push_back({table_of(built_in.name)});
  }
  for (toml::Value& view : *views)
    if (toml::Table* table = std::get_if<toml::Table>(&view.data)) add_layers(*table);
}

/// A scene shows something: where no view is left, the one that scenes without views have.
void keep_a_view(toml::Table& root) {
  toml::Entry* entry = root.find("view");
  toml::Array* views = entry ? std::get_if<toml::Array>(&entry->value.data) : nullptr;
  if (entry && !(views && views->empty())) return;
  toml::Table view = table_of(first_view);
  add_layers(view);
  if (!entry) entry = &root.entries.emplace_back(toml::Entry{"view", {}, {}});
  entry->value.data = toml::Array{toml::Value{std::move(view)}};
}

/// Adds the built-in material and views to the document, so that --set finds them too.
void add_built_ins(toml::Table& root, const std::vector<Override>& overrides) {
  if (!root.find("material")) root.entries.push_back({"material", {}, {toml::Table{}}});
  toml::Table* materials = std::get_if<toml::Table>(&root.find("material")->value.data);
  const std::string snow = sim::Material{}.name;
  if (materials && !materials->find(snow)) {
    materials->entries.insert(materials->entries.begin(), toml::Entry{snow, {}, {toml::Table{}}});
  }
  add_views(root, overrides);
}

}  // namespace

namespace {

/// Gives covers the ground that they lie on, where it is at the start; find_problem() says where
/// there is none.
void lay_covers(Scene& scene) {
  for (sim::seeding::Body& body : scene.bodies) {
    auto* cover = std::get_if<sim::shapes::Cover>(&body.shape.form);
    if (!cover) continue;
    for (const Collider& collider : scene.colliders) {
      if (collider.name != cover->on) continue;
      const sim::shapes::Shape& shape = collider.shape;
      if (const auto* terrain = std::get_if<sim::shapes::Terrain>(&shape.form))
        cover->ground = *terrain;
      if (const auto* mesh = std::get_if<sim::shapes::Mesh>(&shape.form)) cover->ground = *mesh;
      cover->turned = shape.rotation;
      if (collider.keyframes.empty()) continue;
      // No keyframe is before the start, and none moves a collider before the first.
      const sim::shapes::PoseKeyframe& start = collider.keyframes.front();
      cover->turned = start.rotation.value_or(shape.rotation);
      if (start.position)
        std::visit([&](auto& ground) { ground.center = *start.position; }, cover->ground);
    }
  }
}

Scene scene_of(toml::Table root, const std::string& name, const std::string& base_dir,
               const std::vector<Override>& overrides) {
  add_built_ins(root, overrides);
  // Presets first: wherever a single number is set beside one, the number counts.
  for (const bool is_turn_of_presets : {true, false})
    for (std::size_t k = 0; k < overrides.size(); ++k)
      if (is_preset_address(overrides[k].address) == is_turn_of_presets)
        apply_override(root, overrides[k], static_cast<int>(k));
  keep_a_view(root);
  Reading reading{{name, base_dir, overrides}, {}};
  Scene scene;
  Reader(reading, root, "").read([&](auto& visit) { describe(visit, scene); });
  scene.fps = exact_rate(scene.fps);
  lay_covers(scene);
  if (const auto problem = find_problem(scene)) {
    reading.source.fail(reading.place_of(problem->address), problem->message, problem->hint);
  }
  return scene;
}

}  // namespace

Scene read_scene_text(std::string_view text, const std::string& name, const std::string& base_dir,
                      const std::vector<Override>& overrides) {
  toml::Table root = toml::parse_toml(text, name);
  if (const toml::Entry* sweep = root.find("sweep"))
    throw toml::SceneError(name, sweep->where.line, sweep->where.column,
                           "this is a sweep, not a scene",
                           "neve sweep " + name + " makes its runs");
  return scene_of(std::move(root), name, base_dir, overrides);
}

namespace {

/// Appends the items of one list to the same list of another table.
void append_list(const char* key, const toml::Table& from, toml::Table& to) {
  const toml::Entry* more = from.find(key);
  if (!more) return;
  toml::Entry* list = to.find(key);
  if (!list) list = &to.entries.emplace_back(toml::Entry{key, {}, {toml::Array(), {}}});
  const auto* items = std::get_if<toml::Array>(&more->value.data);
  auto* all = std::get_if<toml::Array>(&list->value.data);
  if (items && all)
    all->insert(all->end(), items->begin(), items->end());
  else if (all)
    list->value = more->value;  // no list: the reader says so
}

/// Moves the items of the list, which all have names.
template <class Named>
void move_named(const char* key, const toml::Table& list, std::vector<Named>& drawn,
                std::vector<Named>& undrawn) {
  const toml::Entry* entry = list.find(key);
  if (!entry) return;
  for (const toml::Value& item : std::get<toml::Array>(entry->value.data)) {
    const toml::Entry* name = std::get<toml::Table>(item.data).find("name");
    const auto found =
        std::ranges::find(drawn, name ? std::get<std::string>(name->value.data) : "", &Named::name);
    if (found == drawn.end()) continue;  // it was removed
    undrawn.push_back(std::move(*found));
    drawn.erase(found);
  }
}

}  // namespace

Scene read_with_undrawn(std::string_view text, std::string_view undrawn, const std::string& name,
                        const std::vector<Override>& overrides) {
  toml::Table root = toml::parse_toml(text, name);
  const toml::Table more = toml::parse_toml(undrawn, name);
  for (const char* key : {"view", "mosaic"}) append_list(key, more, root);
  Scene scene = scene_of(std::move(root), name, {}, overrides);
  move_named("view", more, scene.views, scene.undrawn_views);
  move_named("mosaic", more, scene.mosaics, scene.undrawn_mosaics);
  return scene;
}

Scene apply(const Scene& scene, const std::vector<Override>& overrides, const std::string& name,
            const std::string& base_dir) {
  Scene changed = scene_of(scene_table(scene), name, base_dir, overrides);
  changed.undrawn_views = others_than(changed.views, scene.undrawn_views);
  changed.undrawn_mosaics = others_than(changed.mosaics, scene.undrawn_mosaics);
  place_in_world(changed, name);
  return changed;
}

Scene read_scene_file(const std::string& file, const std::vector<Override>& overrides) {
  Scene scene = read_scene_text(read_toml_file(file), file, base_dir_of(file), overrides);
  place_in_world(scene, file);
  return scene;
}

namespace {

template <class Shape, class S>
std::vector<Shape*> shapes_of(S& scene) {
  std::vector<Shape*> shapes;
  for (auto& body : scene.bodies) shapes.push_back(&body.shape);
  for (auto& emitter : scene.emitters) shapes.push_back(&emitter.shape);
  for (auto& sink : scene.sinks) shapes.push_back(&sink.shape);
  for (auto& collider : scene.colliders) shapes.push_back(&collider.shape);
  return shapes;
}

}  // namespace

void place_in_world(Scene& scene, const std::string& name) {
  const auto shapes = shapes_of<sim::shapes::Shape>(scene);
  if (std::ranges::none_of(shapes, [](const auto* s) { return sim::shapes::needs_place(*s); }))
    return;
  try {
    sim::shapes::place_in_world(shapes);
  } catch (const sim::ShapeError& error) {
    throw toml::SceneError(name, 0, 0, error.what(), "");
  }
  lay_covers(scene);
  if (const auto problem = find_problem(scene))
    throw toml::SceneError(name, 0, 0, problem->address + ": " + problem->message, problem->hint);
}

std::optional<sim::Vec3d> world_offset(const Scene& scene) {
  return sim::shapes::world_offset(shapes_of<const sim::shapes::Shape>(scene));
}

View find_view(const Scene& scene, const std::string& name) {
  std::vector<std::string> names;
  for (const std::vector<View>* views : {&scene.views, &scene.undrawn_views})
    for (const View& view : *views) {
      if (view.name == name) return view;
      names.push_back(view.name);
    }
  for (const View& view : built_in_views()) {
    if (view.name == name) return view;
    if (std::find(names.begin(), names.end(), view.name) == names.end()) names.push_back(view.name);
  }
  const std::string question = advice::suggest(name, {"", names, true});
  const bool is_list = name.find(',') != std::string::npos;
  throw UsageError("--view " + name, "the scene has no such view",
                   std::string(is_list ? "each view has a --view of its own; " : "") + "expected " +
                       list_of(names) + (question.empty() ? "" : "; " + question));
}

}  // namespace neve::app::scene

#include "app/pick/clicks.h"
#include "app/scene/override.h"
#include "app/scene/params.h"
#include "app/scene/read.h"
#include "app/scene/toml/error.h"
#include "app/support/errors.h"
#include "app/sweep/plan/expand.h"
#include "app/sweep/read/read_sweep.h"
#include "app/view/replay/replay_script.h"
#include "sim/files/height_reader.h"
#include "sim/files/mesh_reader.h"
#include "sim/files/point_reader.h"
#include "sim/types/errors.h"
#include "tests/fuzz/readers.h"

namespace neve::test::fuzz {

namespace {

using namespace neve::app;

/// One of everything that has a name.
constexpr const char* base_scene = R"(
[solver]
cell_size = 0.04
[material.snow]
[[body]]
name = "ball"
shape = { sphere = { center = [0, 0.12, 0], radius = 0.08 } }
[[collider]]
name = "floor"
shape = { plane = { point = [0, 0, 0], normal = [0, 1, 0] } }
[[emitter]]
name = "spout"
shape = { sphere = { center = [0, 1, 0], radius = 0.1 } }
[[sink]]
name = "drain"
shape = { box = { center = [0, -1, 0], size = [1, 0.1, 1] } }
[[view]]
name = "main"
[[view]]
name = "side"
[[mosaic]]
name = "both"
views = ["main", "side"]
[[export]]
name = "points"
format = "ply"
)";

/// Returns an address of the scene above.
/// @param address  with NAME or N where a scene has names and numbers
std::string named(std::string address) {
  constexpr std::pair<std::string_view, std::string_view> names[] = {
      {"body.NAME", "body.ball"},
      {"collider.NAME", "collider.floor"},
      {"emitter.NAME", "emitter.spout"},
      {"sink.NAME", "sink.drain"},
      {"view.NAME", "view.main"},
      {"mosaic.NAME", "mosaic.both"},
      {"export.NAME", "export.points"},
      {"material.NAME", "material.snow"},
      {"[N]", "[0]"}};
  for (const auto& [from, to] : names)
    if (const std::size_t at = address.find(from); at != std::string::npos)
      address.replace(at, from.size(), to);
  return address;
}

/// Calls a reader that may refuse what it is given.
template <class Read>
void try_to(const Read& read) {
  try {
    read();
  } catch (const scene::toml::SceneError&) {
  } catch (const UsageError&) {
  } catch (const sim::ShapeError&) {
  } catch (const Error&) {
  }
}

/// A scene that was read is written so that it reads as the same one.
void require_round_trip(const scene::Scene& scene) {
  const std::string text = scene::write_scene(scene);
  require(scene::write_scene(scene::read_scene_text(text, "written")) == text);
}

}  // namespace

void read_scene(std::span<const std::uint8_t> bytes) {
  std::optional<scene::Scene> scene;
  try_to([&] { scene = scene::read_scene_text(std::string(text_of(bytes)), "scene.toml"); });
  if (scene) require_round_trip(*scene);
}

/// One --set a line.
void read_set(std::span<const std::uint8_t> bytes) {
  std::optional<scene::Scene> scene;
  try_to([&] {
    std::vector<scene::Override> overrides;
    std::string_view text = text_of(bytes);
    while (!text.empty()) {
      const std::size_t end = std::min(text.find('\n'), text.size());
      overrides.push_back(scene::parse_override(text.substr(0, end)));
      text.remove_prefix(std::min(end + 1, text.size()));
    }
    scene = scene::read_scene_text(base_scene, "scene.toml", "", overrides);
  });
  if (scene) require_round_trip(*scene);
}

/// Each parameter with its default and, of a choice, with each value.
std::vector<Bytes> settings() {
  std::vector<Bytes> list;
  for (const scene::ParamInfo& param : scene::params()) {
    const std::string head = named(param.address) + "=";
    list.push_back(bytes_of(
        head + (param.default_value ? scene::toml::toml_literal(*param.default_value) : "1")));
    for (const std::string& choice : param.choices) list.push_back(bytes_of(head + choice));
  }
  return list;
}

void read_sweep(std::span<const std::uint8_t> bytes) {
  try_to([&] {
    const sweep::read::Sweep sweep =
        sweep::read::parse_sweep(std::string(text_of(bytes)), "sweep.toml", {});
    sweep::read::repeated_values(sweep);
    sweep::plan::expand(sweep);
  });
}

void read_mesh(std::span<const std::uint8_t> bytes) {
  try_to([&] { sim::files::parse_mesh(text_of(bytes), "mesh"); });
  try_to([&] { sim::files::parse_obj(text_of(bytes), "mesh.obj"); });
}

void read_heights(std::span<const std::uint8_t> bytes) {
  std::optional<sim::files::HeightGrid> grid;
  try_to([&] { grid = sim::files::parse_heights(text_of(bytes), "heights", {2, -10, 90}); });
  if (grid) require(grid->height.size() == grid->columns * grid->rows && grid->spacing > 0);
}

void read_points(std::span<const std::uint8_t> bytes) {
  try_to([&] { sim::files::parse_points(text_of(bytes), "points"); });
  // Columns that exports carry along: every one that the header has.
  const bool is_ply = text_of(bytes).starts_with("ply");
  try_to([&] {
    const std::vector<std::string> further =
        is_ply ? sim::files::further_ply_columns(text_of(bytes), "points")
               : sim::files::further_csv_columns(text_of(bytes), "points");
    sim::files::parse_points(text_of(bytes), "points", further);
  });
}

void read_script(std::span<const std::uint8_t> bytes) {
  try_to([&] {
    const auto steps = view::replay::parse_replay(text_of(bytes), "script.json");
    require(!view::replay::replay_text(steps).empty());
  });
}

/// A list that was read is written so that it reads as the same one.
void read_clicks(std::span<const std::uint8_t> bytes) {
  std::vector<pick::Click> clicks;
  try_to([&] { clicks = pick::parse_clicks(std::string(text_of(bytes)), "clicks.txt"); });
  if (clicks.empty()) return;
  require(pick::parse_clicks(pick::clicks_text(clicks, {}), "again") == clicks);
}

}  // namespace neve::test::fuzz

#include "app/pick/files.h"

#include <fmt/format.h>

#include <algorithm>

#include "app/scene/coarsen.h"
#include "app/scene/edit_text.h"
#include "app/scene/flat.h"
#include "app/scene/params.h"
#include "app/scene/read.h"
#include "app/scene/scene_file.h"
#include "app/support/text.h"

namespace neve::app::pick {

namespace {

using scene::toml::toml_string;

std::string relative_scene(const std::string& file, const std::filesystem::path& folder) {
  namespace fs = std::filesystem;
  const fs::path scene = fs::absolute(file).lexically_normal();
  const fs::path relative = scene.lexically_relative(fs::absolute(folder).lexically_normal());
  return (relative.empty() ? scene : relative).generic_string();
}

/// The value of a --set as a sweep file writes it.
std::string literal(const scene::Override& change) {
  const std::optional<scene::ParamInfo> info = scene::param_at(change.address);
  return scene::toml::toml_literal(scene::value_of(change, info ? info->type : "table"));
}

}  // namespace

std::string round_sweep(const SearchScene& scene, const std::filesystem::path& folder, int round,
                        const std::vector<search::Point>& tiles) {
  std::string text = fmt::format(
      "# Round {} of neve pick.\n\n[sweep]\nscene = {}\nmethod = \"list\"\n\n[sheet]\nwrap = 3\n"
      "label = \"name\"\n",
      round, toml_string(relative_scene(scene.file, folder)));
  if (!scene.fixed.empty()) text += "\n[set]\n";
  for (const scene::Override& change : scene.fixed)
    text += toml_string(change.address) + " = " + literal(change) + "\n";
  for (std::size_t k = 0; k < tiles.size(); ++k) {
    text += fmt::format("\n[[run]]\nlabel = \"{}\"\n", k + 1);
    for (const scene::Override& setting : settings_at(scene.axes, tiles[k]))
      text += toml_string(setting.address) + " = " + setting.value + "\n";
  }
  return text;
}

std::string picked_scene(const SearchScene& scene, const search::Point& place,
                         const std::filesystem::path& out) {
  std::vector<scene::Override> all = scene.fixed;
  const std::vector<scene::Override> own = settings_at(scene.axes, place);
  all.insert(all.end(), own.begin(), own.end());
  return scene::with_header(
      scene::changed_scene_text(scene::read_toml_file(scene.file), all, scene.file, out.string()),
      "# Picked with neve pick from " +
          line_text(std::filesystem::path(scene.file).filename().string()) + ".\n");
}

std::string picked_sweep(const SearchScene& scene, const std::string& scene_name,
                         const search::Point& place, const std::vector<std::size_t>& order) {
  constexpr double step = 0.1;  // of an axis
  const bool is_single = order.size() == 1;
  std::string text =
      "# Around the pick.\n\n[sweep]\nscene = " + toml_string(scene_name) + "\n\n[axis]\n";
  for (std::size_t k = 0; k < std::min<std::size_t>(order.size(), 2); ++k) {
    const PickAxis& axis = scene.axes[order[k]];
    const double u = place[static_cast<Eigen::Index>(order[k])];
    std::vector<std::string> values;
    for (int j = is_single ? -2 : -1; j <= (is_single ? 2 : 1); ++j) {
      const std::string value = axis.text(std::clamp(u + j * step, 0.0, 1.0));
      if (values.empty() || values.back() != value) values.push_back(value);
    }
    text += toml_string(axis.address) + fmt::format(" = [{}]\n", fmt::join(values, ", "));
  }
  return text;
}

std::string picked_pair(const std::string& scene_name, const scene::Scene& picked,
                        double coarsening) {
  scene::Scene coarse = picked;
  scene::coarsen(coarse, coarsening);
  std::string text =
      "# The pick, coarse and at full resolution.\n\n[sweep]\nscene = " + toml_string(scene_name) +
      "\nmethod = \"list\"\n\n[sheet]\nlabel = \"name\"\nwrap = 2\n";
  text += fmt::format("\n[[run]]\nlabel = \"coarsened {}\"\n", scene::coarsening_text(coarsening));
  for (const scene::Difference& change : scene::differences(picked, coarse))
    text += toml_string(change.address) + " = " + scene::toml::toml_literal(*change.after) + "\n";
  return text + "\n[[run]]\nlabel = \"full resolution\"\n";
}

}  // namespace neve::app::pick

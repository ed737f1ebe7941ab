#include "app/view/session/export.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <string>
#include <vector>

#include "app/options/arguments.h"
#include "app/run/render_options.h"
#include "app/scene/flat.h"
#include "app/scene/leaf.h"
#include "app/scene/read.h"
#include "app/scene/scene_file.h"
#include "app/setup/curves.h"
#include "app/support/errors.h"
#include "app/sweep/plan/around.h"

namespace neve::app::view::session {

namespace {

/// A preset among all parameters of a scene: nothing but its choices matters to a sweep.
std::vector<scene::FlatParam> with_presets(const scene::Scene& scene) {
  std::vector<scene::FlatParam> params = scene::flatten(scene);
  for (const sim::Material& material : scene.materials) {
    scene::FlatParam& param = params.emplace_back();
    param.address = "material." + material.name + ".preset";
    param.type = "choice";
    param.choices = scene::choices<scene::Preset>();
    param.help = "Named kinds of snow.";
    if (const auto preset = scene::preset_of(material)) param.value = scene::to_value(*preset);
  }
  return params;
}

/// Settings of all runs of a sweep, without the numbers that its presets set.
std::vector<scene::Override> set_in_all(const Document& document, const std::string& address) {
  std::vector<scene::Override> all =
      setup::without_followers(*document.scene(), document.all_overrides());
  if (!scene::is_preset_address(address)) return all;
  const std::vector<std::string> numbers = scene::addresses_set_by(address);
  std::erase_if(all, [&](const scene::Override& override) {
    return std::find(numbers.begin(), numbers.end(), override.address) != numbers.end();
  });
  return all;
}

/// The value before the scene was coarsened, where it has one: the runs of the sweep are coarsened
/// after their values are set.
void take_finer_value(scene::FlatParam& param, const Document& document) {
  if (!(document.coarsening() > 1)) return;
  const scene::Scene finer =
      scene::read_scene_text(document.text(), document.file(), scene::base_dir_of(document.file()),
                             document.all_overrides());
  for (const scene::FlatParam& other : scene::flatten(finer))
    if (other.address == param.address && other.value) param.value = other.value;
}

}  // namespace

std::string plain_file_name(const std::string& address) {
  std::string name = address;
  for (char& c : name)
    if (!std::isalnum(static_cast<unsigned char>(c)) && c != '_' && c != '-') c = '_';
  return name;
}

std::string render_command(const Document& document, const std::string& scene_file) {
  run::RenderOptions options;
  options.scene = scene_file;
  options.overrides =
      scene::texts_of(setup::without_followers(*document.scene(), document.all_overrides()));
  if (document.coarsening() > 1) options.coarsening = document.coarsening();
  return options::shell_line(options::words_of(options));
}

std::string sweep_text_around(const std::filesystem::path& file, const Document& document,
                              const std::string& scene_file, const std::string& address,
                              const std::vector<std::string>& set_later) {
  for (scene::FlatParam& param : with_presets(*document.scene())) {
    if (param.address != address) continue;
    take_finer_value(param, document);
    return sweep::plan::sweep_around(scene_file, file.string(), param,
                                     set_in_all(document, address), document.coarsening(),
                                     set_later);
  }
  throw UsageError("", "nothing has the address " + address);
}

}  // namespace neve::app::view::session

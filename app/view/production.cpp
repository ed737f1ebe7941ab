#include "app/view/production.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <string>
#include <vector>

#include "app/command_text.h"
#include "app/output/atomic_file.h"
#include "app/scene/error.h"
#include "app/scene/flat.h"
#include "app/scene/leaf.h"
#include "app/scene/read.h"
#include "app/sweep/around.h"

namespace neve::app {

namespace {

/// A preset among all parameters of a scene: nothing but its choices matters to a sweep.
std::vector<FlatParam> with_presets(const Scene& scene) {
  std::vector<FlatParam> params = flatten(scene);
  for (const sim::Material& material : scene.materials) {
    FlatParam& param = params.emplace_back();
    param.address = "material." + material.name + ".preset";
    param.type = "choice";
    param.choices = choices<Preset>();
    param.help = "Kinds of snow by name.";
    if (const auto preset = preset_of(material)) param.value = to_value(*preset);
  }
  return params;
}

/// What is set in all runs of a sweep: not the numbers that its presets set.
std::vector<Override> set_in_all(const Document& document, const std::string& address) {
  std::vector<Override> all = document.all_overrides();
  if (!is_preset_address(address)) return all;
  const std::vector<std::string> numbers = addresses_set_by(address);
  std::erase_if(all, [&](const Override& override) {
    return std::find(numbers.begin(), numbers.end(), override.address) != numbers.end();
  });
  return all;
}

/// The value before the scene was coarsened, where it has one: the runs of the sweep are coarsened
/// after their values are set.
void take_finer_value(FlatParam& param, const Document& document) {
  if (!(document.coarsening() > 1)) return;
  const Scene finer = read_scene_text(document.text(), document.file(),
                                      std::filesystem::path(document.file()).parent_path().string(),
                                      document.all_overrides());
  for (const FlatParam& other : flatten(finer))
    if (other.address == param.address && other.value) param.value = other.value;
}

}  // namespace

std::string plain_file_name(const std::string& address) {
  std::string name = address;
  for (char& c : name)
    if (!std::isalnum(static_cast<unsigned char>(c)) && c != '_' && c != '-') c = '_';
  return name;
}

std::string render_command(const Document& document) {
  RenderCommand command;
  command.scene_file = document.file();
  command.overrides = document.all_overrides();
  command.coarsening = document.coarsening();
  return command_line(command);
}

void write_sweep_around(const std::filesystem::path& file, const Document& document,
                        const std::string& address, const std::vector<std::string>& set_later) {
  for (FlatParam& param : with_presets(*document.scene())) {
    if (param.address != address) continue;
    take_finer_value(param, document);
    make_folder(file.parent_path());
    write_file(file, sweep_around(document.file(), file.string(), param,
                                  set_in_all(document, address), document.coarsening(), set_later));
    return;
  }
  throw UsageError("", "nothing has the address " + address);
}

}  // namespace neve::app

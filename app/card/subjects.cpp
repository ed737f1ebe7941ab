#include "app/card/subjects.h"

#include <algorithm>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <system_error>
#include <vector>

#include "app/advice/suggest.h"
#include "app/card/again.h"
#include "app/scene/names.h"
#include "app/scene/override.h"
#include "app/scene/presets.h"
#include "app/scene/read.h"
#include "app/setup/curves.h"
#include "app/support/errors.h"
#include "app/timeline/changes.h"

namespace neve::app::card {

namespace {

/// More materials make a sweep, and not a card.
constexpr std::size_t max_materials = 8;

/// Returns the materials that bodies and emitters have; all of a scene without them.
std::vector<std::string> used_materials(const scene::Scene& scene) {
  const auto is_used = [&](const std::string& name) {
    const auto has_it = [&](const auto& item) { return item.material == name; };
    return std::any_of(scene.bodies.begin(), scene.bodies.end(), has_it) ||
           std::any_of(scene.emitters.begin(), scene.emitters.end(), has_it);
  };
  std::vector<std::string> all, used;
  for (const sim::Material& material : scene.materials) {
    all.push_back(material.name);
    if (is_used(material.name)) used.push_back(material.name);
  }
  return used.empty() ? all : used;
}

void add_sources(const timeline::Origin& origin, const std::string& title,
                 const CardOptions& options, std::vector<Source>& sources) {
  const std::vector<std::string> used = used_materials(origin.scene);
  for (const sim::Material& material : origin.scene.materials) {
    const auto is_in = [&](const std::vector<std::string>& names) {
      return std::find(names.begin(), names.end(), material.name) != names.end();
    };
    if (!is_in(options.materials.empty() ? used : options.materials)) continue;
    const bool is_alone = used.size() == 1 && options.materials.empty();
    sources.push_back({subject_at_start(origin.scene, material.name,
                                        is_alone ? title : title + ": " + material.name),
                       title, origin});
  }
}

/// Returns the addresses that these edits set: changes of a run do not take them back.
std::vector<std::string> set_by(const std::vector<std::string>& overrides) {
  std::vector<std::string> set = scene::addresses_of(scene::parse_overrides(overrides));
  for (std::size_t k = 0, count = set.size(); k < count; ++k)
    if (scene::is_preset_address(set[k])) {
      const std::vector<std::string> numbers = scene::addresses_set_by(set[k]);
      set.insert(set.end(), numbers.begin(), numbers.end());
    }
  return set;
}

/// A ball of the preset, with the law of scenes that name none.
timeline::Origin origin_of(scene::Preset preset, const CardOptions& options) {
  const std::string name = scene::name(preset);
  timeline::Origin origin;
  origin.scene_file = name;
  origin.overrides = options.overrides;
  origin.scene =
      scene::read_scene_text("[material.snow]\npreset = \"" + name +
                                 "\"\n[[body]]\nname = \"ball\"\nshape = { sphere = { "
                                 "center = [0, 0.15, 0], radius = 0.15 } }\n",
                             "preset " + name, {}, scene::parse_overrides(options.overrides));
  origin.frames = {0, scene::last_frame(origin.scene)};
  return origin;
}

/// Refuses the name of a preset in the place of a scene. @throws UsageError
void refuse_preset(const std::string& named) {
  std::error_code error;
  if (scene::value_named<scene::Preset>(named) && !std::filesystem::exists(named, error))
    throw UsageError(named, "is a preset, and no scene", "give it as --preset " + named);
}

/// @param cards  of pictures
void check_names(const CardOptions& options, const std::vector<timeline::Origin>& origins,
                 const std::vector<Source>& cards) {
  std::vector<std::string> names;
  const auto add = [&](const std::string& name) {
    if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  };
  for (const Source& card : cards) add(card.subject.material.name);
  for (const timeline::Origin& origin : origins)
    for (const sim::Material& material : origin.scene.materials) add(material.name);
  for (const std::string& name : options.materials)
    if (std::find(names.begin(), names.end(), name) == names.end())
      throw UsageError("--material", "there is no material \"" + name + "\"",
                       advice::suggest_one_of(name, {"material", names}));
}

}  // namespace

Subject subject_at_start(const scene::Scene& scene, const std::string& material,
                         const std::string& title) {
  const scene::Scene start = setup::with_curves(scene, 0);
  const auto found = std::ranges::find(start.materials, material, &sim::Material::name);
  if (found == start.materials.end()) throw std::runtime_error("its scene has no " + material);
  return {title, *found, start.solver, start.seed};
}

std::vector<Source> sources_of(const CardOptions& options) {
  timeline::Edits edits{options.overrides};
  edits.agreement = options.is_agreed ? timeline::Agreement::given : timeline::Agreement::asked;
  edits.is_start_only = true;
  edits.takes_cards = true;
  std::vector<Source> sources;
  std::vector<timeline::Origin> origins;
  std::vector<std::string> titles;
  const bool is_default = options.scenes.empty() && options.presets.empty();
  for (const std::string& named : is_default ? std::vector<std::string>{""} : options.scenes) {
    refuse_preset(named);
    const timeline::Origin origin = timeline::Origin::of(named, edits);
    const std::vector<Source> cards = cards_in(origin, options.overrides);
    sources.insert(sources.end(), cards.begin(), cards.end());
    if (!cards.empty()) continue;
    origins.push_back(origin);
    scene::Scene& scene = origins.back().scene;
    std::vector<scene::LiveChange> changes = timeline::changes_of(scene, origin.changes);
    std::erase_if(changes, [set = set_by(options.overrides)](const scene::LiveChange& change) {
      return std::ranges::find(set, change.address) != set.end();
    });
    scene = timeline::with_changes(scene, changes);
    titles.push_back(origins.back().name());
  }
  for (const scene::Preset preset : options.presets) {
    titles.emplace_back(scene::name(preset));
    origins.push_back(origin_of(preset, options));
  }
  check_names(options, origins, sources);
  if (!options.materials.empty())
    std::erase_if(sources, [&](const Source& card) {
      return std::ranges::find(options.materials, card.subject.material.name) ==
             options.materials.end();
    });
  for (std::size_t k = 0; k < origins.size(); ++k)
    add_sources(origins[k], titles[k], options, sources);
  if (sources.size() > max_materials)
    throw UsageError("",
                     "a picture has at most " + std::to_string(max_materials) + " cards, not " +
                         std::to_string(sources.size()),
                     "--material chooses some");
  return sources;
}

}  // namespace neve::app::card

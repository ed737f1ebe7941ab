#include "app/card/again.h"

#include <algorithm>
#include <array>
#include <optional>
#include <stdexcept>

#include "app/output/atomic_file.h"
#include "app/output/sequence.h"
#include "app/record/picture_files.h"
#include "app/record/picture_record.h"
#include "app/scene/override.h"
#include "app/scene/read.h"
#include "app/setup/curves.h"
#include "app/support/errors.h"
#include "app/support/text.h"
#include "app/support/version.h"
#include "sim/kernels/simd.h"

namespace neve::app::card {

namespace {

constexpr const char* key = "neve:card";

/// A card of a picture, which may be from anyone.
Source source_of(const Json& json, const timeline::Origin& origin,
                 const std::vector<std::string>& overrides) {
  const std::string& file = origin.scene_file;
  Source source;
  source.origin = origin;
  source.origin.overrides = json.at("overrides").get<std::vector<std::string>>();
  source.origin.overrides.insert(source.origin.overrides.end(), overrides.begin(), overrides.end());
  source.origin.scene =
      scene::read_scene_text(json.at("scene").get<std::string>(), file + " (its scene)", {},
                             scene::parse_overrides(overrides));
  setup::refuse_followers(source.origin.scene, scene::parse_overrides(overrides));
  record::require_listed(*origin.picture, source.origin.scene, file);
  source.name = json.at("name").get<std::string>();
  if (!output::is_plain_name(source.name)) throw std::runtime_error("it has no plain name");
  source.subject = subject_at_start(source.origin.scene, json.at("material").get<std::string>(),
                                    line_text(json.at("title").get<std::string>()));
  return source;
}

/// Nothing where there is no such text, or no PNG that can be read.
std::optional<std::string> text_in(const std::filesystem::path& picture, const char* name) {
  try {
    const render::PngText texts = render::read_png_text(output::read_file(picture));
    const auto found = texts.find(name);
    return found == texts.end() ? std::nullopt : std::optional(found->second);
  } catch (const render::ImageError&) {
    return std::nullopt;
  } catch (const IoError&) {
    return std::nullopt;
  }
}

/// Names of scenes may have blanks and signs.
std::string plain(std::string name) {
  for (char& c : name)
    if (!output::is_plain_name(std::string(1, c))) c = '_';
  return name;
}

}  // namespace

render::PngText texts_of(const std::vector<Source>& sources) {
  const timeline::Origin& origin = sources.front().origin;
  record::PictureRecord record;
  record.scene = scene::write_scene(origin.scene);
  record.overrides = origin.overrides;
  record.coarsening = origin.coarsening;
  record.seed = origin.scene.seed;
  record.version = version;
  record.build = build_text(sim::kernels::name(sim::kernels::chosen_simd_level()));
  record.view = origin.scene.views.front().name;
  record.frame = scene::number_of(origin.scene, 0);
  record.quality = "preview";
  Json cards = Json::array();
  for (const Source& source : sources) {
    cards.push_back({{"title", source.subject.title},
                     {"name", plain(source.name)},
                     {"material", source.subject.material.name},
                     {"overrides", source.origin.overrides},
                     {"scene", scene::write_scene(source.origin.scene)}});
    record.files.merge(record::hash_files(source.origin.scene));
  }
  render::PngText text = record::to_png_text(record);
  text[key] = to_text(cards, -1);
  return text;
}

bool is_card(const std::filesystem::path& picture) {
  return text_in(picture, key).has_value();
}

bool shows_cards(const std::filesystem::path& picture, const render::PngText& texts) {
  return std::ranges::all_of(std::array{key, "neve:files"}, [&](const char* name) {
    return text_in(picture, name) == texts.at(name);
  });
}

std::vector<Source> cards_in(const timeline::Origin& origin,
                             const std::vector<std::string>& overrides) {
  std::vector<Source> sources;
  if (!origin.picture) return sources;
  render::PngText texts;
  try {
    texts = render::read_png_text(output::read_file(origin.scene_file));
  } catch (const render::ImageError&) {
    return sources;  // an OpenEXR picture shows no cards
  }
  const auto text = texts.find(key);
  if (text == texts.end()) return sources;
  try {
    for (const Json& card : parse_json(std::string_view(text->second)))
      sources.push_back(source_of(card, origin, overrides));
  } catch (const nlohmann::json::exception&) {
    throw Error(exit_invalid_scene,
                origin.scene_file + ": error: its text " + key + " was not written by neve",
                origin.scene_file);
  } catch (const UsageError&) {
    throw;
  } catch (const std::runtime_error& error) {
    throw Error(exit_invalid_scene,
                origin.scene_file + ": error: its text " + key +
                    " was not written by neve: " + error.what(),
                origin.scene_file);
  }
  return sources;
}

}  // namespace neve::app::card

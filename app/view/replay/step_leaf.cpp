#include "app/view/replay/step_leaf.h"

#include <algorithm>
#include <filesystem>
#include <iterator>

#include "app/advice/suggest.h"
#include "app/support/text.h"
#include "app/view/frontend/key_names.h"

namespace neve::app::view::replay {

namespace {

constexpr std::size_t max_text = 64 << 10, max_places = 10'000;

/// A number between two bounds; `what` names the allowed values.
double number(const scene::Leaf& leaf, const scene::toml::Value& value, double low, double high,
              const std::string& what) {
  double x = low - 1;
  if (const auto* whole = std::get_if<std::int64_t>(&value.data)) x = static_cast<double>(*whole);
  if (const auto* real = std::get_if<double>(&value.data)) x = *real;
  if (!(x >= low && x <= high)) leaf.fail(what);
  return x;
}

std::string text_of(const scene::Leaf& leaf, const std::string& what) {
  const std::string& text = leaf.text(what);
  if (text.empty()) leaf.fail(what);
  if (text.size() > max_text) leaf.fail("at most 64 KiB");
  return text;
}

ReplayPlace place_of(const scene::Leaf& leaf, const scene::toml::Value& value) {
  static const std::string what =
      "a place: [x, y] in px, a label, or {\"label\": ..., \"part\": [0.5, 0.5]}";
  ReplayPlace place;
  const auto read_pair = [&](const scene::toml::Value& list, double low, double high) {
    const auto* pair = std::get_if<scene::toml::Array>(&list.data);
    if (!pair || pair->size() != 2) leaf.fail(what);
    place.x = static_cast<float>(number(leaf, (*pair)[0], low, high, what));
    place.y = static_cast<float>(number(leaf, (*pair)[1], low, high, what));
  };
  if (std::holds_alternative<scene::toml::Array>(value.data)) {
    read_pair(value, -1e5, 1e5);
    return place;
  }
  const auto* table = std::get_if<scene::toml::Table>(&value.data);
  const scene::toml::Entry* label = table ? table->find("label") : nullptr;
  const scene::toml::Entry* part = table ? table->find("part") : nullptr;
  if (table && (!label || table->entries.size() != (part ? 2u : 1u))) leaf.fail(what);
  const auto* name = std::get_if<std::string>(label ? &label->value.data : &value.data);
  if (!name || name->empty()) leaf.fail(what);
  place.label = *name;
  if (part) read_pair(part->value, 0, 1);
  return place;
}

/// True if a relative name stays within its folder.
bool stays_inside(const std::filesystem::path& file) {
  return !file.has_root_path() &&
         std::none_of(file.begin(), file.end(), [](const auto& part) { return part == ".."; });
}

}  // namespace

void read_leaf(const scene::Leaf& leaf, OnePlace& member) {
  member.places = {place_of(leaf, leaf.value)};
}

void read_leaf(const scene::Leaf& leaf, std::vector<ReplayPlace>& member) {
  const std::string what = "a list of two places or more";
  const scene::toml::Array& list = leaf.array(0, what);
  if (list.size() < 2 || list.size() > max_places) leaf.fail(what);
  member.clear();
  for (const scene::toml::Value& value : list) member.push_back(place_of(leaf, value));
}

void read_leaf(const scene::Leaf& leaf, MouseButton& member) {
  const std::string what = "\"left\", \"right\" or \"middle\"";
  const auto* found = std::find(std::begin(button_names), std::end(button_names), leaf.text(what));
  if (found == std::end(button_names)) leaf.fail(what);
  member.index = static_cast<int>(found - std::begin(button_names));
}

void read_leaf(const scene::Leaf& leaf, Notches& member) {
  const std::string what = "notches up, or [right, up], each from -100 to 100";
  const auto* both = std::get_if<scene::toml::Array>(&leaf.value.data);
  if (both && both->size() != 2) leaf.fail(what);
  if (both) member.right = static_cast<float>(number(leaf, (*both)[0], -100, 100, what));
  member.up = static_cast<float>(number(leaf, both ? (*both)[1] : leaf.value, -100, 100, what));
}

void read_leaf(const scene::Leaf& leaf, KeyCode& member) {
  const std::string name = text_of(leaf, "the name of a key");
  const std::optional<int> code = frontend::key_named(name);
  if (!code)
    leaf.fail("the name of a key", advice::suggest(name, {"", frontend::key_names(), true},
                                                   "a letter, a digit, a sign, or one of " +
                                                       joined(frontend::key_names(), ", ")));
  member.code = *code;
}

void read_leaf(const scene::Leaf& leaf, SomeText& member) {
  member.text = text_of(leaf, "some text");
}

void read_leaf(const scene::Leaf& leaf, WaitGoal& member) {
  const std::string what =
      "\"simulation frame N\", \"simulation running\", \"simulation paused\" or \"label NAME\"";
  member.text = text_of(leaf, what);
  if (!parse_goal(member.text)) leaf.fail(what);
}

void read_leaf(const scene::Leaf& leaf, PictureFile& member) {
  member.name = text_of(leaf, "the name of a PNG file");
  if (!member.name.ends_with(".png")) leaf.fail("a name that ends in .png");
  if (!stays_inside(member.name))
    leaf.fail("a relative name within the folder of --out, without \"..\"");
}

void read_leaf(const scene::Leaf& leaf, Crop& member) {
  const std::string what = "a label, or [x, y, width, height] in px";
  if (std::holds_alternative<std::string>(leaf.value.data)) {
    member.label = text_of(leaf, what);
    return;
  }
  const scene::toml::Array& list = leaf.array(4, what);
  std::array<int, 4> box{};
  for (std::size_t k = 0; k < 4; ++k)
    box[k] = static_cast<int>(number(leaf, list[k], k < 2 ? 0 : 1, 16'384, what));
  member.box = box;
}

void read_leaf(const scene::Leaf& leaf, Resolution& member) {
  const std::string what = "[width, height] in px from 64 to 8192, or with a scale from 0.5 to 4";
  const scene::toml::Array& list = leaf.array(0, what);
  if (list.size() < 2 || list.size() > 3) leaf.fail(what);
  member.size.width = static_cast<int>(number(leaf, list[0], 64, 8192, what));
  member.size.height = static_cast<int>(number(leaf, list[1], 64, 8192, what));
  if (list.size() == 3) member.size.scale = static_cast<float>(number(leaf, list[2], 0.5, 4, what));
}

void read_leaf(const scene::Leaf& leaf, MustBeTrue&) {
  const bool* is_true = std::get_if<bool>(&leaf.value.data);
  if (!is_true || !*is_true) leaf.fail("true");
}

}  // namespace neve::app::view::replay

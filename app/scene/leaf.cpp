#include "app/scene/leaf.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string_view>

#include "app/advice/suggest.h"
#include "app/advice/wishes.h"
#include "app/scene/presets.h"
#include "app/scene/scene_file.h"
#include "app/scene/toml/error.h"
#include "app/scene/toml/toml_text.h"
#include "app/support/text.h"
#include "sim/shapes/held_files.h"
#include "sim/shapes/numbered_files.h"

namespace neve::app::scene {
namespace {

/// A number, whole or not, within the bounds; `kind` names the expected value in messages.
double bounded_number(const Leaf& leaf, const std::string& kind) {
  double x = 0;
  if (const auto* i = std::get_if<std::int64_t>(&leaf.value.data)) {
    x = static_cast<double>(*i);
  } else if (const auto* f = std::get_if<double>(&leaf.value.data)) {
    x = *f;
  } else {
    const auto* text = std::get_if<std::string>(&leaf.value.data);
    const bool is_vector_of_curve =
        std::holds_alternative<toml::Array>(leaf.value.data) && leaf.address.ends_with("].value");
    leaf.fail(kind, text                 ? advice::number_advice(*text, leaf.unit)
                    : is_vector_of_curve ? "of a vector the key is vector = " +
                                               toml::toml_literal(leaf.value, toml::max_shown)
                                         : "");
  }
  if (!std::isfinite(x)) leaf.fail("a finite number");
  if (!leaf.valid.contains(x)) leaf.fail(leaf.valid.text_of_bounds(), leaf.valid.advice_on(x));
  return x;
}

/// Bounds of integers end at 2^53: what going through double rounds lies beyond them.
double bounded_whole_number(const Leaf& leaf) {
  const double x = bounded_number(leaf, "a whole number");
  if (x != std::trunc(x)) leaf.fail("a whole number");
  const auto* whole = std::get_if<std::int64_t>(&leaf.value.data);
  if (whole && static_cast<std::int64_t>(x) != *whole) leaf.fail(leaf.valid.text_of_bounds());
  return x;
}

/// Pictures and runs name the file in texts of UTF-8.
std::string absolute_path(const Leaf& leaf, const std::string& name) {
  std::error_code error;
  const std::filesystem::path folder = leaf.source.base_dir;
  std::string path = std::filesystem::absolute(folder / name, error).lexically_normal().string();
  if (!toml::is_utf8(path))
    leaf.fail("a file in folders whose names are UTF-8", "rename the folder: " + path);
  return path;
}

/// Names the path that was tried, and a file there that has nearly that name.
std::string advice_on_file(const std::string& name, const std::filesystem::path& file) {
  const std::string looked = "looked for " + file.string();
  if (name.starts_with("~")) return looked + "; ~ is not expanded here: write the whole path";
  if (name.find('\\') != std::string::npos) return looked + "; folders have / between them";
  if (const std::string kind = kind_of_no_file(file); !kind.empty())
    return looked + ", which is " + kind;
  std::vector<std::string> names;
  std::error_code error;
  for (std::filesystem::directory_iterator at(file.parent_path(), error), end;
       !error && at != end && names.size() < 10'000; at.increment(error)) {
    names.push_back(at->path().filename().string());
  }
  std::sort(names.begin(), names.end());
  const std::string question = advice::suggest(file.filename().string(), {"", names});
  return looked + (question.empty() ? "" : "; " + question);
}

std::string existing_file(const Leaf& leaf, const std::string& name) {
  std::error_code error;
  const std::string file = absolute_path(leaf, name);
  // A run that reads its scene again has read the file, which may be gone for a moment.
  const bool exists = sim::shapes::is_held(file) || std::filesystem::is_regular_file(file, error);
  if (name.empty() || !exists) leaf.fail("a file that exists", advice_on_file(name, file));
  return file;
}

/// Requires the place of a number. The whole shape tells which numbers have to exist.
std::string numbered_files(const Leaf& leaf, const std::string& name) {
  if (!sim::shapes::is_file_pattern(name))
    leaf.fail("one %d, %04d, #### or $F4 in the name of the files, where their number goes",
              "for plate_0001.obj and so on give files = \"plate_%04d.obj\"");
  return absolute_path(leaf, name);
}

/// Nothing runs in less than a megabyte: 8 is 8GiB without its unit.
void refuse_few_bytes(const Leaf& leaf) {
  const auto* count = std::get_if<std::int64_t>(&leaf.value.data);
  if (count && *count > 0 && *count < 1'000'000)
    leaf.fail("bytes, or a size such as \"8GiB\" or \"500MB\"",
              advice::did_you_mean(std::to_string(*count) + "GiB", true));
}

}  // namespace

void Source::fail(toml::Location where, const std::string& message, const std::string& hint) const {
  if (where.override_index >= 0) {
    const Override& given = overrides[static_cast<std::size_t>(where.override_index)];
    given.fail(given.place, message, hint);
  }
  throw toml::SceneError(file, where.line, where.column, message, hint);
}

void Leaf::fail(const std::string& expected, const std::string& hint) const {
  const std::string wanted = "expected " + expected;
  // A --set is shown as it was typed; repeating it would say nothing new.
  const int index = value.where.override_index;
  if (index >= 0 && source.overrides[static_cast<std::size_t>(index)].file.empty())
    source.fail(value.where, wanted, hint);
  source.fail(value.where, address + " = " + toml::toml_literal(value, toml::max_shown),
              hint.empty() ? wanted : wanted + "; " + hint);
}

Leaf Leaf::element(std::size_t index) const {
  const toml::Value& item = std::get<toml::Array>(value.data)[index];
  return {source, item, address + "[" + std::to_string(index) + "]", unit, valid};
}

const toml::Array& Leaf::array(std::size_t count, const std::string& what) const {
  const toml::Array* items = std::get_if<toml::Array>(&value.data);
  if (!items || (count != 0 && items->size() != count)) fail(what);
  return *items;
}

const std::string& Leaf::text(const std::string& what) const {
  const std::string* content = std::get_if<std::string>(&value.data);
  if (!content) fail(what);
  return *content;
}

void read_leaf(const Leaf& leaf, bool& member) {
  const bool* value = std::get_if<bool>(&leaf.value.data);
  if (!value) leaf.fail("true or false");
  member = *value;
}

void read_leaf(const Leaf& leaf, double& member) {
  member = bounded_number(leaf, "a number");
}

void read_leaf(const Leaf& leaf, int& member) {
  member = static_cast<int>(bounded_whole_number(leaf));
}

void read_leaf(const Leaf& leaf, std::uint64_t& member) {
  const auto* text = std::get_if<std::string>(&leaf.value.data);
  const bool is_bytes = std::string_view(leaf.unit) == "B";
  if (!text || !is_bytes) {
    if (is_bytes) refuse_few_bytes(leaf);
    member = static_cast<std::uint64_t>(bounded_whole_number(leaf));
    return;
  }
  const std::optional<double> bytes = bytes_of(*text);
  if (!bytes) leaf.fail("bytes, or a size such as \"8GiB\" or \"500MB\"");
  if (!leaf.valid.contains(*bytes)) leaf.fail(leaf.valid.text_of_bounds());
  member = static_cast<std::uint64_t>(*bytes);
}

void read_leaf(const Leaf& leaf, std::string& member) {
  const std::string& text = leaf.text("a string");
  if (leaf.valid.text == Valid::Text::name && !is_identifier(text)) {
    leaf.fail("a name of 1 to 64 letters, digits, _ and -");
  }
  switch (leaf.valid.text) {
    case Valid::Text::file:
      member = existing_file(leaf, text);
      break;
    case Valid::Text::numbered_files:
      member = numbered_files(leaf, text);
      break;
    default:
      member = text;
  }
}

void read_leaf(const Leaf& leaf, sim::Vec3d& member) {
  const char* const wanted = "three numbers [x, y, z]";
  const auto* items = std::get_if<toml::Array>(&leaf.value.data);
  if (!items || items->size() != 3)
    leaf.fail(wanted, advice::vector_advice(leaf.value, leaf.address));
  for (std::size_t k = 0; k < 3; ++k) {
    read_leaf(leaf.element(k), member[static_cast<Eigen::Index>(k)]);
  }
}

void read_leaf(const Leaf& leaf, std::vector<std::string>& member) {
  member.clear();
  const std::size_t count = leaf.array(0, "a list of texts, [\"...\"]").size();
  for (std::size_t k = 0; k < count; ++k) read_leaf(leaf.element(k), member.emplace_back());
}

void read_leaf(const Leaf& leaf, std::optional<sim::Vec3d>& member) {
  member.reset();
  const auto* text = std::get_if<std::string>(&leaf.value.data);
  if (text && *text == "auto") return;
  read_leaf(leaf, member.emplace());
}

void read_leaf(const Leaf& leaf, PictureSize& member) {
  leaf.array(2, "two whole numbers [width, height]");
  read_leaf(leaf.element(0), member.width);
  read_leaf(leaf.element(1), member.height);
}

void read_leaf(const Leaf& leaf, std::optional<Range>& member) {
  member.reset();
  if (const auto* text = std::get_if<std::string>(&leaf.value.data)) {
    if (*text == "auto") return;
  }
  leaf.array(2, "\"auto\" or two numbers [min, max]");
  Range range;
  read_leaf(leaf.element(0), range.min);
  read_leaf(leaf.element(1), range.max);
  // Colours are looked up in single precision.
  if (!(static_cast<float>(range.min) < static_cast<float>(range.max))) leaf.fail("min < max");
  member = range;
}

toml::Value to_value(const sim::Vec3d& member) {
  return {toml::Array{to_value(member.x()), to_value(member.y()), to_value(member.z())}};
}
toml::Value to_value(const PictureSize& member) {
  return {toml::Array{to_value(member.width), to_value(member.height)}};
}
toml::Value to_value(const std::optional<Range>& member) {
  if (!member) return {std::string("auto")};
  return {toml::Array{to_value(member->min), to_value(member->max)}};
}

void read_leaf(const Leaf& leaf, sim::laws::OneOf& member) {
  const auto* text = std::get_if<std::string>(&leaf.value.data);
  const std::vector<std::string> allowed = choices(member);
  const auto found = text ? std::find(allowed.begin(), allowed.end(), *text) : allowed.end();
  if (found == allowed.end()) fail_choice(leaf, allowed);
  member.place = static_cast<std::size_t>(found - allowed.begin());
}

toml::Value to_value(const sim::laws::OneOf& member) {
  return {std::string(member.name())};
}

std::vector<std::string> choices(const sim::laws::OneOf& member) {
  return {member.names.begin(), member.names.end()};
}

std::string list_of(const std::vector<std::string>& names) {
  constexpr std::size_t max_named = 60;  // no table and no parameter has as many words
  const std::size_t named = names.size() > max_named ? max_named / 3 : names.size();
  std::string text;
  for (std::size_t k = 0; k < named; ++k) {
    if (k > 0) text += k + 1 == names.size() ? " or " : ", ";
    text += toml::toml_string(names[k]);
  }
  if (named < names.size()) text += fmt::format(" or one of {} more", names.size() - named);
  return text;
}

std::string name_advice(const std::string& name, const std::vector<std::string>& known) {
  if (known.empty()) return "the scene has none";
  return advice::suggest(name, {"", known, true}, "expected " + list_of(known));
}

namespace {

/// Returns the name of a choice in the table of words.
std::string context_of(const std::string& address) {
  if (address.ends_with("colormap")) return "colormap";
  if (address.starts_with("material.")) return "material.NAME" + address.substr(address.rfind('.'));
  if (address.starts_with("collider.") && address.ends_with(".style")) return "collider.NAME.style";
  if (address.starts_with("view.") && address.find(".layers[") != std::string::npos)
    return "view.NAME.layers";
  if (!address.starts_with("export.")) return address;
  return address.ends_with(".format")                        ? "format of an export"
         : address.find(".attributes[") != std::string::npos ? "attribute"
                                                             : address;
}

/// Advice for words that no table has; empty: none.
std::string advice_on_choice(const std::string& address, const std::string& text) {
  if (!is_preset_address(address)) return {};
  for (const advice::Wish* wish : advice::wishes_for(text))
    return "for snow that is " + std::string(wish->name) + " see " + wish->changes.front().address +
           " (neve params " + text + ")";
  return {};
}

}  // namespace

void fail_choice(const Leaf& leaf, const std::vector<std::string>& allowed) {
  const auto* text = std::get_if<std::string>(&leaf.value.data);
  if (!text) leaf.fail(list_of(allowed));
  const advice::Context context{context_of(leaf.address), allowed, true};
  std::string hint = advice::suggest(*text, context, advice_on_choice(leaf.address, *text));
  if (context.name == "attribute" && advice::nearest_name(*text, allowed).empty())
    hint += (hint.empty() ? "" : " ") + std::string("columns of point files are named in carried");
  leaf.fail(list_of(allowed), hint);
}

}  // namespace neve::app::scene

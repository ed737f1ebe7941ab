#include "app/scene/reader.h"

#include <algorithm>

#include "app/advice/suggest.h"
#include "app/scene/params.h"
#include "app/support/text.h"

namespace neve::app::scene {
namespace {

/// Forms and keyframes are independent: keys of other forms are no help.
bool is_of_one_kind_alone(const std::string& address) {
  return address.find(".shape.") != std::string::npos || address.find('[') != std::string::npos;
}

/// The first shape of a kind of thing that has such a key: sphere for rotation, mesh for file.
std::string shape_with(const std::string& kind, const std::string& key) {
  const std::string start = kind + ".NAME.shape.", end = "." + key;
  for (const ParamInfo& info : params())
    if (info.address.starts_with(start) && info.address.ends_with(end))
      return info.address.substr(start.size(), info.address.size() - start.size() - end.size());
  return {};
}

bool contains(const std::vector<std::string>& list, const std::string& name) {
  return std::find(list.begin(), list.end(), name) != list.end();
}

/// The only parameter of that name in other tables, or the one of the same item; of several that of
/// a material, which has what snow has; material.NAME.x before material.NAME.variation.x.
std::string other_address(const std::string& key, const std::string& here) {
  const std::string kind = here.substr(0, here.find('.')) + ".";
  std::vector<std::string> found;
  for (const ParamInfo& info : params()) {
    if (!info.address.ends_with("." + key) || is_of_one_kind_alone(info.address)) continue;
    if (info.address == kind + "NAME." + key) return info.address;
    if (info.address.find(".variation.") == std::string::npos) found.push_back(info.address);
  }
  if (contains(found, "material.NAME." + key)) return "material.NAME." + key;
  return found.size() == 1 ? found.front() : "";
}

/// The only parameter that a word of other programs means.
std::string address_meant(const std::string& key) {
  for (const ParamInfo& info : params()) {
    const std::string ours =
        advice::our_name(key, {"key", {info.address.substr(info.address.rfind('.') + 1)}});
    if (const std::string found = ours.empty() ? "" : other_address(ours, ""); !found.empty())
      return found;
  }
  return "";
}

bool is_at_the_top(const std::string& key) {
  const std::vector<ParamInfo>& all = params();
  return std::any_of(all.begin(), all.end(),
                     [&](const ParamInfo& info) { return info.address == key; });
}

/// The table of a scene that is spelt nearly so; "": none.
std::string table_meant(const std::string& key) {
  std::vector<std::string> tables;
  for (const ParamInfo& info : params())
    tables.push_back(info.address.substr(0, info.address.find('.')));
  return advice::nearest_name(key, tables);
}

/// A parameter of the scene in a file of a sweep: its address, a table of it, or a key of it.
std::string advice_on_set(const std::string& key) {
  const auto as_setting = [](const std::string& address) {
    return "parameters of the scene belong in [set], as in \"" + address + "\" = ...";
  };
  if (is_at_the_top(key)) return as_setting(key);
  const std::string table = table_meant(key);
  for (const ParamInfo& info : params())
    if (!table.empty() && info.address.starts_with(table + ".")) return as_setting(info.address);
  const std::string address = key.size() > 1 ? other_address(key, "") : "";
  return address.empty() ? "" : as_setting(address);
}

/// The same in the table [sheet], which has a camera by another name.
std::string advice_on_sheet(const std::string& key) {
  for (const std::string& word : {key, table_meant(key)})
    if (const advice::Entry* look = advice::entry_of("key of a sheet", word)) return look->sentence;
  return advice_on_set(key);
}

/// Keys of the table that a kind of thing describes its shape in.
std::vector<std::string> forms_of(const std::string& kind) {
  Keys forms;
  sim::shapes::Shape shape;
  if (kind == "body") describe_body_forms(forms, shape);
  if (kind == "collider") describe_collider_forms(forms, shape);
  if (kind == "emitter" || kind == "sink") describe_solid_forms(forms, shape);
  return forms.keys;
}

/// Advice for an unknown form.
std::string form_advice(const std::string& key, const std::vector<std::string>& forms) {
  if (key == "plane") return "only colliders can be planes: use a large box";
  if (key == "terrain") return "only colliders can be terrain: snow on one is a cover";
  if (key == "points") return "only bodies can be points";
  if (key == "cover") return "only bodies can be covers";
  return advice::suggest(key, {"key", forms, true}, "expected " + list_of(forms));
}

}  // namespace

toml::Location Reading::place_of(std::string address) const {
  while (!address.empty()) {
    const auto found = places.find(address);
    if (found != places.end()) return found->second;
    const auto dot = address.rfind('.');
    address.resize(dot == std::string::npos ? 0 : dot);
  }
  return {1, 1};
}

/// Advice for an unknown key.
std::string Reader::advice(const std::string& key, const std::vector<std::string>& known) const {
  const advice::Context keys{"key", known, true};
  if (const std::string other = advice::our_name(key, keys); !other.empty())
    return advice::did_you_mean(other, true);
  const std::string kind = address_.substr(0, address_.find('.'));
  if (contains(known, "shape") && contains(forms_of(kind), key))
    return "write shape = { " + key + " = { ... } }";
  if (contains(known, "shape") && key == "plane") return "only colliders can be planes";
  if (address_.ends_with(".box"))
    if (const advice::Entry* meant = advice::entry_of("key of a box", key)) return meant->sentence;
  if (const std::string shape = shape_with(kind, key); contains(known, "shape") && !shape.empty())
    return "it belongs in the shape: shape = { " + shape + " = { ..., " + key + " = ... } }";
  if (std::string question = advice::suggest(key, keys); !question.empty()) return question;
  for (const char* table : {"sheet", "axis", "set", "link", "run"})
    if (reading_.is_scene && address_.empty() && key == table)
      return "[" + key + "] belongs in the file of a sweep; neve params --sweep has its keys";
  if (reading_.is_sweep) {
    const std::string set = address_ == "sheet" ? advice_on_sheet(key) : advice_on_set(key);
    return set.empty() ? "expected " + list_of(known) : set;
  }
  if (!reading_.is_scene) return "expected " + list_of(known);
  if (!address_.empty() && is_at_the_top(key))
    return "it belongs at the top of the file, before the first [table]";
  if (const advice::Entry* flag = advice::entry_of("key that is a flag", key))
    return "it is a flag of the command line: neve render SCENE " + joined(flag->names, " ");
  if (const std::string address = address_.empty() ? address_meant(key) : ""; !address.empty())
    return advice::did_you_mean(address);
  // A key of another table was put into this one; single letters say too little to guess.
  const std::string elsewhere = key.size() > 1 ? other_address(key, address_) : "";
  return elsewhere.empty() ? "expected " + list_of(known) : advice::did_you_mean(elsewhere);
}

const toml::Entry* Reader::given(const char* key) {
  const toml::Entry* entry = table_.find(key);
  if (entry) reading_.places[address_of(key)] = entry->value.where;
  return entry;
}

const toml::Table& Reader::table_of(const toml::Value& value, const std::string& address) const {
  const toml::Table* table = std::get_if<toml::Table>(&value.data);
  if (!table) {
    const toml::Array* array = std::get_if<toml::Array>(&value.data);
    if (array && !array->empty() && std::holds_alternative<toml::Table>(array->front().data))
      reading_.source.fail(value.where, address + " is not a list",
                           address.find('.') == std::string::npos
                               ? "write [" + address + "], with one pair of brackets"
                               : "write it with one pair of brackets");
    const Valid any;
    const auto* text = std::get_if<std::string>(&value.data);
    const bool is_of_file = address.ends_with(".mesh") || address.ends_with(".points");
    const advice::Entry* example =
        advice::entry_of("value that must be a table", address.substr(address.rfind('.') + 1));
    Leaf{reading_.source, value, address, "", any}.fail(
        "a table", text && is_of_file ? "write { file = " + toml::toml_string(*text) + " }"
                   : example          ? example->sentence
                                      : "");
  }
  return *table;
}

const toml::Array& Reader::list_of_tables(const toml::Entry& entry) const {
  const toml::Array* array = std::get_if<toml::Array>(&entry.value.data);
  if (!array) {
    reading_.source.fail(entry.where, toml::toml_string(entry.key) + " is a list",
                         "write [[" + entry.key + "]], with two brackets");
  }
  return *array;
}

const toml::Array& Reader::array_of_tables(const toml::Entry& entry) const {
  const toml::Array* array = std::get_if<toml::Array>(&entry.value.data);
  if (!array) {
    const Valid any;
    Leaf{reading_.source, entry.value, address_of(entry.key), "", any}.fail(
        "a list of tables", "write " + entry.key + " = [{ ... }, { ... }]");
  }
  return *array;
}

std::vector<std::string> Reader::unique_names(const toml::Entry& list) const {
  const toml::Array& items = std::get<toml::Array>(list.value.data);
  const std::vector<std::string> names = item_names(list.value);
  std::map<std::string, std::size_t> first;
  for (std::size_t k = 0; k < names.size(); ++k) {
    const auto [found, is_new] = first.emplace(names[k], k);
    if (is_new) continue;
    // Blame a name that was written; an unnamed item cannot help its number.
    const auto written = [&](std::size_t item) {
      const toml::Table* table = std::get_if<toml::Table>(&items[item].data);
      return table ? table->find("name") : nullptr;
    };
    const toml::Entry* name = written(k) ? written(k) : written(found->second);
    reading_.source.fail(name ? name->value.where : items[k].where,
                         "duplicate " + list.key + " name " + toml::toml_string(names[k]),
                         written(k) && written(found->second)
                             ? "names must be unique"
                             : "the unnamed one has its number for a name");
  }
  return names;
}

/// A user who knows [[body]] tries [[material]] first.
void Reader::require_no_list(const toml::Entry& entry) const {
  if (!std::holds_alternative<toml::Array>(entry.value.data)) return;
  const std::string address = address_of(entry.key);
  reading_.source.fail(
      entry.where, address + " is not a list",
      "each has a table of its name, with one pair of brackets: [" + address + ".NAME]");
}

void Reader::require_name(const toml::Entry& item, const std::string& list) const {
  if (!std::holds_alternative<toml::Table>(item.value.data)) {
    reading_.source.fail(item.where,
                         "unknown key " + toml::toml_string(item.key) + " in [" + list + "]",
                         "each " + list + " has a name: [" + list + ".NAME]");
  }
  if (is_identifier(item.key)) return;
  reading_.source.fail(item.where, "bad " + list + " name " + toml::toml_string(item.key),
                       "expected 1 to 64 letters, digits, _ and -");
}

void Reader::require_one_form(const toml::Entry& shape,
                              const std::vector<std::string>& forms) const {
  const std::string address = address_of(shape.key);
  const toml::Table& table = table_of(shape.value, address);
  for (const toml::Entry& form : table.entries) {
    if (contains(forms, form.key)) continue;
    const std::string& first = table.entries.front().key;
    if (contains(forms, first))
      reading_.source.fail(form.where,
                           toml::toml_string(form.key) + " is outside the shape in " + address,
                           "write it inside the braces of the shape: { " + first + " = { ..., " +
                               form.key + " = ... } }");
    reading_.source.fail(form.where,
                         "unsupported shape " + toml::toml_string(form.key) + " in " + address,
                         form_advice(form.key, forms));
  }
  if (table.entries.size() == 1) return;
  if (table.entries.empty()) {
    reading_.source.fail(shape.value.where, address + " is empty", "expected " + list_of(forms));
  }
  reading_.source.fail(table.entries[1].where,
                       address + " has two forms, " + list_of({table.entries[0].key}) + " and " +
                           list_of({table.entries[1].key}),
                       "expected exactly one");
}

void Reader::refuse_unknown(const std::vector<std::string>& known) const {
  for (const toml::Entry& entry : table_.entries) {
    if (contains(known, entry.key)) continue;
    reading_.source.fail(entry.where,
                         "unknown key " + toml::toml_literal({entry.key}, toml::max_shown) +
                             (address_.empty() ? "" : " in [" + address_ + "]"),
                         advice(entry.key, known));
  }
}

std::string Reader::example_of(const sim::Vec3d& member) {
  return toml::toml_literal(to_value(member));
}

void Reader::fail_without(const char* key, const char* unit, const char* help,
                          const std::string& example) const {
  std::string wanted = help;
  if (wanted.ends_with('.')) wanted.pop_back();
  if (unit[0] != '\0') wanted += std::string(", in ") + unit;
  std::string hint = "expected " + std::string(key) + " (" + wanted + ")";
  if (!example.empty()) hint += ", for example " + std::string(key) + " = " + example;
  reading_.source.fail(reading_.place_of(address_), address_ + " has no " + key, hint);
}

void Reader::fail_without_shape(const char* key) const {
  reading_.source.fail(reading_.place_of(address_), address_ + " has no " + key,
                       "for example shape = { sphere = { center = [0, 0.5, 0], radius = 0.1 } }");
}

}  // namespace neve::app::scene

#include "app/scene/reader.h"

#include <algorithm>

#include "app/scene/params.h"
#include "app/text.h"

namespace neve::app {
namespace {

/// What to write instead of a key that is not one here.
std::string advice(const std::string& key, const std::vector<std::string>& known) {
  const std::string nearest = nearest_name(key, known);
  if (!nearest.empty()) return "did you mean " + toml_string(nearest) + "?";
  // A key of another table was put into this one; single letters say too little to guess.
  for (const ParamInfo& info : params()) {
    if (key.size() > 1 && info.address.ends_with("." + key))
      return "did you mean " + info.address + "?";
  }
  return "expected " + list_of(known);
}

}  // namespace

Location Reading::place_of(std::string address) const {
  while (!address.empty()) {
    const auto found = places.find(address);
    if (found != places.end()) return found->second;
    const auto dot = address.rfind('.');
    address.resize(dot == std::string::npos ? 0 : dot);
  }
  return {1, 1};
}

const Entry* Reader::given(const char* key) {
  const Entry* entry = table_.find(key);
  if (entry) reading_.places[address_of(key)] = entry->value.where;
  return entry;
}

const Table& Reader::table_of(const Value& value, const std::string& address) const {
  const Table* table = std::get_if<Table>(&value.data);
  if (!table) {
    const Valid any;
    Leaf{reading_.source, value, address, "", any}.fail("a table");
  }
  return *table;
}

const Array& Reader::list_of_tables(const Entry& entry) const {
  const Array* array = std::get_if<Array>(&entry.value.data);
  if (!array) {
    reading_.source.fail(entry.where, toml_string(entry.key) + " is a list",
                         "write [[" + entry.key + "]], with two brackets");
  }
  return *array;
}

const Array& Reader::array_of_tables(const Entry& entry) const {
  const Array* array = std::get_if<Array>(&entry.value.data);
  if (!array) {
    const Valid any;
    Leaf{reading_.source, entry.value, address_of(entry.key), "", any}.fail(
        "a list of tables", "write " + entry.key + " = [{ ... }, { ... }]");
  }
  return *array;
}

std::vector<std::string> Reader::unique_names(const Entry& list) const {
  const Array& items = std::get<Array>(list.value.data);
  const std::vector<std::string> names = item_names(list.value);
  std::map<std::string, std::size_t> first;
  for (std::size_t k = 0; k < names.size(); ++k) {
    const auto [found, is_new] = first.emplace(names[k], k);
    if (is_new) continue;
    // Blame a name that was written; an unnamed item cannot help its number.
    const auto written = [&](std::size_t item) {
      const Table* table = std::get_if<Table>(&items[item].data);
      return table ? table->find("name") : nullptr;
    };
    const Entry* name = written(k) ? written(k) : written(found->second);
    reading_.source.fail(name ? name->value.where : items[k].where,
                         "duplicate " + list.key + " name " + toml_string(names[k]),
                         written(k) && written(found->second)
                             ? "names are unique among them"
                             : "the unnamed one there is called by its number");
  }
  return names;
}

/// [[material]] is what who knows [[body]] tries first.
void Reader::require_no_list(const Entry& entry) const {
  if (!std::holds_alternative<Array>(entry.value.data)) return;
  const std::string address = address_of(entry.key);
  reading_.source.fail(
      entry.where, address + " is no list",
      "each has a table of its name, with one pair of brackets: [" + address + ".NAME]");
}

void Reader::require_name(const Entry& item, const std::string& list) const {
  if (!std::holds_alternative<Table>(item.value.data)) {
    reading_.source.fail(item.where, "unknown key " + toml_string(item.key) + " in [" + list + "]",
                         "each " + list + " has a name: [" + list + ".NAME]");
  }
  if (is_identifier(item.key)) return;
  reading_.source.fail(item.where, "bad " + list + " name " + toml_string(item.key),
                       "expected 1 to 64 letters, digits, _ and -");
}

void Reader::require_one_form(const Entry& shape, const std::vector<std::string>& forms) const {
  const std::string address = address_of(shape.key);
  const Table& table = table_of(shape.value, address);
  for (const Entry& form : table.entries) {
    bool is_known = false;
    for (const std::string& name : forms) is_known = is_known || name == form.key;
    if (!is_known) {
      const std::string& first = table.entries.front().key;
      if (std::find(forms.begin(), forms.end(), first) != forms.end())
        reading_.source.fail(form.where,
                             toml_string(form.key) + " is beside the shape in " + address,
                             "write it into the braces of the shape: { " + first + " = { ..., " +
                                 form.key + " = ... } }");
      const std::string nearest = nearest_name(form.key, forms);
      reading_.source.fail(form.where,
                           "unsupported shape " + toml_string(form.key) + " in " + address,
                           nearest.empty() ? "expected " + list_of(forms)
                                           : "did you mean " + toml_string(nearest) + "?");
    }
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
  for (const Entry& entry : table_.entries) {
    bool is_known = false;
    for (const std::string& key : known) is_known = is_known || key == entry.key;
    if (is_known) continue;
    reading_.source.fail(entry.where,
                         "unknown key " + toml_literal({entry.key}, max_shown) +
                             (address_.empty() ? "" : " in [" + address_ + "]"),
                         advice(entry.key, known));
  }
}

void Reader::fail_without_shape(const char* key) const {
  reading_.source.fail(reading_.place_of(address_), address_ + " has no " + key,
                       "for example shape = { sphere = { center = [0, 0.5, 0], radius = 0.1 } }");
}

}  // namespace neve::app

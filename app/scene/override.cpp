#include "app/scene/override.h"

#include <algorithm>
#include <optional>

#include "app/advice/suggest.h"
#include "app/scene/leaf.h"
#include "app/scene/names.h"
#include "app/scene/params.h"
#include "app/scene/presets.h"
#include "app/scene/toml/error.h"
#include "app/scene/toml/toml_source.h"
#include "app/scene/toml/toml_text.h"
#include "app/support/errors.h"
#include "app/support/text.h"

namespace neve::app::scene {
namespace {

using Path = std::vector<std::string>;

/// The parameter with NAME replaced by each name there is.
std::vector<std::string> addresses_of(const ParamInfo& info, const toml::Table& root) {
  const std::string placeholder = ".NAME.";
  const auto at = info.address.find(placeholder);
  if (at == std::string::npos) return {info.address};
  const toml::Entry* items = root.find(info.address.substr(0, at));
  std::vector<std::string> addresses;
  if (!items) return addresses;
  for (const std::string& name : item_names(items->value)) {
    addresses.push_back(info.address.substr(0, at + 1) + name +
                        info.address.substr(at + placeholder.size() - 1));
  }
  return addresses;
}

void add_addresses(const toml::Table& table, const std::string& before, Path& addresses) {
  for (const toml::Entry& entry : table.entries) {
    addresses.push_back(before + entry.key);
    if (const auto* members = std::get_if<toml::Table>(&entry.value.data))
      add_addresses(*members, before + entry.key + ".", addresses);
  }
}

/// body.bull.velocity: the kind exists, the name does not.
void refuse_unknown_name(const Override& change, const toml::Table& root) {
  const Path path = words_of(change.address);
  if (path.size() < 2) return;
  for (const ParamInfo& info : params()) {
    if (!info.address.starts_with(path[0] + ".NAME.")) continue;
    const toml::Entry* items = root.find(path[0]);
    const Path known = items ? item_names(items->value) : Path{};
    if (std::find(known.begin(), known.end(), path[1]) != known.end()) return;
    const std::string rest = change.address.substr(path[0].size() + 1);
    if (param_at(path[0] + ".NAME." + rest))
      change.fail(change.key, change.address + " does not say which " + path[0],
                  "write " + path[0] + ".NAME." + rest +
                      (known.empty() ? "; the scene has none" : ", NAME being " + list_of(known)));
    change.fail(change.key, "there is no " + path[0] + " " + toml::toml_string(path[1]),
                name_advice(path[1], known));
  }
}

/// Addresses of one name: "material.snow.hardening" and others of "hardening".
Path addresses_with(const std::string& name, const Path& known) {
  Path found;
  for (const std::string& address : known)
    if (address.ends_with("." + name)) found.push_back(address);
  return found;
}

std::string last_word(const std::string& address) {
  return address.substr(address.rfind('.') + 1);
}

/// The address whose last word is meant: "material.snow.theta_c", or "theta_c" alone, is
/// material.snow.critical_compression. "": none.
std::string our_address(const std::string& address, const Path& known) {
  const std::string word = last_word(address);
  const std::string table = address.substr(0, address.size() - word.size());
  advice::Context in_table{"key", {}}, anywhere{"key", {}};
  for (const std::string& one : known) {
    if (one == table + last_word(one)) in_table.known.push_back(last_word(one));
    anywhere.known.push_back(last_word(one));
  }
  if (const std::string ours = advice::our_name(word, in_table); !ours.empty()) return table + ours;
  const std::string ours = table.empty() ? advice::our_name(word, anywhere) : "";
  const auto found = std::find(anywhere.known.begin(), anywhere.known.end(), ours);
  return found == anywhere.known.end()
             ? ""
             : known[static_cast<std::size_t>(found - anywhere.known.begin())];
}

/// "hardning": the address of hardening, in its own table before others.
std::string address_of_nearest_name(const std::string& wrong, const Path& known) {
  const std::string word = last_word(wrong);
  const std::string table = wrong.substr(0, wrong.size() - word.size());
  Path near, all;
  for (const std::string& address : known) {
    all.push_back(last_word(address));
    if (address == table + all.back()) near.push_back(all.back());
  }
  if (const std::string name = advice::nearest_name(word, near); !name.empty()) return table + name;
  const Path same = addresses_with(advice::nearest_name(word, all), known);
  const std::string nearest = advice::nearest_name(wrong, same);
  return nearest.empty() && !same.empty() ? same.front() : nearest;
}

/// "material.snow" holds others: "it is a table: ..."; "" of what is none.
std::string advice_on_table(const Override& change, const Path& known) {
  const std::string below = change.address + ".";
  const auto inside = std::find_if(known.begin(), known.end(), [&](const std::string& address) {
    return address.starts_with(below);
  });
  if (inside == known.end()) return {};
  const std::string preset = below + "preset";
  const bool is_preset = is_preset_address(preset) && value_named<Preset>(change.value);
  return "it is a table: set one of its parameters, as in " +
         (is_preset ? preset + "=" + change.value : *inside + "=...");
}

[[noreturn]] void fail_unknown(const Override& change, const Path& known) {
  if (const std::string table = advice_on_table(change, known); !table.empty())
    change.fail(change.key, change.address + " is not a parameter", table);
  // "hardening" alone: say where it is. "solver.hardening", "outptu.size", "solver.hardness": the
  // word is right, its table is another.
  const std::string word = last_word(change.address);
  const Path alone = addresses_with(change.address, known), same = addresses_with(word, known);
  std::string nearest = alone.empty() ? our_address(change.address, known) : alone.front();
  if (nearest.empty()) nearest = advice::nearest_name(change.address, same);
  if (nearest.empty() && !same.empty()) nearest = same.front();
  if (nearest.empty()) nearest = our_address(word, known);
  if (nearest.empty()) nearest = address_of_nearest_name(change.address, known);
  if (nearest.empty()) nearest = advice::nearest_name(change.address, known);
  std::string hint = nearest.empty() ? "" : advice::did_you_mean(nearest, true);
  if (hint.empty()) hint = advice::suggest(word, {"key", {}}, "neve params lists all of them");
  change.fail(change.key, "unknown parameter " + toml::toml_string(change.address), hint);
}

/// Entries without names are set together: "camera.keyframes" for "camera.keyframes[N].time".
std::string settable_part(const std::string& address) {
  return address.substr(0, address.find('['));
}

bool is_object_list(const std::string& word) {
  return word == "body" || word == "emitter" || word == "sink" || word == "collider";
}

/// Returns the name of an item of a list, or its number. @param k  its place, from 0
std::string name_of_item(const toml::Value& item, std::size_t k) {
  const toml::Table* members = std::get_if<toml::Table>(&item.data);
  const toml::Entry* name = members ? members->find("name") : nullptr;
  const std::string* text = name ? std::get_if<std::string>(&name->value.data) : nullptr;
  return text && is_identifier(*text) ? *text : std::to_string(k + 1);
}

std::size_t item_count(const toml::Value& items) {
  if (const toml::Table* table = std::get_if<toml::Table>(&items.data))
    return table->entries.size();
  const toml::Array* array = std::get_if<toml::Array>(&items.data);
  return array ? array->size() : 0;
}

/// Explains body.velocity, where somebody forgot the name of the body.
bool is_member_of_all(const std::string& list, const std::string& word) {
  const std::string member = list + ".NAME." + word;
  const std::vector<ParamInfo>& all = params();
  return std::any_of(all.begin(), all.end(), [&](const ParamInfo& info) {
    return info.address == member || info.address.starts_with(member + ".");
  });
}

/// Returns the address with NAME in the place of the name of an item that the document has; empty
/// if it has none of the name.
std::string pattern_with_name(const std::string& address, const toml::Table& root) {
  const Path path = words_of(address);
  const toml::Entry* items = path.size() > 2 ? root.find(path[0]) : nullptr;
  if (!items || item_place(items->value, path[1]) == item_count(items->value)) return {};
  return path[0] + ".NAME" + address.substr(path[0].size() + 1 + path[1].size());
}

struct Target {
  std::string type;  ///< of the parameter; "table" for tables
  bool is_in_item;   ///< of a list, whose name is the second word
};

/// True for the address of a table inside an item or at the top: "camera", "body.ball.shape", but
/// not "body" or "body.ball", whose names must stay.
bool is_table_around(const std::string& pattern, const std::string& known) {
  return known.size() > pattern.size() && known.starts_with(pattern) &&
         (known[pattern.size()] == '.' || known[pattern.size()] == '[');
}

std::optional<Target> target_of(const std::string& address, const toml::Table& root) {
  const std::string in_item = pattern_with_name(address, root);
  std::optional<Target> table;
  for (const ParamInfo& info : params()) {
    const bool is_in_item = info.address.find(".NAME.") != std::string::npos;
    const auto matches = [&](const std::string& pattern) {
      if (is_table_around(pattern, info.address)) table = {"table", is_in_item};
      return info.address == pattern && info.address.find('[') == std::string::npos;
    };
    if (matches(is_in_item ? in_item : address)) return Target{info.type, is_in_item};
  }
  return table;
}

Target resolve(const Override& change, const toml::Table& root) {
  if (const std::optional<Target> target = target_of(change.address, root)) return *target;
  refuse_unknown_name(change, root);
  std::vector<std::string> known;
  for (const ParamInfo& info : params())
    for (const std::string& address : addresses_of(info, root))
      known.push_back(settable_part(address));
  fail_unknown(change, known);
}

void set_place(toml::Value& value, int index) {
  value.where = {0, 0, index};
  if (toml::Array* array = std::get_if<toml::Array>(&value.data)) {
    for (toml::Value& item : *array) set_place(item, index);
  } else if (toml::Table* table = std::get_if<toml::Table>(&value.data)) {
    for (toml::Entry& entry : table->entries) {
      entry.where = {0, 0, index};
      set_place(entry.value, index);
    }
  }
}

/// The table called `name` in a list or a table of tables.
toml::Table* item_called(toml::Value& items, const std::string& name) {
  const std::size_t k = item_place(items, name);
  toml::Array* array = std::get_if<toml::Array>(&items.data);
  toml::Table* table = std::get_if<toml::Table>(&items.data);
  if (array && k < array->size()) return std::get_if<toml::Table>(&(*array)[k].data);
  if (!table || k >= table->entries.size()) return nullptr;
  return std::get_if<toml::Table>(&table->entries[k].value.data);
}

toml::Entry& entry_called(toml::Table& table, const std::string& key, int index) {
  if (toml::Entry* entry = table.find(key)) return *entry;
  return table.entries.emplace_back(
      toml::Entry{key, {0, 0, index}, {toml::Table{}, {0, 0, index}}});
}

}  // namespace

bool is_object_address(const std::string& address) {
  const Path words = words_of(address);
  return words.size() == 2 && is_object_list(words[0]) && !words[1].empty();
}

std::string object_of(const std::string& address) {
  const std::string object = address.substr(0, address.find('.', address.find('.') + 1));
  return is_object_address(object) ? object : "";
}

toml::Value value_of(const Override& change, const std::string& type) {
  const std::string text = trimmed(change.value);
  if (!toml::is_clean_text(text) || text.find_first_of("\r\n") != std::string::npos) {
    change.fail(change.place, "a value is one line of UTF-8 without control bytes");
  }
  toml::Value value{text};
  try {
    value = toml::parse_toml("value = " + text, "").entries.at(0).value;
  } catch (const toml::SceneError& error) {
    // Words need no quotes; text that starts like other TOML is read as such.
    if (!text.empty() && std::string_view("[{\"'").find(text[0]) != std::string_view::npos) {
      change.fail(change.place, error.message, error.hint);
    }
  }
  // A title may be a number, and so may a name.
  const bool wants_text = type == "string" || type == "choice";
  if (wants_text && !std::holds_alternative<std::string>(value.data)) value.data = text;
  return value;
}

std::vector<std::string> words_of(const std::string& address) {
  std::vector<std::string> words;
  std::size_t from = 0;
  for (std::size_t dot; (dot = address.find('.', from)) != std::string::npos; from = dot + 1) {
    words.push_back(address.substr(from, dot - from));
  }
  words.push_back(address.substr(from));
  return words;
}

bool takes_away(const Override& change) {
  const std::string text = trimmed(change.value);
  if (text != "none" && text != "\"none\"") return false;
  const std::optional<ParamInfo> info = param_at(change.address);
  if (!info || !info->default_value) return true;
  // Only none without quotes takes away a text: an empty text is its default.
  const auto* words = std::get_if<std::string>(&info->default_value->data);
  return words && words->empty() && text == "none";
}

bool takes_item_away(const Override& change) {
  const Path words = words_of(change.address);
  if (words.size() != 2 || !takes_away(change) || is_member_of_all(words[0], words[1]))
    return false;
  return is_object_list(words[0]) || words[0] == "curve" || words[0] == "export" ||
         words[0] == "view" || words[0] == "mosaic";
}

void Override::fail(toml::Location where, const std::string& message,
                    const std::string& hint) const {
  if (!file.empty()) throw toml::SceneError(file, where.line, where.column, message, hint);
  throw UsageError(flag + " " + address + "=" + value, message, hint);
}

Override parse_override(std::string_view text) {
  const auto equals = text.find('=');
  if (equals == std::string_view::npos || trimmed(text.substr(0, equals)).empty()) {
    throw UsageError("--set " + std::string(text), "expected ADDRESS=VALUE",
                     "for example --set material.snow.hardening=5");
  }
  return {trimmed(text.substr(0, equals)), trimmed(text.substr(equals + 1))};
}

std::vector<Override> parse_overrides(const std::vector<std::string>& arguments) {
  std::vector<Override> changes;
  for (const std::string& argument : arguments) changes.push_back(parse_override(argument));
  return changes;
}

std::vector<std::string> addresses_of(const std::vector<Override>& changes) {
  std::vector<std::string> addresses;
  for (const Override& change : changes) {
    addresses.push_back(change.address);
    if (!change.value.starts_with("{")) continue;
    const toml::Value value = value_of(change, "table");
    if (const auto* table = std::get_if<toml::Table>(&value.data))
      add_addresses(*table, change.address + ".", addresses);
  }
  return addresses;
}

bool sets(const std::vector<Override>& changes, std::string_view address) {
  return std::ranges::find(changes, address, &Override::address) != changes.end();
}

std::vector<std::string> texts_of(const std::vector<Override>& changes) {
  std::vector<std::string> texts;
  for (const Override& change : changes) texts.push_back(change.address + "=" + change.value);
  return texts;
}

std::vector<std::string> item_names(const toml::Value& items) {
  std::vector<std::string> names;
  if (const toml::Table* table = std::get_if<toml::Table>(&items.data)) {
    for (const toml::Entry& entry : table->entries) names.push_back(entry.key);
  } else if (const toml::Array* array = std::get_if<toml::Array>(&items.data)) {
    for (const toml::Value& item : *array) {
      names.push_back(name_of_item(item, names.size()));
    }
  }
  return names;
}

std::size_t item_place(const toml::Value& items, const std::string& name) {
  if (const toml::Table* table = std::get_if<toml::Table>(&items.data)) {
    const auto found = std::ranges::find(table->entries, name, &toml::Entry::key);
    return static_cast<std::size_t>(found - table->entries.begin());
  }
  const toml::Array* array = std::get_if<toml::Array>(&items.data);
  if (!array) return 0;
  std::size_t k = 0;
  while (k < array->size() && name_of_item((*array)[k], k) != name) ++k;
  return k;
}

const toml::Value* value_at(const toml::Table& root, const std::string& address) {
  const toml::Table* table = &root;
  const toml::Value* value = nullptr;
  for (const std::string& word : words_of(address)) {
    // Names of [[body]] and the like are no keys but members of the entries.
    const toml::Array* list = value ? std::get_if<toml::Array>(&value->data) : nullptr;
    if (list) {
      const std::size_t k = item_place(*value, word);
      value = k < list->size() ? &(*list)[k] : nullptr;
    } else {
      const toml::Entry* entry = table ? table->find(word) : nullptr;
      value = entry ? &entry->value : nullptr;
    }
    if (!value) return nullptr;
    table = std::get_if<toml::Table>(&value->data);
  }
  return value;
}

namespace {

/// Removes the value that the document has there, if any.
void remove(toml::Table& root, const std::string& address, bool is_in_item) {
  const Path path = words_of(address);
  toml::Table* table = &root;
  std::size_t depth = 0;
  if (is_in_item) {
    table = item_called(root.find(path[0])->value, path[1]);
    depth = 2;
  }
  for (; table && depth + 1 < path.size(); ++depth) {
    toml::Entry* entry = table->find(path[depth]);
    table = entry ? std::get_if<toml::Table>(&entry->value.data) : nullptr;
  }
  if (table)
    std::erase_if(table->entries,
                  [&](const toml::Entry& entry) { return entry.key == path.back(); });
}

/// Unnamed items have their number for a name: those behind the removed one keep it.
void remove_item(toml::Table& root, const std::string& list, std::size_t index) {
  toml::Entry* entry = root.find(list);
  toml::Array& items = std::get<toml::Array>(entry->value.data);
  const Path names = item_names(entry->value);
  for (std::size_t k = index + 1; k < items.size(); ++k)
    if (auto* table = std::get_if<toml::Table>(&items[k].data); table && !table->find("name"))
      table->entries.push_back({"name", {}, {names[k]}});
  items.erase(items.begin() + static_cast<std::ptrdiff_t>(index));
  if (items.empty())
    std::erase_if(root.entries, [&](const toml::Entry& other) { return other.key == list; });
}

/// The table of a new object, with the name in its address.
toml::Value object_in(const Override& change, const std::string& list, const std::string& name) {
  toml::Value value = value_of(change, "table");
  auto* table = std::get_if<toml::Table>(&value.data);
  if (!table)
    change.fail(change.place, change.address + " is a whole " + list + ": expected a table or none",
                "for example " + change.address +
                    "={ shape = { sphere = { center = [0, 0.5, 0], radius = 0.1 } } }");
  if (!is_identifier(name))
    change.fail(change.key, "bad " + list + " name " + toml::toml_string(name),
                "expected 1 to 64 letters, digits, _ and -");
  const toml::Entry* own = table->find("name");
  if (own && !own->value.is_text(name))
    change.fail(change.place, "its name is not " + toml::toml_string(name),
                "omit the name: it is in the address");
  if (!own) table->entries.insert(table->entries.begin(), {"name", {}, {name}});
  return value;
}

/// @throws UsageError or SceneError where there is none of the name
void remove_item_called(toml::Table& root, const Override& change, const std::string& list,
                        const std::string& name) {
  const toml::Entry* entry = root.find(list);
  if (entry && !std::holds_alternative<toml::Array>(entry->value.data)) return;  // told later
  const Path names = entry ? item_names(entry->value) : Path{};
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end())
    change.fail(change.key, "there is no " + list + " " + toml::toml_string(name),
                name_advice(name, names));
  remove_item(root, list, static_cast<std::size_t>(found - names.begin()));
}

/// @return false where the address is none of an object, which the caller reports
bool apply_object(toml::Table& root, const Override& change, int index) {
  const Path path = words_of(change.address);
  const std::string &list = path[0], &name = path[1];
  toml::Entry* entry = root.find(list);
  if (entry && !std::holds_alternative<toml::Array>(entry->value.data)) return true;  // told later
  const std::size_t found = entry ? item_place(entry->value, name) : 0;
  const bool is_there = entry && found < std::get<toml::Array>(entry->value.data).size();
  if (!is_there && is_member_of_all(list, name)) return false;
  if (takes_away(change)) {
    remove_item_called(root, change, list, name);
    return true;
  }
  toml::Value object = object_in(change, list, name);
  set_place(object, index);
  if (!entry) entry = &root.entries.emplace_back(toml::Entry{list, {}, {toml::Array{}}});
  auto& items = std::get<toml::Array>(entry->value.data);
  if (is_there)
    items[found] = std::move(object);  // ids and seeds are those of the place
  else
    items.push_back(std::move(object));
  return true;
}

}  // namespace

void apply_override(toml::Table& root, const Override& change, int index) {
  if (is_object_address(change.address) && apply_object(root, change, index)) return;
  if (const Path path = words_of(change.address); takes_item_away(change))
    return remove_item_called(root, change, path[0], path[1]);
  const Target target = resolve(change, root);
  if (takes_away(change)) return remove(root, change.address, target.is_in_item);
  // An override precedes the file, so a preset set here replaces the numbers of the file.
  if (is_preset_address(change.address))
    for (const std::string& number : addresses_set_by(change.address))
      remove(root, number, target.is_in_item);
  toml::Value value = value_of(change, target.type);
  set_place(value, index);

  Path path = words_of(change.address);
  const std::string last = path.back();
  path.pop_back();
  toml::Table* table = &root;
  std::size_t depth = 0;
  if (target.is_in_item) {
    table = item_called(root.find(path[0])->value, path[1]);
    depth = 2;
  }
  for (; table && depth < path.size(); ++depth) {
    table = std::get_if<toml::Table>(&entry_called(*table, path[depth], index).value.data);
  }
  if (!table) return;  // the file has something else here, which reading it will tell
  toml::Entry& entry = entry_called(*table, last, index);
  entry.where = {0, 0, index};
  entry.value = std::move(value);
}

}  // namespace neve::app::scene

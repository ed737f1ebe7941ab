#include "app/scene/flat.h"

#include <algorithm>
#include <functional>
#include <iterator>
#include <map>
#include <set>

#include "app/scene/describe.h"
#include "app/scene/leaf.h"
#include "app/scene/lister.h"
#include "app/scene/writer.h"

namespace neve::app::scene {

namespace {

constexpr const char* table_type = "table";
constexpr const char* tables_type = "tables";

/// The visitor of describe.h that collects parameters with their addresses and values.
class Flattener {
 public:
  explicit Flattener(std::vector<FlatParam>& list, std::string prefix = {})
      : list_(list), prefix_(std::move(prefix)) {}

  template <class T>
  void operator()(const char* key, T& member, const char* unit, const Valid& valid, Change change,
                  const char* help) {
    list_.push_back({prefix_ + key, type_of(member), unit, valid, choices_of(member),
                     change == Change::live, help, value_if_any(member), std::nullopt});
  }

  template <class Describe>
  void section(const char* key, const char*, Describe describe_members) {
    Flattener inner = inside(key);
    describe_members(inner);
  }

  template <class T>
  void optional(const char* key, std::optional<T>& member, const char* help) {
    std::optional<toml::Value> value;
    if (member) value = written(*member);
    add_table(key, table_type, std::move(value), is_live(prefix_ + key), help);
    if (!member) return;
    Flattener inner = inside(key);
    describe(inner, *member);
  }

  template <class T>
  void named(const char* key, std::vector<T>& items, const char*) {
    for (T& item : items) {
      Flattener inner = inside(std::string(key) + "." + item.name);
      describe(inner, item);
    }
  }

  template <class T>
  void list(const char* key, std::vector<T>& items, const char* help) {
    named(key, items, help);
  }

  template <class T>
  void sequence(const char* key, std::vector<T>& items, const char* help) {
    toml::Array array;
    for (T& item : items) array.push_back(written(item));
    std::optional<toml::Value> value;
    if (!array.empty()) value = toml::Value{std::move(array)};
    add_table(key, tables_type, std::move(value), true, help);
  }

  template <class Describe>
  void shape(const char* key, sim::shapes::Shape& shape, const char* help,
             Describe describe_forms) {
    Writer writer;
    describe_forms(writer, shape);
    add_table(key, table_type, toml::Value{std::move(writer.table)}, is_live(prefix_ + key), help);
    Flattener inner = inside(key);
    describe_forms(inner, shape);
  }

  template <class Form>
  void form(const char* key, sim::shapes::Shape& shape, Change change, const char*) {
    Form* form = std::get_if<Form>(&shape.form);
    if (!form) return;
    Flattener inner = inside(key);
    describe(inner, *form, change);
    describe_rotation(inner, shape, change);
  }

  /// The numbers say it.
  template <Choice E, class Use>
  void shorthand(const char*, const std::optional<E>&, Use, const char*) {}

 private:
  Flattener inside(const std::string& key) { return Flattener(list_, prefix_ + key + "."); }

  template <class T>
  static toml::Value written(T& item) {
    Writer writer;
    describe(writer, item);
    return {std::move(writer.table)};
  }

  void add_table(const char* key, const char* type, std::optional<toml::Value> value, bool live,
                 const char* help) {
    list_.push_back({prefix_ + key,
                     type,
                     unit::none,
                     anything,
                     {},
                     live,
                     help,
                     std::move(value),
                     std::nullopt});
  }

  std::vector<FlatParam>& list_;
  std::string prefix_;
};

/// "material.NAME.hardening" for "material.snow.hardening".
std::string pattern_of(std::string_view address) {
  static const std::set<std::string, std::less<>> named{
      "material", "body", "emitter", "sink", "collider", "view", "mosaic", "export", "curve"};
  const auto first = address.find('.');
  if (first == std::string_view::npos || !named.contains(address.substr(0, first)))
    return std::string(address);
  const auto second = std::min(address.find('.', first + 1), address.size());
  return std::string(address.substr(0, first)) + ".NAME" + std::string(address.substr(second));
}

/// All parameters by pattern, computed once.
const std::map<std::string, ParamInfo, std::less<>>& known() {
  static const auto all = [] {
    std::map<std::string, ParamInfo, std::less<>> map;
    for (const ParamInfo& info : params()) map.emplace(info.address, info);
    return map;
  }();
  return all;
}

std::vector<std::string> item_names_of(const Scene& scene, const std::string& list) {
  std::vector<std::string> names;
  const auto take = [&](const auto& items) {
    for (const auto& item : items) names.push_back(item.name);
  };
  if (list == "material") take(scene.materials);
  if (list == "body") take(scene.bodies);
  if (list == "emitter") take(scene.emitters);
  if (list == "sink") take(scene.sinks);
  if (list == "collider") take(scene.colliders);
  if (list == "curve") take(scene.curves);
  if (list == "view") take(scene.views);
  if (list == "mosaic") take(scene.mosaics);
  if (list == "export") take(scene.exports);
  return names;
}

toml::Value written(Collider collider) {
  Writer writer;
  describe(writer, collider);
  return {std::move(writer.table)};
}

const Collider* find_collider(const Scene& scene, const std::string& name) {
  const auto found = std::find_if(scene.colliders.begin(), scene.colliders.end(),
                                  [&](const Collider& collider) { return collider.name == name; });
  return found == scene.colliders.end() ? nullptr : &*found;
}

/// Colliders that only one of the scenes has: they may come and go while a simulation runs.
std::vector<Difference> come_and_gone(const Scene& before, const Scene& after) {
  std::vector<Difference> found;
  for (const Collider& gone : before.colliders)
    if (!find_collider(after, gone.name))
      found.push_back({"collider." + gone.name, written(gone), std::nullopt, true});
  for (const Collider& come : after.colliders)
    if (!find_collider(before, come.name))
      found.push_back({"collider." + come.name, std::nullopt, written(come), true});
  return found;
}

bool is_inside(const std::string& address, const std::string& table) {
  return address.size() > table.size() && address.starts_with(table) &&
         address[table.size()] == '.';
}

/// Form of a shape, the only key of its table; "" for other values.
std::string form_of(const std::optional<toml::Value>& value) {
  const toml::Table* table = value ? std::get_if<toml::Table>(&value->data) : nullptr;
  return table && table->entries.size() == 1 ? table->entries.front().key : "";
}

/// True if a table differs as a whole, so that its members need no comparison.
bool differs_as_a_whole(const FlatParam& before, const FlatParam& after) {
  if (before.value.has_value() != after.value.has_value()) return true;
  return before.address.ends_with(".shape") && form_of(before.value) != form_of(after.value);
}

}  // namespace

std::string FlatParam::text() const {
  return value ? toml::toml_literal(*value) : "none";
}

bool FlatParam::is_default() const {
  return same_value(value, default_value);
}

std::vector<FlatParam> flatten(const Scene& scene) {
  std::vector<FlatParam> list;
  Scene copy = scene;  // visitors take members they could change
  Flattener flattener(list);
  describe(flattener, copy);
  for (FlatParam& param : list) {
    const auto info = known().find(pattern_of(param.address));
    if (info != known().end()) param.default_value = info->second.default_value;
  }
  return list;
}

bool is_live(std::string_view address) {
  const std::string pattern = pattern_of(address);
  if (pattern == "collider.NAME") return true;
  bool is_known = false;
  for (auto at = known().lower_bound(pattern); at != known().end(); ++at) {
    const std::string& other = at->first;
    if (!other.starts_with(pattern)) break;
    const char next = other.size() == pattern.size() ? '.' : other[pattern.size()];
    if (next != '.' && next != '[') continue;  // another name that starts alike
    if (!at->second.is_live) return false;
    is_known = true;
  }
  return is_known;
}

Concern concern_of(std::string_view address) {
  if (address.starts_with("collider.") && address.ends_with(".style")) return Concern::pictures;
  // Whole tables concern what their members do.
  const std::string_view table = address.substr(0, address.find('.'));
  for (const char* part : {"solver", "dust", "material", "body", "emitter", "sink", "collider",
                           "curve", "fps", "seed"})
    if (table == part) return Concern::simulation;
  for (const char* part : {"frames", "handles", "limits", "export"})
    if (table == part) return Concern::run;
  return Concern::pictures;
}

bool same_value(const std::optional<toml::Value>& a, const std::optional<toml::Value>& b) {
  if (a.has_value() != b.has_value()) return false;
  return !a || toml::toml_literal(*a) == toml::toml_literal(*b);
}

std::vector<Difference> differences(const Scene& before, const Scene& after) {
  std::vector<Difference> found;
  for (const char* list :
       {"material", "body", "emitter", "sink", "collider", "curve", "view", "mosaic", "export"}) {
    const auto old_names = item_names_of(before, list), new_names = item_names_of(after, list);
    // The order counts too: unnamed items are numbered, and materials are known by their place.
    if (old_names == new_names) continue;
    if (list == std::string_view("collider")) {
      std::vector<Difference> others = come_and_gone(before, after);
      std::move(others.begin(), others.end(), std::back_inserter(found));
      if (!others.empty()) continue;
    }
    found.push_back({list, to_value(old_names), to_value(new_names), false});
  }
  std::map<std::string, FlatParam> old_params;
  for (FlatParam& param : flatten(before)) old_params.emplace(param.address, std::move(param));
  std::string whole;  // the table that was told as a whole
  for (FlatParam& param : flatten(after)) {
    if (!whole.empty() && is_inside(param.address, whole)) continue;
    const auto old = old_params.find(param.address);
    if (old == old_params.end()) continue;  // of an item that is new
    if (param.type == table_type) {
      if (!differs_as_a_whole(old->second, param)) continue;
      whole = param.address;
    } else if (same_value(old->second.value, param.value)) {
      continue;
    }
    found.push_back({param.address, old->second.value, param.value, param.is_live});
  }
  return found;
}

SplitDifferences split_live(const Scene& before, const Scene& after) {
  SplitDifferences split;
  for (Difference& difference : differences(before, after)) {
    auto& part = difference.is_live ? split.live : split.restart;
    part.push_back(std::move(difference));
  }
  return split;
}

bool spans_decades(const Valid& valid, const std::optional<double>& usual) {
  constexpr double wide_from = 1e3;    // between the bounds
  constexpr double decades_from = 30;  // times the usual value
  if (valid.min > 0 && valid.max >= wide_from * valid.min) return true;
  return usual && *usual > 0 && valid.min >= 0 && valid.max >= decades_from * *usual &&
         *usual >= decades_from * valid.min;
}

}  // namespace neve::app::scene

#pragma once
/// The visitor of describe.h that writes a TOML document.

#include <optional>
#include <utility>
#include <vector>

#include "app/scene/describe.h"
#include "app/scene/leaf.h"

namespace neve::app::scene {

class Writer {
 public:
  toml::Table table;

  template <class T>
  void operator()(const char* key, T& member, const char*, const Valid&, Change, const char*) {
    if (std::optional<toml::Value> value = value_if_any(member)) add(key, std::move(*value));
  }

  template <class Describe>
  void section(const char* key, const char*, Describe describe_members) {
    Writer inner;
    describe_members(inner);
    add(key, {std::move(inner.table)});
  }

  template <class T>
  void optional(const char* key, std::optional<T>& member, const char*) {
    if (member) add(key, written(*member));
  }

  template <class T>
  void named(const char* key, std::vector<T>& items, const char*) {
    toml::Table all;
    for (T& item : items) all.entries.push_back({item.name, {}, written(item)});
    add(key, {std::move(all)});
  }

  template <class T>
  void list(const char* key, std::vector<T>& items, const char*) {
    toml::Array all;
    for (T& item : items) all.push_back(written(item));
    add(key, {std::move(all)});
  }

  template <class T>
  void sequence(const char* key, std::vector<T>& items, const char*) {
    if (!items.empty()) list(key, items, "");
  }

  template <class Describe>
  void shape(const char* key, sim::shapes::Shape& shape, const char*, Describe describe_forms) {
    Writer inner;
    describe_forms(inner, shape);
    add(key, {std::move(inner.table)});
  }

  template <class Form>
  void form(const char* key, sim::shapes::Shape& shape, Change change, const char*) {
    Form* form = std::get_if<Form>(&shape.form);
    if (!form) return;
    Writer inner;
    describe(inner, *form, change);
    describe_rotation(inner, shape, change);
    add(key, {std::move(inner.table)});
  }

  /// Writes the parameters that a shorthand sets, which later versions read alike.
  template <Choice E, class Use>
  void shorthand(const char*, const std::optional<E>&, Use, const char*) {}

 private:
  template <class T>
  static toml::Value written(T& item) {
    Writer inner;
    describe(inner, item);
    return {std::move(inner.table)};
  }

  void add(const char* key, toml::Value value) {
    table.entries.push_back({key, {}, std::move(value)});
  }
};

}  // namespace neve::app::scene

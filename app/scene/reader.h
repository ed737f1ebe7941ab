#pragma once
/// The visitor of describe.h that fills a scene from a TOML document.

#include <map>
#include <string>
#include <vector>

#include "app/scene/describe.h"
#include "app/scene/leaf.h"

namespace neve::app::scene {

/// State that all readers of one document share.
struct Reading {
  Source source;
  std::map<std::string, toml::Location> places;  ///< where each address was given
  bool is_scene = true;                          ///< its keys may be sought in all of a scene
  bool is_sweep = false;                         ///< parameters of the scene belong in [set]

  /// Location of the address, or of the closest enclosing entry in the text.
  toml::Location place_of(std::string address) const;
};

/// The visitor that collects the keys of one table.
class Keys {
 public:
  std::vector<std::string> keys;

  template <class... Rest>
  void operator()(const char* key, Rest&&...) {
    keys.emplace_back(key);
  }
  template <class... Rest>
  void section(const char* key, Rest&&...) {
    keys.emplace_back(key);
  }
  template <class... Rest>
  void optional(const char* key, Rest&&...) {
    keys.emplace_back(key);
  }
  template <class... Rest>
  void named(const char* key, Rest&&...) {
    keys.emplace_back(key);
  }
  template <class... Rest>
  void list(const char* key, Rest&&...) {
    keys.emplace_back(key);
  }
  template <class... Rest>
  void sequence(const char* key, Rest&&...) {
    keys.emplace_back(key);
  }
  template <class... Rest>
  void addresses(const char* key, Rest&&...) {
    keys.emplace_back(key);
  }
  template <class... Rest>
  void address_lists(const char* key, Rest&&...) {
    keys.emplace_back(key);
  }
  template <class... Rest>
  void shape(const char* key, Rest&&...) {
    keys.emplace_back(key);
  }
  template <class Form, class... Rest>
  void form(const char* key, Rest&&...) {
    keys.emplace_back(key);
  }
  template <class... Rest>
  void shorthand(const char* key, Rest&&...) {
    keys.emplace_back(key);
  }
};

class Reader {
 public:
  /// @param address  of the table, "" for the document
  Reader(Reading& reading, const toml::Table& table, std::string address)
      : reading_(reading), table_(table), address_(std::move(address)) {}

  template <class T>
  void operator()(const char* key, T& member, const char* unit, const Valid& valid, Change,
                  const char* help) {
    if (const toml::Entry* entry = given(key)) {
      read_leaf(Leaf{reading_.source, entry->value, address_of(key), unit, valid}, member);
    } else if (valid.is_required) {
      fail_without(key, unit, help, example_of(member));
    }
  }

  template <class Describe>
  void section(const char* key, const char*, Describe describe_members) {
    if (const toml::Entry* entry = given(key))
      enter(entry->value, address_of(key), describe_members);
  }

  template <class T>
  void optional(const char* key, std::optional<T>& member, const char*) {
    const toml::Entry* entry = given(key);
    if (!entry) return;
    member = fresh<T>();
    enter(entry->value, address_of(key), [&](auto& v) { describe(v, *member); });
  }

  template <class T>
  void named(const char* key, std::vector<T>& items, const char*) {
    const toml::Entry* entry = given(key);
    if (!entry) return;
    require_no_list(*entry);
    for (const toml::Entry& item : table_of(entry->value, address_of(key)).entries) {
      const std::string address = address_of(key) + "." + item.key;
      require_name(item, address_of(key));
      T& member = items.emplace_back(fresh<T>());
      member.name = item.key;
      enter(item.value, address, [&](auto& v) { describe(v, member); });
    }
  }

  template <class T>
  void list(const char* key, std::vector<T>& items, const char*) {
    const toml::Entry* entry = given(key);
    if (!entry) return;
    const toml::Array& array = list_of_tables(*entry);
    const std::vector<std::string> names = unique_names(*entry);
    for (std::size_t k = 0; k < array.size(); ++k) {
      T& member = items.emplace_back(fresh<T>());
      enter(array[k], address_of(key) + "." + names[k], [&](auto& v) { describe(v, member); });
      member.name = names[k];
    }
  }

  template <class T>
  void sequence(const char* key, std::vector<T>& items, const char*) {
    const toml::Entry* entry = given(key);
    if (!entry) return;
    items.clear();
    const toml::Array& array = array_of_tables(*entry);
    for (std::size_t k = 0; k < array.size(); ++k) {
      T& member = items.emplace_back();
      enter(array[k], address_of(key) + "[" + std::to_string(k + 1) + "]",
            [&](auto& v) { describe(v, member); });
    }
  }

  void addresses(const char* key, toml::Table& member, const char*) {
    if (const toml::Entry* entry = given(key)) member = table_of(entry->value, address_of(key));
  }

  void address_lists(const char* key, std::vector<toml::Table>& members, const char*) {
    const toml::Entry* entry = given(key);
    if (!entry) return;
    for (const toml::Value& item : list_of_tables(*entry))
      members.push_back(table_of(item, address_of(key)));
  }

  template <class Describe>
  void shape(const char* key, sim::shapes::Shape& shape, const char*, Describe describe_forms) {
    const toml::Entry* entry = given(key);
    if (!entry) fail_without_shape(key);
    Keys forms;
    describe_forms(forms, shape);
    require_one_form(*entry, forms.keys);
    Reader inner(reading_, std::get<toml::Table>(entry->value.data), address_of(key));
    describe_forms(inner, shape);
  }

  template <class Form>
  void form(const char* key, sim::shapes::Shape& shape, Change change, const char*) {
    const toml::Entry* entry = given(key);
    if (!entry) return;
    Form& form = shape.form.emplace<Form>();
    enter(entry->value, address_of(key), [&](auto& v) {
      describe(v, form, change);
      describe_rotation(v, shape, change);
    });
  }

  template <Choice E, class Use>
  void shorthand(const char* key, const std::optional<E>&, Use use, const char*) {
    const toml::Entry* entry = given(key);
    if (!entry) return;
    E chosen{};
    read_leaf(Leaf{reading_.source, entry->value, address_of(key), unit::none, anything}, chosen);
    use(chosen);
  }

  /// Reads the members of this table after refusing unknown keys.
  template <class Describe>
  void read(Describe describe_members) {
    Keys known;
    describe_members(known);
    refuse_unknown(known.keys);
    describe_members(*this);
  }

 private:
  template <class Describe>
  void enter(const toml::Value& value, const std::string& address, Describe describe_members) {
    reading_.places[address] = value.where;
    Reader(reading_, table_of(value, address), address).read(describe_members);
  }

  std::string address_of(const std::string& key) const {
    return address_.empty() ? key : address_ + "." + key;
  }

  /// The key's entry, remembered as the place of its address.
  const toml::Entry* given(const char* key);
  const toml::Table& table_of(const toml::Value& value, const std::string& address) const;
  const toml::Array& list_of_tables(const toml::Entry& entry) const;
  const toml::Array& array_of_tables(const toml::Entry& entry) const;
  std::vector<std::string> unique_names(const toml::Entry& list) const;
  std::string advice(const std::string& key, const std::vector<std::string>& known) const;
  void require_no_list(const toml::Entry& entry) const;
  void require_name(const toml::Entry& item, const std::string& list) const;
  void require_one_form(const toml::Entry& shape, const std::vector<std::string>& forms) const;
  void refuse_unknown(const std::vector<std::string>& known) const;
  /// @param example a value of the same kind; empty: none
  [[noreturn]] void fail_without(const char* key, const char* unit, const char* help,
                                 const std::string& example) const;
  static std::string example_of(const double& member) { return toml::number_text(member); }
  static std::string example_of(const sim::Vec3d& member);
  template <class T>
  static std::string example_of(const T&) {
    return {};
  }
  [[noreturn]] void fail_without_shape(const char* key) const;

  Reading& reading_;
  const toml::Table& table_;
  std::string address_;
};

}  // namespace neve::app::scene

#pragma once
/// The visitor of describe.h that lists parameters.

#include <string>
#include <vector>

#include "app/scene/describe.h"
#include "app/scene/leaf.h"
#include "app/scene/params.h"

namespace neve::app::scene {

template <class T>
std::vector<std::string> choices_of([[maybe_unused]] const T& member) {
  if constexpr (Choice<T>)
    return choices<T>();
  else if constexpr (std::is_same_v<T, sim::laws::OneOf>)
    return choices(member);
  else
    return {};
}
template <class T>
std::vector<std::string> choices_of(const std::vector<T>&) {
  return choices_of(T{});
}
template <Choice E>
std::vector<std::string> choices_of(const std::optional<E>&) {
  return choices<E>();
}

class Lister {
 public:
  Lister(std::vector<ParamInfo>& list, std::string prefix)
      : list_(list), prefix_(std::move(prefix)) {}

  template <class T>
  void operator()(const char* key, T& member, const char* unit, const Valid& valid, Change change,
                  const char* help) {
    list_.push_back({prefix_ + key, type_of(member), unit, valid, choices_of(member),
                     value_if_any(member), change == Change::live, help});
  }

  template <class Describe>
  void section(const char* key, const char*, Describe describe_members) {
    Lister inner(list_, prefix_ + key + ".");
    describe_members(inner);
  }

  template <class T>
  void optional(const char* key, std::optional<T>&, const char*) {
    list_item<T>(prefix_ + key + ".");
  }

  template <class T>
  void named(const char* key, std::vector<T>&, const char*) {
    list_item<T>(prefix_ + key + ".NAME.");
  }

  template <class T>
  void list(const char* key, std::vector<T>& items, const char* help) {
    named(key, items, help);
  }

  template <class T>
  void sequence(const char* key, std::vector<T>&, const char*) {
    Lister inner(list_, prefix_ + key + "[N].");
    T item{};
    describe(inner, item);
  }

  void addresses(const char* key, toml::Table&, const char* help) {
    list_.push_back(
        {prefix_ + key + ".ADDRESS", "value", "", anything, {}, std::nullopt, false, help});
  }

  void address_lists(const char* key, std::vector<toml::Table>& items, const char* help) {
    if (items.empty()) items.emplace_back();
    addresses(key, items.front(), help);
  }

  template <class Describe>
  void shape(const char* key, sim::shapes::Shape& shape, const char*, Describe describe_forms) {
    Lister inner(list_, prefix_ + key + ".");
    describe_forms(inner, shape);
  }

  template <class Form>
  void form(const char* key, sim::shapes::Shape& shape, Change change, const char*) {
    Lister inner(list_, prefix_ + key + ".");
    Form item;
    describe(inner, item, change);
    describe_rotation(inner, shape, change);
  }

  template <Choice E, class Use>
  void shorthand(const char* key, const std::optional<E>&, Use, const char* help) {
    list_.push_back(
        {prefix_ + key, "choice", unit::none, anything, choices<E>(), std::nullopt, false, help});
  }

 private:
  template <class T>
  void list_item(const std::string& prefix) {
    Lister inner(list_, prefix);
    T item = fresh<T>();
    describe(inner, item);
  }

  std::vector<ParamInfo>& list_;
  std::string prefix_;
};

}  // namespace neve::app::scene

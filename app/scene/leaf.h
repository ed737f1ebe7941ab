#pragma once
/// One parameter's value: from TOML with errors, to TOML, and the name of its type.

#include <cstdint>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "app/scene/names.h"
#include "app/scene/override.h"
#include "app/scene/scene.h"
#include "app/scene/toml/value.h"
#include "app/scene/valid.h"
#include "sim/laws/law.h"

namespace neve::app::scene {

/// Source of a document: for messages, relative paths and values given by --set.
struct Source {
  std::string file;
  std::string base_dir;
  std::vector<Override> overrides;

  /// Throws a SceneError at the place, or a UsageError when it is a --set.
  [[noreturn]] void fail(toml::Location where, const std::string& message,
                         const std::string& hint = {}) const;
};

/// A value about to become a parameter.
struct Leaf {
  const Source& source;
  const toml::Value& value;
  std::string address;  ///< "material.snow.hardening"
  const char* unit;
  const Valid& valid;

  /// "ADDRESS = FOUND; expected EXPECTED; HINT"
  [[noreturn]] void fail(const std::string& expected, const std::string& hint = {}) const;
  /// One element of an array.
  Leaf element(std::size_t index) const;
  /// An array, of exactly `count` elements unless that is 0; `what` names it in the message.
  const toml::Array& array(std::size_t count, const std::string& what) const;
  const std::string& text(const std::string& what) const;
};

void read_leaf(const Leaf& leaf, bool& member);
void read_leaf(const Leaf& leaf, double& member);
void read_leaf(const Leaf& leaf, int& member);
void read_leaf(const Leaf& leaf, std::uint64_t& member);
void read_leaf(const Leaf& leaf, std::string& member);
void read_leaf(const Leaf& leaf, sim::Vec3d& member);
void read_leaf(const Leaf& leaf, std::vector<std::string>& member);
/// "auto" is the same as nothing.
void read_leaf(const Leaf& leaf, std::optional<sim::Vec3d>& member);
void read_leaf(const Leaf& leaf, PictureSize& member);
void read_leaf(const Leaf& leaf, std::optional<Range>& member);
void read_leaf(const Leaf& leaf, sim::laws::OneOf& member);

toml::Value to_value(const sim::Vec3d& member);
toml::Value to_value(const PictureSize& member);
toml::Value to_value(const std::optional<Range>& member);
toml::Value to_value(const sim::laws::OneOf& member);

/// Names of the values of a parameter that a law describes.
std::vector<std::string> choices(const sim::laws::OneOf& member);

/// "a, b or c", quoted as in TOML; the first ones of very many, and how many more.
std::string list_of(const std::vector<std::string>& names);

/// Advises on an unknown name of a thing in the scene.
std::string name_advice(const std::string& name, const std::vector<std::string>& known);

/// Fails with the names that are allowed, and the nearest.
[[noreturn]] void fail_choice(const Leaf& leaf, const std::vector<std::string>& allowed);

template <Choice E>
void read_leaf(const Leaf& leaf, E& member) {
  const auto* text = std::get_if<std::string>(&leaf.value.data);
  const std::optional<E> value = text ? value_named<E>(*text) : std::nullopt;
  if (!value) fail_choice(leaf, choices<E>());
  member = *value;
}

template <Choice E>
void read_leaf(const Leaf& leaf, std::vector<E>& member) {
  member.clear();
  const std::size_t count = leaf.array(0, "a list of " + list_of(choices<E>())).size();
  for (std::size_t k = 0; k < count; ++k) {
    E item{};
    read_leaf(leaf.element(k), item);
    for (const E& other : member) {
      if (other == item) leaf.element(k).fail("each at most once");
    }
    member.push_back(item);
  }
}

template <class T>
void read_leaf(const Leaf& leaf, std::optional<T>& member) {
  read_leaf(leaf, member.emplace());
}

template <class T>
requires std::is_arithmetic_v<T> toml::Value to_value(T member) {
  if constexpr (std::is_integral_v<T> && !std::is_same_v<T, bool>)
    return {static_cast<std::int64_t>(member)};
  else
    return {member};
}
inline toml::Value to_value(const std::string& member) {
  return {member};
}
template <Choice E>
toml::Value to_value(E member) {
  return {std::string(name(member))};
}
template <class T>
toml::Value to_value(const std::vector<T>& member) {
  toml::Array array;
  for (const T& item : member) array.push_back(to_value(item));
  return {std::move(array)};
}

/// Returns nothing for an optional parameter that is absent.
template <class T>
std::optional<toml::Value> value_if_any(const T& member) {
  return to_value(member);
}
template <class T>
std::optional<toml::Value> value_if_any(const std::optional<T>& member) {
  if (!member) return std::nullopt;
  return to_value(*member);
}
/// A range without numbers is written "auto".
inline std::optional<toml::Value> value_if_any(const std::optional<Range>& member) {
  return to_value(member);
}

template <class T>
std::string type_of(const T&) {
  if (std::is_same_v<T, bool>) return "boolean";
  if (std::is_floating_point_v<T>) return "number";
  if (std::is_integral_v<T>) return "integer";
  if (std::is_same_v<T, std::string>) return "string";
  if (std::is_same_v<T, std::vector<std::string>>) return "list of texts";
  if (std::is_same_v<T, sim::Vec3d>) return "vector";
  return std::is_same_v<T, PictureSize> ? "size" : "choice";
}
template <Choice E>
std::string type_of(const std::vector<E>&) {
  return "list of choices";
}
template <class T>
std::string type_of(const std::optional<T>&) {
  static const T any{};
  return std::is_same_v<T, Range> ? "range" : type_of(any);
}

}  // namespace neve::app::scene

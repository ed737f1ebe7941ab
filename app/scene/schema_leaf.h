#pragma once
/// One parameter's values as JSON Schema (draft 7, which editors read).

#include <optional>
#include <string>
#include <vector>

#include "app/scene/leaf.h"
#include "app/support/json.h"

namespace neve::app::scene {

/// The pattern that names of bodies, views and others follow.
inline const std::string name_pattern = "[A-Za-z0-9_-]{1,64}";
/// The same for a text that is a name and nothing else.
inline std::string whole_name_pattern() {
  return "^" + name_pattern + "$";
}

/// A value as JSON; dates, which no parameter has, become null.
Json to_json(const toml::Value& value);

/// @param unit  of the parameter: bytes are written as "8GiB" too
Json schema_of(const bool&, const Valid& valid, const char* unit);
Json schema_of(const double&, const Valid& valid, const char* unit);
Json schema_of(const int&, const Valid& valid, const char* unit);
Json schema_of(const std::uint64_t&, const Valid& valid, const char* unit);
Json schema_of(const std::string&, const Valid& valid, const char* unit);
Json schema_of(const sim::Vec3d&, const Valid& valid, const char* unit);
Json schema_of(const std::vector<std::string>&, const Valid& valid, const char* unit);
/// "auto" is the same as nothing.
Json schema_of(const std::optional<sim::Vec3d>&, const Valid& valid, const char* unit);
Json schema_of(const PictureSize&, const Valid& valid, const char* unit);
Json schema_of(const std::optional<Range>&, const Valid& valid, const char* unit);

/// Numbers in a row, from `least` to `most` of them.
Json schema_of_numbers(const Json& number, std::size_t least, std::size_t most);
/// A value that fits one of some schemas.
Json schema_of_any(std::vector<Json> schemas);

inline Json schema_of(const sim::laws::OneOf& member, const Valid&, const char*) {
  return {{"enum", choices(member)}};
}
template <Choice E>
Json schema_of(const E&, const Valid&, const char*) {
  return {{"enum", choices<E>()}};
}

template <Choice E>
Json schema_of(const std::vector<E>&, const Valid& valid, const char* unit) {
  return {{"type", "array"}, {"items", schema_of(E{}, valid, unit)}, {"uniqueItems", true}};
}

template <class T>
Json schema_of(const std::optional<T>&, const Valid& valid, const char* unit) {
  return schema_of(T{}, valid, unit);
}

}  // namespace neve::app::scene

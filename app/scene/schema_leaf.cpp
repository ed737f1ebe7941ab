#include "app/scene/schema_leaf.h"

#include <cmath>
#include <string_view>
#include <utility>

namespace neve::app::scene {
namespace {

constexpr const char* bytes_pattern =
    "^[0-9.]+([eE][+-]?[0-9]+)? *(KiB|MiB|GiB|TiB|kB|KB|MB|GB|TB|B|K|M|G|T)$";

struct ToJson {
  Json operator()(bool b) const { return b; }
  Json operator()(std::int64_t i) const { return i; }
  Json operator()(double x) const { return number_or_null(x); }
  Json operator()(const std::string& s) const { return s; }
  Json operator()(toml::Date) const { return {}; }
  Json operator()(const toml::Array& array) const {
    Json list = Json::array();
    for (const toml::Value& value : array) list.push_back(std::visit(*this, value.data));
    return list;
  }
  Json operator()(const toml::Table& table) const {
    Json object = Json::object();
    for (const toml::Entry& entry : table.entries)
      object[entry.key] = std::visit(*this, entry.value.data);
    return object;
  }
};

Json bounded(const char* type, const Valid& valid) {
  Json schema = {{"type", type}};
  const double least = valid.min_above_0 > 0 ? valid.min_above_0 : valid.min;
  if (std::isfinite(least))
    schema[valid.is_min_open ? "exclusiveMinimum" : "minimum"] = count_json(least);
  if (std::isfinite(valid.max))
    schema[valid.is_max_open ? "exclusiveMaximum" : "maximum"] = count_json(valid.max);
  if (valid.min_above_0 > 0) return schema_of_any({{{"const", 0}}, schema});
  return schema;
}

}  // namespace

Json to_json(const toml::Value& value) {
  return std::visit(ToJson{}, value.data);
}

Json schema_of_numbers(const Json& number, std::size_t least, std::size_t most) {
  return {{"type", "array"}, {"items", number}, {"minItems", least}, {"maxItems", most}};
}

Json schema_of_any(std::vector<Json> schemas) {
  Json list = Json::array();
  for (Json& schema : schemas) list.push_back(std::move(schema));
  return {{"anyOf", std::move(list)}};
}

Json schema_of(const bool&, const Valid&, const char*) {
  return {{"type", "boolean"}};
}
Json schema_of(const double&, const Valid& valid, const char*) {
  return bounded("number", valid);
}
Json schema_of(const int&, const Valid& valid, const char*) {
  return bounded("integer", valid);
}
Json schema_of(const std::uint64_t&, const Valid& valid, const char* unit) {
  const Json number = bounded("integer", valid);
  if (std::string_view(unit) != "B") return number;
  return schema_of_any({number, {{"type", "string"}, {"pattern", bytes_pattern}}});
}
Json schema_of(const std::string&, const Valid& valid, const char*) {
  Json schema = {{"type", "string"}};
  if (valid.text == Valid::Text::name) schema["pattern"] = whole_name_pattern();
  if (valid.text == Valid::Text::file) schema["minLength"] = 1;
  if (valid.text == Valid::Text::numbered_files) schema["pattern"] = "%(0[1-9])?d|#+|\\$F[1-9]?";
  return schema;
}
Json schema_of(const sim::Vec3d&, const Valid& valid, const char*) {
  return schema_of_numbers(bounded("number", valid), 3, 3);
}
Json schema_of(const std::vector<std::string>&, const Valid& valid, const char* unit) {
  return {{"type", "array"}, {"items", schema_of(std::string(), valid, unit)}};
}
Json schema_of(const std::optional<sim::Vec3d>&, const Valid& valid, const char* unit) {
  return schema_of_any({{{"const", "auto"}}, schema_of(sim::Vec3d(), valid, unit)});
}
Json schema_of(const PictureSize&, const Valid& valid, const char*) {
  return schema_of_numbers(bounded("integer", valid), 2, 2);
}
Json schema_of(const std::optional<Range>&, const Valid& valid, const char*) {
  return schema_of_any({{{"const", "auto"}}, schema_of_numbers(bounded("number", valid), 2, 2)});
}

}  // namespace neve::app::scene

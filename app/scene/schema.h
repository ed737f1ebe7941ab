#pragma once
/// JSON Schema of scenes: what editors complete, explain and underline.
///
/// The schema has every table, key, unit, default and range of describe.h. Conditions between
/// several keys are not in it; neve itself has the last word.

#include <string>
#include <vector>

#include "app/scene/describe.h"
#include "app/scene/schema_leaf.h"

namespace neve::app::scene {

/// A parameter or a table that --set and sweeps can address.
struct AddressSchema {
  std::string address;  ///< "body.NAME.velocity"
  Json schema;
  bool is_table = false;
};

/// The visitor of describe.h that writes the schema of one table.
class SchemaWriter {
 public:
  /// @param addresses  gets every address in the table
  /// @param prefix     of these addresses
  SchemaWriter(std::vector<AddressSchema>& addresses, std::string prefix)
      : addresses_(addresses), prefix_(std::move(prefix)) {}

  /// @param help  a sentence on the table
  Json table(const std::string& help) const {
    Json schema = {{"type", "object"},
                   {"description", help},
                   {"properties", properties_},
                   {"additionalProperties", false}};
    if (!required_.empty()) schema["required"] = required_;
    return schema;
  }

  template <class T>
  void operator()(const char* key, T& member, const char* unit, const Valid& valid, Change,
                  const char* help) {
    Json schema = {{"description", text_of(help, unit)}};
    schema.update(schema_of(member, valid, unit));
    if (valid.is_required)
      required_.push_back(key);
    else if (const std::optional<toml::Value> value = value_if_any(member))
      schema["default"] = to_json(*value);
    add(key, std::move(schema), false);
  }

  template <class Describe>
  void section(const char* key, const char* help, Describe describe_members) {
    SchemaWriter inner(addresses_, prefix_ + key + ".");
    describe_members(inner);
    add(key, inner.table(help), true);
  }

  template <class T>
  void optional(const char* key, std::optional<T>&, const char* help) {
    add(key, item<T>(prefix_ + key + ".", help), true);
  }

  template <class T>
  void named(const char* key, std::vector<T>&, const char* help) {
    properties_[key] = {
        {"type", "object"},
        {"patternProperties", {{whole_name_pattern(), item<T>(prefix_ + key + ".NAME.", help)}}},
        {"additionalProperties", false}};
  }

  template <class T>
  void list(const char* key, std::vector<T>&, const char* help) {
    properties_[key] = list_of_tables(item<T>(prefix_ + key + ".NAME.", help));
  }

  template <class T>
  void sequence(const char* key, std::vector<T>&, const char* help) {
    std::vector<AddressSchema> none;  // one keyframe has no address that can be set
    SchemaWriter inner(none, "");
    T first{};
    describe(inner, first);
    add(key, list_of_tables(inner.table(help)), true);
  }

  template <class Describe>
  void shape(const char* key, sim::shapes::Shape& shape, const char* help,
             Describe describe_forms) {
    SchemaWriter inner(addresses_, prefix_ + key + ".");
    describe_forms(inner, shape);
    Json schema = inner.table(help);
    schema["minProperties"] = schema["maxProperties"] = 1;
    required_.push_back(key);
    add(key, std::move(schema), true);
  }

  template <class Form>
  void form(const char* key, sim::shapes::Shape& shape, Change change, const char* help) {
    SchemaWriter inner(addresses_, prefix_ + key + ".");
    Form form;
    describe(inner, form, change);
    describe_rotation(inner, shape, change);
    add(key, inner.table(help), true);
  }

  template <Choice E, class Use>
  void shorthand(const char* key, const std::optional<E>&, Use, const char* help) {
    Json schema = {{"description", help}};
    schema.update(schema_of(E{}, anything, unit::none));
    add(key, std::move(schema), false);
  }

  /// Adds a key that the visitor has no word for.
  void add_key(const char* key, Json schema) { properties_[key] = std::move(schema); }

 private:
  static std::string text_of(const std::string& help, const std::string& unit) {
    return unit.empty() ? help : help + " Unit: " + unit + ".";
  }

  static Json list_of_tables(Json table) {
    return {{"type", "array"}, {"items", std::move(table)}};
  }

  template <class T>
  Json item(const std::string& prefix, const char* help) {
    SchemaWriter inner(addresses_, prefix);
    T first = fresh<T>();
    describe(inner, first);
    return inner.table(help);
  }

  void add(const char* key, Json schema, bool is_table) {
    addresses_.push_back({prefix_ + key, schema, is_table});
    properties_[key] = std::move(schema);
  }

  std::vector<AddressSchema>& addresses_;
  std::string prefix_;
  Json properties_ = Json::object();
  Json required_ = Json::array();
};

/// The schema of a scene file.
/// @param addresses  gets all that --set and sweeps can address
Json scene_schema(std::vector<AddressSchema>& addresses);
Json scene_schema();

}  // namespace neve::app::scene

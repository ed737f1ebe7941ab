#include "app/sweep/read/sweep_schema.h"

#include <algorithm>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "app/scene/schema.h"
#include "app/scene/schema_leaf.h"
#include "app/sweep/read/describe_sweep.h"
#include "app/sweep/read/sweep_leaf.h"

namespace neve::app::sweep::read {

namespace {

/// "^body\.[A-Za-z0-9_-]{1,64}\.velocity$" for "body.NAME.velocity".
std::string pattern_of(const std::string& address) {
  const std::string name = ".NAME.";
  const std::size_t at = address.find(name);
  const auto escaped = [](std::string_view text) {
    std::string out;
    for (const char c : text) out += c == '.' ? std::string("\\.") : std::string(1, c);
    return out;
  };
  if (at == std::string::npos) return "^" + escaped(address) + "$";
  return "^" + escaped(address.substr(0, at)) + "\\." + scene::name_pattern + "\\." +
         escaped(address.substr(at + name.size())) + "$";
}

Json reference_to(const std::string& definition) {
  return {{"$ref", "#/definitions/" + definition}};
}

/// A value that one run has, or "none". Whole tables are rare: their keys are left to neve.
Json value_schema(const scene::AddressSchema& parameter) {
  if (parameter.is_table)
    return {{"description", parameter.schema.value("description", "")},
            {"type", {"object", "array", "string"}}};
  Json schema = scene::schema_of_any({parameter.schema, {{"const", "none"}}});
  if (parameter.schema.contains("description"))
    schema["description"] = parameter.schema["description"];
  return schema;
}

/// Returns the schema of several values: a list, or a rule for them.
Json axis_schema(const scene::AddressSchema& parameter) {
  const Json list = {
      {"type", "array"}, {"items", reference_to(parameter.address)}, {"minItems", 1}};
  // solver = { cell_size = [...] } is solver.cell_size = [...], without quotes.
  if (parameter.is_table) return scene::schema_of_any({list, {{"type", "object"}}});
  const Json rule = {{"allOf", {reference_to("rule"), {{"properties", {{"values", list}}}}}}};
  return scene::schema_of_any({list, rule});
}

Json rule_schema() {
  std::vector<scene::AddressSchema> none;
  scene::SchemaWriter writer(none, "");
  AxisRule rule;
  describe(writer, rule);
  Json schema = writer.table("The values of an axis, by one rule.");
  for (const char* kind :
       {"values", "linspace", "logspace", "range", "uniform", "log_uniform", "normal"})
    schema["oneOf"].push_back({{"required", {kind}}});
  for (const char* spaced : {"linspace", "logspace"}) schema["dependencies"][spaced] = {"num"};
  return schema;
}

/// The visitor that knows the tables whose keys are addresses too.
class SweepSchemaWriter : public scene::SchemaWriter {
 public:
  SweepSchemaWriter(std::vector<scene::AddressSchema>& own,
                    const std::vector<scene::AddressSchema>& of_scene)
      : SchemaWriter(own, ""), of_scene_(of_scene) {}

  void addresses(const char* key, scene::toml::Table&, const char* help) {
    add_key(key, table_of_addresses(help, std::string_view(key) == "axis"));
  }

  void address_lists(const char* key, std::vector<scene::toml::Table>&, const char* help) {
    const bool is_link = std::string_view(key) == "link";
    Json table = table_of_addresses(help, is_link);
    if (is_link)
      table["properties"]["labels"] = {{"type", "array"}, {"items", {{"type", "string"}}}};
    else
      table["properties"]["label"] = {{"type", "string"}};
    add_key(key, {{"type", "array"}, {"items", std::move(table)}});
  }

 private:
  Json table_of_addresses(const char* help, bool is_axis) const {
    Json patterns = Json::object();
    for (const scene::AddressSchema& parameter : of_scene_)
      patterns[pattern_of(parameter.address)] =
          is_axis ? axis_schema(parameter) : reference_to(parameter.address);
    // Addresses without quotes are tables in tables.
    return {{"type", "object"},
            {"description", help},
            {"patternProperties", std::move(patterns)},
            {"additionalProperties", {{"type", "object"}}}};
  }

  const std::vector<scene::AddressSchema>& of_scene_;
};

}  // namespace

Json sweep_schema() {
  std::vector<scene::AddressSchema> of_scene, own;
  scene::scene_schema(of_scene);
  SweepSchemaWriter writer(own, of_scene);
  SweepFile file;
  describe(writer, file);
  Json schema = {{"$schema", "http://json-schema.org/draft-07/schema#"},
                 {"title", "Sweep of neve"}};
  schema.update(writer.table("A sweep: a scene, the parameters that vary, and the contact sheet."));
  schema["required"] = {"sweep"};
  schema["properties"]["sweep"]["required"] = {"scene"};
  for (const scene::AddressSchema& parameter : of_scene)
    schema["definitions"][parameter.address] = value_schema(parameter);
  schema["definitions"]["rule"] = rule_schema();
  return schema;
}

}  // namespace neve::app::sweep::read

#include "app/scene/schema.h"

namespace neve::app::scene {

Json scene_schema(std::vector<AddressSchema>& addresses) {
  SchemaWriter writer(addresses, "");
  Scene scene;
  describe(writer, scene);
  Json schema = {{"$schema", "http://json-schema.org/draft-07/schema#"},
                 {"title", "Scene of neve"}};
  schema.update(writer.table("A scene: snow, colliders, and the pictures of them."));
  return schema;
}

Json scene_schema() {
  std::vector<AddressSchema> addresses;
  return scene_schema(addresses);
}

}  // namespace neve::app::scene

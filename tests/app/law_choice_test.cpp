// Parameters of laws that are one of some names: read, written, listed, shown and refused as
// choices.
#include <gtest/gtest.h>

#include <algorithm>

#include "app/picture/frame_builder.h"
#include "app/scene/params.h"
#include "app/scene/read.h"
#include "app/scene/schema.h"
#include "app/scene/toml/error.h"
#include "app/support/errors.h"
#include "sim/laws/cam_clay.h"

namespace neve::app {
namespace {

namespace cam_clay = sim::laws::cam_clay;

scene::Scene snow_with(const std::string& line, const std::vector<std::string>& sets = {}) {
  std::vector<scene::Override> overrides;
  for (const std::string& set : sets) overrides.push_back(scene::parse_override(set));
  return scene::read_scene_text("[material.snow]\nmodel = \"cam_clay\"\n" + line +
                                    "\n[[body]]\nshape = { sphere = { radius = 0.1 } }\n",
                                "s.toml", "", overrides);
}

TEST(LawChoice, FlowIsReadSetAndWritten) {
  EXPECT_EQ(snow_with("").materials[0].own[cam_clay::flow], cam_clay::radial);
  for (const scene::Scene& scene :
       {snow_with("flow = \"isochoric\""), snow_with("", {"material.snow.flow=isochoric"})}) {
    EXPECT_EQ(scene.materials[0].own[cam_clay::flow], cam_clay::isochoric);
    const std::string text = scene::write_scene(scene);
    EXPECT_NE(text.find("flow = \"isochoric\""), std::string::npos);
    EXPECT_EQ(scene::read_scene_text(text, "again", "").materials[0].own, scene.materials[0].own);
  }
  // A preset of snow says nothing about it.
  EXPECT_EQ(snow_with("preset = \"wet\"\nflow = \"isochoric\"").materials[0].own[cam_clay::flow],
            cam_clay::isochoric);
}

TEST(LawChoice, OtherNamesOfAFlowAreAnswered) {
  const auto answer = [](const std::string& line) {
    try {
      snow_with(line);
    } catch (const std::exception& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  const std::string typo = answer("flow = \"isocoric\"");
  EXPECT_NE(typo.find("s.toml:3:8"), std::string::npos) << typo;
  EXPECT_NE(typo.find("expected \"radial\" or \"isochoric\"; did you mean \"isochoric\"?"),
            std::string::npos)
      << typo;
  EXPECT_NE(answer("flow = \"associated\"").find("did you mean \"radial\"?"), std::string::npos);
  EXPECT_NE(answer("flow = 1").find("expected \"radial\" or \"isochoric\""), std::string::npos);
  EXPECT_NE(answer("flow_rule = \"radial\"").find("did you mean \"flow\"?"), std::string::npos);
}

TEST(LawChoice, ListsAndSchemaHaveItsNames) {
  const std::vector<scene::ParamInfo> all = scene::params();
  const auto flow = std::find_if(all.begin(), all.end(), [](const scene::ParamInfo& info) {
    return info.address == "material.NAME.flow";
  });
  ASSERT_NE(flow, all.end());
  EXPECT_EQ(flow->type, "choice");
  EXPECT_EQ(flow->choices, (std::vector<std::string>{"radial", "isochoric"}));
  EXPECT_EQ(std::get<std::string>(flow->default_value->data), "radial");
  EXPECT_TRUE(flow->is_live);
  EXPECT_NE(scene::scene_schema().dump().find("\"enum\":[\"radial\",\"isochoric\"]"),
            std::string::npos);
}

TEST(LawChoice, SlatesNameAFlowThatIsNotTheUsualOne) {
  const auto line = [](const scene::Scene& scene) {
    const setup::SeededScene seeded;
    return picture::FrameBuilder(scene, seeded).slate().at(1);
  };
  const std::string usual = line(snow_with("")), other = line(snow_with("flow = \"isochoric\""));
  EXPECT_EQ(usual.find("flow"), std::string::npos);
  EXPECT_EQ(other, usual + ", isochoric flow");
}

}  // namespace
}  // namespace neve::app

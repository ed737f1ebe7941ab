// The list of parameters.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "app/scene/params.h"
#include "app/support/json.h"
#include "sim/types/material.h"

namespace neve::app {
namespace {

const app::scene::ParamInfo& param(const std::vector<app::scene::ParamInfo>& list,
                                   const std::string& address) {
  const auto found = std::find_if(list.begin(), list.end(), [&](const app::scene::ParamInfo& info) {
    return info.address == address;
  });
  EXPECT_NE(found, list.end()) << address;
  return *found;
}

TEST(Params, EachIsDescribedOnceInOneSentence) {
  std::set<std::string> seen;
  for (const app::scene::ParamInfo& info : app::scene::params()) {
    EXPECT_TRUE(seen.insert(info.address).second) << info.address;
    EXPECT_TRUE(info.help.ends_with('.') && info.help.size() < 120) << info.address;
    EXPECT_FALSE(info.type.empty()) << info.address;
  }
  EXPECT_GT(seen.size(), 80u);
}

TEST(Params, DefaultsComeFromTheStructs) {
  const auto list = app::scene::params();
  const app::scene::ParamInfo& hardening = param(list, "material.NAME.hardening");
  EXPECT_EQ(std::get<double>(hardening.default_value->data), sim::Material{}.hardening);
  EXPECT_TRUE(hardening.is_live);
  EXPECT_FALSE(param(list, "material.NAME.density").is_live);
  EXPECT_FALSE(param(list, "solver.cell_size").is_live);
  EXPECT_FALSE(param(list, "body.NAME.shape.sphere.radius").is_live);
  EXPECT_TRUE(param(list, "collider.NAME.shape.sphere.radius").is_live);
  EXPECT_EQ(std::get<std::string>(param(list, "body.NAME.material").default_value->data), "snow");
  EXPECT_FALSE(param(list, "camera.eye").default_value.has_value());
}

TEST(Params, DefaultsAreInRange) {
  for (const app::scene::ParamInfo& info : app::scene::params()) {
    if (!info.default_value) continue;
    if (const auto* x = std::get_if<double>(&info.default_value->data)) {
      EXPECT_TRUE(info.valid.contains(*x)) << info.address;
    }
  }
}

TEST(Params, JsonHasTheKeysThatScriptsRelyOn) {
  const Json list = parse_json(app::scene::params_json());
  ASSERT_EQ(list.size(), app::scene::params().size());
  for (const Json& item : list) {
    for (const char* key : {"address", "type", "unit", "min", "max", "default", "live", "help"}) {
      EXPECT_TRUE(item.contains(key)) << key;
    }
  }
  const Json& ratio = *std::find_if(list.begin(), list.end(), [](const Json& item) {
    return item["address"] == "material.NAME.poisson_ratio";
  });
  EXPECT_EQ(ratio["min"], 0);
  EXPECT_EQ(ratio["max"], 0.5);
  EXPECT_EQ(ratio["max_open"], true);
  EXPECT_EQ(ratio["default"], 0.2);
}

TEST(Params, TableHasALineEach) {
  const std::string table = app::scene::params_table();
  const auto lines = std::count(table.begin(), table.end(), '\n');
  EXPECT_EQ(static_cast<std::size_t>(lines), app::scene::params().size() + 1);
}

}  // namespace
}  // namespace neve::app

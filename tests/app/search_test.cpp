/// Parameters are found by their words, their sentences and everyday names; wishes name parameters
/// that exist, with values that they take.

#include "app/scene/search.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "app/advice/suggest.h"
#include "app/advice/wishes.h"
#include "app/scene/params.h"
#include "app/scene/read.h"
#include "app/support/json.h"

namespace neve::app {
namespace {

std::vector<std::string> found(const std::string& text) {
  const scene::Search search(text);
  std::vector<std::string> addresses;
  for (const scene::ParamInfo& info : scene::params())
    if (search.finds(info.address, info.help)) addresses.push_back(info.address);
  return addresses;
}

bool finds(const std::string& text, const std::string& address) {
  const std::vector<std::string> addresses = found(text);
  return std::find(addresses.begin(), addresses.end(), address) != addresses.end();
}

TEST(Search, WordsOfAddressesAndSentencesAreFound) {
  EXPECT_TRUE(finds("time step", "solver.time_step"));
  EXPECT_TRUE(finds("time step", "solver.dt"));
  EXPECT_TRUE(finds("dt", "solver.max_dt"));
  EXPECT_FALSE(finds("dt", "mosaic.NAME.width"));
  EXPECT_TRUE(finds("bulge", "material.NAME.poisson_ratio"));
  EXPECT_TRUE(finds("camera", "view.NAME.camera.fov"));
  EXPECT_TRUE(finds("camera.fov", "view.NAME.camera.fov"));
  EXPECT_TRUE(finds("material.snow.hardening", "material.NAME.hardening"));
  EXPECT_EQ(found("material.snow.hardening").size(), 1u);
  EXPECT_TRUE(finds("harden", "material.NAME.hardening"));
  EXPECT_TRUE(finds("YOUNG", "material.NAME.youngs_modulus"));
  EXPECT_TRUE(found("nonsense").empty());
}

TEST(Search, EverydayNamesAreFound) {
  for (const auto& [word, address] : std::vector<std::pair<const char*, const char*>>{
           {"stickiness", "material.NAME.critical_stretch"},
           {"cohesion", "material.NAME.critical_stretch"},
           {"stick", "collider.NAME.contact"},
           {"hardness", "material.NAME.hardening"},
           {"fall apart", "material.NAME.critical_stretch"},
           {"softness", "material.NAME.youngs_modulus"},
           {"powder", "material.NAME.critical_compression"},
           {"explode", "solver.dt"},
           {"explodes", "solver.acoustic_cfl"},
           {"resolution", "solver.cell_size"},
           {"slippery", "collider.NAME.friction"},
           {"theta_c", "material.NAME.critical_compression"}})
    EXPECT_TRUE(finds(word, address)) << word;
}

TEST(Search, EverydayNamesMeanParametersThatExist) {
  const auto exists = [](const std::string& address) {
    return scene::param_at(address).has_value();
  };
  for (const advice::Entry& entry : advice::entries_of("parameter"))
    for (const std::string& address : entry.names)
      EXPECT_TRUE(exists(address)) << entry.words.front() << ": " << address;
  for (const advice::Wish& wish : advice::wishes())
    for (const advice::WishChange& change : wish.changes)
      EXPECT_TRUE(exists(change.address)) << wish.name << ": " << change.address;
}

/// Both ends of every row can be set, and say something else than each other.
TEST(Wishes, ValuesOfLooksAreTaken) {
  const std::string text =
      "[[body]]\nname = \"ball\"\nshape = { sphere = { center = [0, 1, 0], radius = 0.1 } }\n"
      "[[collider]]\nname = \"floor\"\nshape = { plane = {} }\n";
  for (const advice::Wish& wish : advice::wishes()) {
    EXPECT_GE(wish.changes.size(), 1u);
    for (const advice::WishChange& change : wish.changes) {
      std::string address = change.address;
      const std::string item = address.starts_with("material") ? "snow"
                               : address.starts_with("body")   ? "ball"
                                                               : "floor";
      if (const auto at = address.find("NAME"); at != std::string::npos)
        address.replace(at, 4, item);
      EXPECT_STRNE(change.less, change.more);
      for (const char* value : {change.less, change.more})
        EXPECT_NO_THROW(scene::read_scene_text(text, "s.toml", {},
                                               {scene::parse_override(address + "=" + value)}))
            << address << " = " << value;
    }
  }
}

TEST(Wishes, TablesHaveALineForEachChange) {
  std::vector<const advice::Wish*> all;
  std::size_t changes = 0;
  for (const advice::Wish& wish : advice::wishes()) {
    all.push_back(&wish);
    changes += wish.changes.size();
  }
  const auto lines = [](const std::string& text) {
    return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
  };
  EXPECT_EQ(lines(advice::wishes_table(all)), changes + 4);
  EXPECT_EQ(lines(advice::wishes_markdown(all)), changes + 2);
  EXPECT_EQ(parse_json(std::string_view(advice::wishes_json(all))).size(), all.size());
  ASSERT_EQ(advice::wishes_for("stick").size(), 1u);
  EXPECT_STREQ(advice::wishes_for("stick")[0]->name, "stickier");
}

}  // namespace
}  // namespace neve::app

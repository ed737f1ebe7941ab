/// Snow that comes and goes from the command line: counted, resumed and checked.

#include "tests/support/resume.h"

namespace neve::test {
namespace {

class FlowCli : public Cli {
 protected:
  FlowCli() {
    folder.write("flow.toml", R"(
frames = 6
fps = 24
[solver]
cell_size = 0.04
[[emitter]]
name = "spout"
shape = { box = { center = [0, 0.5, 0], size = [0.3, 0.08, 0.3] } }
velocity = [0, -3, 0]
rate = 60
[[sink]]
shape = { box = { center = [0, -0.5, 0], size = [2, 1, 2] } }
[output]
size = [160, 120]
)");
  }
};

TEST_F(FlowCli, SnowThatComesAndGoesIsCounted) {
  const auto run = neve({"render", "flow.toml", "--out", "out"});
  ASSERT_EQ(run.exit_code, 0) << run.errors;
  EXPECT_TRUE(contains(run.errors, "0 particles and")) << run.errors;
  const app::Json json = app::parse_json(std::string_view(read_text(folder / "out/run.json")));
  const app::Json &first = json["frames"].front(), &last = json["frames"].back();
  EXPECT_EQ(first["particles"], 0);
  // 60 kg/s for 0.25 s, in shares of 400 kg/m3 (4 cm)^3 / 8.
  EXPECT_NEAR(last["emitted"].get<double>(), 60 * 0.25 / (400 * 0.04 * 0.04 * 0.04 / 8), 1);
  EXPECT_GT(last["removed"].get<int>(), 500);
  EXPECT_EQ(last["particles"].get<int>(), last["emitted"].get<int>() - last["removed"].get<int>());
  EXPECT_GT(last["mass"].get<double>(), 1);
}

/// Only `check` told of such emitters: a render made pictures of nothing.
TEST_F(FlowCli, RenderTellsOfEmittersThatNeverEmit) {
  const auto late = neve(
      {"render", "flow.toml", "--out", "late", "--frames", "0", "--set", "emitter.spout.start=5"});
  ASSERT_EQ(late.exit_code, 0) << late.errors;
  EXPECT_TRUE(contains(late.errors, "emitter.spout.start: spout opens at 5 s")) << late.errors;
  const auto thin = neve({"render", "flow.toml", "--out", "thin", "--frames", "0", "--set",
                          "emitter.spout.rate=1e-9"});
  ASSERT_EQ(thin.exit_code, 0) << thin.errors;
  EXPECT_TRUE(contains(thin.errors, "emitter.spout.rate: no snow comes")) << thin.errors;
}

TEST_F(FlowCli, AProbeIsToldById) {
  const auto table = neve({"dump", "flow.toml", "--at", "0.25", "--field", "id", "--quiet"});
  ASSERT_EQ(table.exit_code, 0) << table.errors;
  ASSERT_TRUE(table.output.starts_with("id\n")) << table.output;
  // The first row comes after the last comment.
  const std::size_t comment = table.output.rfind("\n#");
  const int first = std::stoi(table.output.substr(table.output.find('\n', comment + 1) + 1));
  ASSERT_GT(first, 0);
  EXPECT_FALSE(contains(table.output, "e+0")) << table.output;
  const auto probe = [&](int id) {
    return neve({"dump", "flow.toml", "--at", "0.25", "--probe", std::to_string(id), "--json"});
  };
  const auto there = probe(first + 1000);
  ASSERT_EQ(there.exit_code, 0) << there.errors;
  const app::Json json = app::parse_json(std::string_view(there.output));
  EXPECT_EQ(json["probes"][0]["id"]["value"], first + 1000);
  const auto removed = probe(0), later = probe(1000000);
  EXPECT_EQ(removed.exit_code, 2);
  EXPECT_TRUE(contains(removed.output + removed.errors, "was removed")) << removed.output;
  EXPECT_EQ(later.exit_code, 2);
  EXPECT_TRUE(contains(later.output + later.errors, "not emitted yet")) << later.output;
}

TEST_F(FlowCli, PartsOfARunAreTheWholeOne) {
  ASSERT_EQ(neve({"render", "flow.toml", "--out", "whole"}).exit_code, 0);
  ASSERT_EQ(neve({"render", "flow.toml", "--out", "parts", "--frames", "0-3"}).exit_code, 0);
  const auto more = neve({"render", "flow.toml", "--out", "parts", "--resume"});
  ASSERT_EQ(more.exit_code, 0) << more.errors;
  EXPECT_TRUE(contains(more.errors, "resumed after frame 3")) << more.errors;
  const RunFiles x = files_of(folder / "whole"), y = files_of(folder / "parts");
  EXPECT_EQ(x.hashes, y.hashes);
  EXPECT_TRUE(x.pictures == y.pictures);
}

TEST_F(FlowCli, CheckForecastsTheCostOfEmission) {
  const auto check = neve({"check", "flow.toml", "--json"});
  EXPECT_EQ(check.exit_code, 0) << check.errors;
  const app::Json json = app::parse_json(std::string_view(check.output));
  EXPECT_GT(json["seconds_per_step"].get<double>(), 0);
}

}  // namespace
}  // namespace neve::test

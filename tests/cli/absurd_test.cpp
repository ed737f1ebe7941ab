/// Scenes and sweeps that ask for more than there is: refused before anything exists.

#include "tests/support/costly_cli.h"

namespace neve::test {
namespace {

class Absurd : public CostlyCli {
 protected:
  /// True where the command ends with 8, within 1 s and 256 MiB.
  bool is_refused(const std::string& arguments) {
    const Cost cost = cost_of(arguments);
    const std::string said = read_text(folder / "said").substr(0, 300);
    EXPECT_EQ(cost.exit_code, 8) << arguments << "\n" << said;
    EXPECT_TRUE(contains(said, "refused: ")) << arguments << "\n" << said;
    EXPECT_LT(cost.seconds, 1) << arguments;
    EXPECT_LT(cost.memory, 256 * 1024.0 * 1024.0) << arguments;
    return !HasFailure();
  }
};

TEST_F(Absurd, ScenesAreRefusedBeforeAnythingIsWritten) {
  const std::string box = "body.ball.shape='{ box = { center = [0, 0, 0], size = ",
                    spout = "[[emitter]]\nname = \"spout\"\nvelocity = [0, -1, 0]\n";
  int refused = 0;
  for (const std::string& change :
       {std::string("solver.cell_size=1e-5"), std::string("solver.cell_size=3e-4"),
        std::string("solver.cell_size=1e-6"), std::string("body.ball.shape.sphere.radius=1e5"),
        std::string("body.ball.shape.sphere.radius=30"), box + "[100, 100, 100] } }'",
        box + "[1e5, 1e5, 1e5] } }'", box + "[1e5, 0.1, 1e5] } }'", box + "[2e5, 1, 1] } }'",
        std::string("output.size='[16384, 16384]'"), std::string("output.size='[1000000, 16]'"),
        std::string("output.size='[1000000, 1000000]'"), std::string("limits.particles=10"),
        std::string("limits.memory=1KB"), std::string("limits.pixels=100")})
    refused += is_refused("render scene.toml --set " + change);
  folder.write("mesh.obj",
               "v 0 0 0\nv 0.3 0 0\nv 0 0.2 0\nv 0 0 0.3\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n");
  for (const std::string& text :
       {with_views(6000, "[1920, 1080]"), with_views(300, "[7680, 4320]"),
        with_views(1000, "[7680, 4320]"), with_views(9000, "[4000, 4000]"),
        tiny_scene + spout + "shape = { sphere = { center = [0, 9, 0], radius = 1e4 } }\n",
        tiny_scene + spout + "shape = { box = { center = [0, 9, 0], size = [1e5, 1, 1e5] } }\n",
        tiny_scene + spout +
            "shape = { sphere = { center = [0, 9, 0], radius = 5 } }\nrate = 1e9\n",
        "limits.memory = \"1000TiB\"\nlimits.particles = 1e15\n" + std::string(tiny_scene) +
            "[[body]]\nname = \"more\"\nshape = { sphere = { center = [0, 900, 0], radius = 800 } "
            "}\n",
        tiny_scene +
            std::string("[[body]]\nname = \"mesh\"\nshape = { mesh = { file = \"mesh.obj\", "
                        "center = [0, 9, 0], scale = 1e5 } }\n")}) {
    folder.write("absurd.toml", text);
    refused += is_refused("render absurd.toml");
  }
  EXPECT_EQ(refused, 24);
}

TEST_F(Absurd, SweepsAreRefusedBeforeAnythingIsWritten) {
  const std::string head = "[sweep]\nscene = \"scene.toml\"\n";
  const auto many = [](int count, const std::string& line) {
    std::string text;
    for (int k = 0; k < count; ++k) {
      std::string one = line;
      if (const auto at = one.find('#'); at != std::string::npos)
        one.replace(at, 1, std::to_string(k));
      text += one + "\n";
    }
    return text;
  };
  const std::string axes = head + "[axis]\n";
  int refused = 0;
  for (const std::string& text :
       {axes + many(400, "\"view.v#.size\" = { linspace = [1, 2], num = 99999 }"),
        axes + many(3, "\"view.v#.size\" = { linspace = [1, 2], num = 40000 }"),
        axes + "seed = { range = [1, 99999] }\n",
        axes + "\"solver.cfl\" = { linspace = [0.1, 0.4], num = 2000 }\n",
        axes + "seed = { range = [1, 60] }\n\"solver.cfl\" = { linspace = [0.1, 0.4], num = 60 }\n",
        axes + many(1, "\"material.snow.hardening\" = { linspace = [1, 9], num = 30 }") +
            "seed = { range = [1, 30] }\n\"solver.cfl\" = { linspace = [0.1, 0.4], num = 30 }\n" +
            "\"material.snow.density\" = { linspace = [100, 500], num = 30 }\n" +
            "\"material.snow.youngs_modulus\" = { linspace = [1e5, 2e5], num = 30 }\n",
        head + "method = \"list\"\n" + many(50'000, "[[run]]\nseed = #"),
        head + "method = \"list\"\n" + many(1001, "[[run]]\nseed = #"),
        head + "method = \"lhs\"\nsamples = 100000\n[axis]\n\"solver.cfl\" = { uniform = [0.1, "
               "0.4] }\n",
        head + "method = \"lhs\"\nsamples = 1001\n[axis]\nseed = { uniform = [1, 4] }\n",
        axes + "seed = { range = [1, 1001] }\n", axes + "seed = [1, 2, 3]\n[limits]\nruns = 2\n"}) {
    folder.write("sweep.toml", text);
    refused += is_refused("sweep sweep.toml");
  }
  EXPECT_EQ(refused, 12);
}

}  // namespace
}  // namespace neve::test

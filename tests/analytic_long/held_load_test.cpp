/// Contact that holds a load: for most of a second, and as many passes would.

#include "tests/support/beam.h"
#include "tests/support/mould.h"
#include "tests/support/verification.h"

namespace {

using namespace neve::sim;
using namespace neve::test;

/// The plate rests for most of a second. Two passes leave the outermost particles a twentieth of a
/// cell behind, which comes to rest after the plate: that adds a few per cent.
TEST(MouldLong, SnowKeepsItsStressForMostOfASecond) {
  for (const Mould& mould : moulds()) {
    const double frame = 0.01, stop = mould.seconds, end = stop + 0.8;
    const std::vector<Pressed> found = run_mould(mould, {stop - frame, stop, end - frame, end});
    const std::string line = in_words(mould.settings);
    verify_near({"mould_long", line, "stress, of that when the plate stopped"}, 1,
                found[3].sigma / found[1].sigma, 0.1);
    verify_near({"mould_long", line, "force on the plate, of that when it stopped"}, 1,
                found[3].force / found[1].force, 0.1);
  }
}

/// Glued by its end alone, a beam hangs on the particles of the outermost layer, which stay a
/// quarter of a cell from the wall: it is shorter by that, which is half as much in cells of half
/// the size. (It still swings: a twentieth of what is missing.)
TEST(CantileverLong, ABeamGluedFaceToFaceApproachesTheExactSag) {
  Beam coarse, fine;
  coarse.root = fine.root = 0;
  fine.cell_size = coarse.cell_size / 2;
  const auto missing = [](const Beam& beam) { return 1 - sags(beam, {1.2})[0] / beam.sag(); };
  const double before = missing(coarse), after = missing(fine);
  const std::string line = "glued to the wall, cells of a twentieth of its length";
  // A beam that is shorter by a quarter of a cell sags 0.95 times as far.
  verify_near({"cantilever", line, "sag of the last cell, of the exact one"}, 1, 1 - after, 0.05);
  verify_near({"cantilever", line, "what is missing of it, of that in cells of a tenth"}, 0.5,
              after / before, 0.1);
}

/// N, the largest mean over a frame of what the boot of scenes/boot_print.toml feels from below.
double peak_of_boot(int passes) {
  SolverSettings s;
  s.cell_size = 0.025;
  s.push_out = true;
  s.contact_passes = passes;
  Material snow;
  snow.density = 250;
  snow.youngs_modulus = 6e4;
  snow.critical_compression = 0.02;
  snow.critical_stretch = 0.006;
  snow.hardening = 3;
  ParticleArrays p = box_of_snow({-0.24, 0.0005, -0.15}, {0.24, 0.1005, 0.15}, 0.5 * s.cell_size);
  for (double& m : p.m) m *= snow.density / 400;
  shapes::Collider boot;
  boot.shape.form =
      shapes::Mesh{std::string(NEVE_SOURCE_DIR) + "/scenes/meshes/boot.obj", 1, {-0.01, 0.125, 0}};
  boot.shape.rotation = {0, 0, 6};
  boot.friction = 0.2;
  boot.keyframes = {{0, std::nullopt, std::nullopt},
                    {0.45, Vec3d(-0.01, 0.052, 0), Vec3d(0, 0, 0)},
                    {0.6, Vec3d(-0.01, 0.052, 0), Vec3d(0, 0, 0)}};
  Simulation simulation(s, {snow}, {plane({0, 0, 0}, {0, 1, 0}, 0.8), boot}, p, 2);
  const double fps = 24;
  double peak = 0;
  for (int k = 1; k <= 14; ++k)
    peak = std::max(peak, simulation.advance_to(k / fps).loads.at(1).impulse[1] * fps);
  EXPECT_FALSE(simulation.divergence()) << simulation.divergence()->sentence;
  return peak;
}

/// Two passes had 0.78 of the force when they began from scratch in every step.
TEST(BootLong, ABootPressesAsWithManyPasses) {
  verify_ratio({"boot", "two passes, expected: 32", "largest force in a frame, N"},
               peak_of_boot(32), peak_of_boot(2), 0.03);
}

}  // namespace

/// Contact that holds a load for as long as it lasts: a mould, beams on a wall, snow seeded against
/// surfaces.

#include "tests/support/mould.h"
#include "tests/support/verification.h"

namespace {

using namespace neve::sim;
using namespace neve::test;

/// Snow of four cells, pressed to 0.6 of its height. Without walls that hold what they are given,
/// it is packed less, or loses its stress while the plate rests.
TEST(Mould, SnowCarriesTheStressOfItsStrainAndKeepsIt) {
  for (Mould mould : moulds()) {
    mould.cells = 4;
    const UniaxialState exact = uniaxial_formula(mould.snow, mould.stretch);
    const std::vector<Pressed> found = run_mould(mould, {mould.seconds, mould.seconds + 0.2});
    const std::string line = in_words(mould.settings);
    // The outermost of eight particles a line gives way by a twentieth of a cell.
    verify_near({"mould", line, "J_P when the plate stops"}, exact.J_P, found[0].J_P, 0.01);
    // A hundredth of J_P is a tenth of the stress: e^(10 (1 - J_P)).
    verify_ratio({"mould", line, "stress when the plate stops, kPa"}, exact.sigma / 1e3,
                 found[0].sigma / 1e3, 0.12);
    verify_ratio({"mould", line, "stress 0.2 s later, kPa"}, found[0].sigma / 1e3,
                 found[1].sigma / 1e3, 0.05);
  }
}

/// An elastic beam of 0.3 m, four cells thick, that sticks out from a sticky wall.
struct Beam {
  double root = 0.06;  ///< m inside the wall; 0: only its end is glued to it
  double length = 0.3, thickness = 0.12, density = 400, youngs_modulus = 5e5;

  /// By Timoshenko: bending and shear of a square section (shear factor 5/6), nu = 0.
  double sag() const {
    const double T2 = thickness * thickness, q = density * 9.81 * T2, L2 = length * length;
    const double bending = q * L2 * L2 / (8 * youngs_modulus * T2 * T2 / 12);
    return bending + q * L2 / (2 * 5.0 / 6 * youngs_modulus / 2 * T2);
  }
};

/// Sag of the last cell of the beam at each of some times, m.
std::vector<double> sags(const Beam& beam, const std::vector<double>& times) {
  SolverSettings s;
  s.cell_size = 0.03;
  s.transfer = Transfer::flip;
  s.flip_ratio = 0.5;  // at rest soon
  const double half = beam.thickness / 2;
  const int across = 8, along = static_cast<int>(std::lround((beam.length + beam.root) / 0.015));
  const ParticleArrays p = lattice({-beam.root, -half, -half}, {beam.length, half, half},
                                   {along, across, across}, beam.density);
  Simulation simulation(s, {elastic(beam.youngs_modulus, 0, beam.density)},
                        {plane({0, 0, 0}, {1, 0, 0}, 0, shapes::Contact::sticky)}, p, 1);
  std::vector<double> found;
  for (const double time : times) {
    simulation.advance_to(time);
    const ParticleArrays now = simulation.particles();
    double sag = 0, count = 0;
    for (std::size_t q = 0; q < p.x.size(); ++q) {
      if (p.x[q][0] < beam.length - s.cell_size) continue;
      sag += p.x[q][1] - now.x[q][1];
      ++count;
    }
    found.push_back(sag / count);
  }
  return found;
}

TEST(Cantilever, ABeamSagsByItsWeightAndStays) {
  const Beam beam;
  const std::vector<double> found = sags(beam, {0.6, 1.1});
  // Splines round off where it is clamped, at the edge of the wall.
  verify_ratio({"cantilever", "in the wall", "sag of the tip, mm"}, 1e3 * beam.sag(),
               1e3 * found[0], 0.15);
  verify_near({"cantilever", "in the wall", "creep in the half second after, mm"}, 0,
              1e3 * (found[1] - found[0]), 0.25);
}

/// The layer of particles at the wall holds it, and the cell beside them bends.
TEST(Cantilever, ABeamGluedFaceToFaceHolds) {
  Beam beam;
  beam.root = 0;
  const std::vector<double> found = sags(beam, {0.6, 1.1});
  verify_at_most({"cantilever", "glued to the wall", "sag of the tip, of the exact one"}, 2,
                 found[0] / beam.sag());
  verify_near({"cantilever", "glued to the wall", "creep in the half second after, mm"}, 0,
              1e3 * (found[1] - found[0]), 0.25);
}

/// Seeded particles lie up to half their spacing from where the body ends, most of them nearer than
/// snow comes to a surface: they are not pushed away.
TEST(SeededContact, BodiesSeededOnASurfaceStayWhereTheyAre) {
  SolverSettings s;
  s.cell_size = 0.02;
  const Vec3d low{0.003, 0.004, 0.005}, high = low + Vec3d(0.1, 0.1, 0.1);
  const ParticleArrays p = box_of_snow(low, high, 0.01);
  const shapes::Collider floor = plane(low, {0, 1, 0}, 0.5);
  Simulation on_floor(s, {Material{}}, {floor}, p, 1);
  const double before = on_floor.summary().centre_of_mass[1];
  on_floor.advance_to(0.2);
  // The weight of five cells strains them by 2e-3.
  verify_near({"seeded contact", "block on a floor", "rise of its centre in 0.2 s, cells"}, 0,
              (on_floor.summary().centre_of_mass[1] - before) / s.cell_size, 0.02);

  s.gravity.setZero();
  Simulation between(s, {Material{}}, {floor, plane(high, {0, -1, 0}, 0.5)}, p, 1);
  between.advance_to(0.2);
  // Squeezed by a hundredth of a cell on each side it would store 3e-4 J.
  verify_at_most({"seeded contact", "block between two plates", "elastic energy after 0.2 s, J"},
                 1e-6, between.summary().elastic_energy);
}

}  // namespace

/// Mass, centre and inertia of bodies against sums over points and parts.

#include <gtest/gtest.h>

#include <array>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "sim/shapes/solid.h"
#include "tests/support/bodies.h"
#include "tests/support/meshes.h"
#include "tests/support/temporary_folder.h"

namespace {

using namespace neve::sim;
using namespace neve::test;

/// Mass, centre and inertia summed over a lattice of points inside.
rigid::MassProperties counted_mass(const shapes::Shape& shape) {
  const shapes::Solid solid(shape);
  const shapes::Bounds box = solid.local_bounds();
  constexpr int n = 80;
  const Vec3d step = (box.max - box.min) / n;
  double count = 0;
  Vec3d first = Vec3d::Zero();
  Mat3d second = Mat3d::Zero();
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      for (int k = 0; k < n; ++k) {
        const Vec3d y = box.min + step.cwiseProduct(Vec3d(i + 0.5, j + 0.5, k + 0.5));
        if (!solid.contains_local(y)) continue;
        ++count;
        first += y;
        second += y * y.transpose();
      }
  const double part = step.prod();
  const Vec3d centre = first / count;
  const Mat3d about = part * (second - count * centre * centre.transpose());
  return {part * count, centre, about.trace() * Mat3d::Identity() - about};
}

TEST(RigidMass, OfEveryFormIsThatOfItsPoints) {
  const std::vector<shapes::Shape> all = {{shapes::Sphere{{1, 2, 3}, 0.3}, {}},
                                          {shapes::Box{{1, 2, 3}, {0.2, 0.5, 0.9}}, {}},
                                          {shapes::Capsule{{0, 0, 0}, {0, 0.4, 0}, 0.1}, {}},
                                          {shapes::Cylinder{{1, 2, 3}, 0.2, 0.5}, {}},
                                          {shapes::Cone{{1, 2, 3}, 0.3, 0.5}, {}},
                                          {shapes::Torus{{1, 2, 3}, 0.3, 0.1}, {}}};
  for (const shapes::Shape& shape : all) {
    SCOPED_TRACE(shape.form.index());
    const rigid::MassProperties exact = rigid::mass_properties(shape, 1),
                                found = counted_mass(shape);
    // A lattice of 80 points a side.
    EXPECT_NEAR(found.mass / exact.mass, 1, 5e-3);
    EXPECT_LE((found.centre - exact.centre).norm(), 2e-3);
    EXPECT_LE((found.inertia - exact.inertia).norm(), 1e-2 * exact.inertia.norm());
  }
}

/// A box of triangles, far from the origin of its file and turned in it.
TEST(RigidMass, OfAMeshIsThatOfItsPolyhedron) {
  const TemporaryFolder folder;
  const Vec3d size(0.2, 0.5, 0.9), at(10, -20, 30);
  const Mat3d turned = rotation_from_degrees({20, 30, 40});
  const std::string file = (folder.path() / "box.obj").string();
  std::ofstream out(file);
  for (int k = 0; k < 8; ++k) {
    const Vec3d corner(k & 1 ? 0.5 : -0.5, k & 2 ? 0.5 : -0.5, k & 4 ? 0.5 : -0.5);
    out << "v " << (at + turned * corner.cwiseProduct(size)).transpose() << '\n';
  }
  for (const char* face : {"1 3 4 2", "5 6 8 7", "1 2 6 5", "3 7 8 4", "1 5 7 3", "2 4 8 6"})
    out << "f " << face << '\n';
  out.close();
  const rigid::MassProperties box = rigid::mass_properties({shapes::Box{{0, 0, 0}, size}, {}}, 400);
  const rigid::MassProperties mesh = rigid::mass_properties({shapes::Mesh{file}, {}}, 400);
  // Six digits in the file, of numbers up to 30.
  EXPECT_NEAR(mesh.mass / box.mass, 1, 1e-3);
  EXPECT_LE((mesh.centre - at).norm(), 1e-3);
  EXPECT_LE((mesh.inertia - turned * box.inertia * turned.transpose()).norm(),
            3e-3 * box.inertia.norm());
}

/// A part of a mesh: a box, and how often it counts in what is filled.
struct BoxPart {
  Vec3d centre, size;
  double times = 1;
  bool is_inward = false, is_open = false;
};

std::string boxes_obj(const std::vector<BoxPart>& parts) {
  std::ostringstream text;
  text.precision(17);
  const std::array<std::array<int, 4>, 6> faces{
      {{1, 3, 4, 2}, {5, 6, 8, 7}, {1, 2, 6, 5}, {3, 7, 8, 4}, {1, 5, 7, 3}, {2, 4, 8, 6}}};
  for (std::size_t p = 0; p < parts.size(); ++p) {
    for (int k = 0; k < 8; ++k) {
      const Vec3d corner(k & 1 ? 0.5 : -0.5, k & 2 ? 0.5 : -0.5, k & 4 ? 0.5 : -0.5);
      text << "v " << (parts[p].centre + corner.cwiseProduct(parts[p].size)).transpose() << '\n';
    }
    for (std::size_t f = parts[p].is_open ? 1 : 0; f < faces.size(); ++f) {
      text << 'f';
      for (std::size_t c = 0; c < 4; ++c)
        text << ' ' << 8 * static_cast<int>(p) + faces[f][parts[p].is_inward ? 3 - c : c];
      text << '\n';
    }
  }
  return text.str();
}

/// Returns the mass properties of boxes added up and taken away.
rigid::MassProperties sum_of(const std::vector<BoxPart>& parts, double density) {
  rigid::MassProperties out;
  out.inertia = Mat3d::Zero();
  std::vector<rigid::MassProperties> each;
  for (const BoxPart& part : parts) {
    each.push_back(rigid::mass_properties({shapes::Box{{0, 0, 0}, part.size}, {}}, density));
    out.mass += part.times * each.back().mass;
    out.centre += part.times * each.back().mass * part.centre;
  }
  out.centre /= out.mass;
  for (std::size_t p = 0; p < parts.size(); ++p) {
    const Vec3d arm = parts[p].centre - out.centre;
    out.inertia += parts[p].times *
                   (each[p].inertia +
                    each[p].mass * (arm.squaredNorm() * Mat3d::Identity() - arm * arm.transpose()));
  }
  return out;
}

void expect_mass_of(const std::vector<BoxPart>& parts, shapes::Fill fill, double relative) {
  const TemporaryFolder folder;
  shapes::Mesh mesh;
  mesh.file = folder.write("parts.obj", boxes_obj(parts)).string();
  mesh.fill = fill;
  mesh.scale = 0.5;
  std::vector<BoxPart> scaled = parts;
  for (BoxPart& part : scaled) part.centre *= mesh.scale, part.size *= mesh.scale;
  const rigid::MassProperties found = rigid::mass_properties({mesh, {}}, 100),
                              exact = sum_of(scaled, 100);
  EXPECT_NEAR(found.mass / exact.mass, 1, relative);
  // Sizes of the parts are about 1 in the units of the file.
  EXPECT_LE((found.centre - exact.centre).norm(), mesh.scale * relative);
  EXPECT_LE((found.inertia - exact.inertia).norm(), relative * exact.inertia.norm());
}

/// Their faces alone say it to rounding: hundreds of sums of numbers of about 1.
TEST(RigidMass, OfPartsInOneAnotherIsThatOfWhatIsFilled) {
  constexpr double rounding = 1e-13;
  const BoxPart cube{{0, 0, 0}, {1, 1, 1}};
  const auto inner = [](double x, double size, double times, bool is_inward = false) {
    return BoxPart{{x, 0, 0}, {size, size, size}, times, is_inward};
  };
  using shapes::Fill;
  for (const bool is_inward : {false, true}) {
    SCOPED_TRACE(is_inward ? "wound inward" : "wound outward");
    // Shells that are solid and empty in turns, however they are wound.
    expect_mass_of({cube, inner(0, 0.7, -1, is_inward)}, Fill::even_odd, rounding);
    expect_mass_of({cube, inner(0.1, 0.7, -1, is_inward)}, Fill::even_odd, rounding);
    expect_mass_of({cube, inner(0.1, 0.7, -1, is_inward), inner(0.15, 0.5, 1)}, Fill::even_odd,
                   rounding);
    // A cavity if it is wound inward, else filled already.
    for (const Fill fill : {Fill::automatic, Fill::closed})
      expect_mass_of({cube, inner(0.1, 0.7, is_inward ? -1 : 0, is_inward)}, fill, rounding);
    // Wound inward in what is filled twice, it is filled once.
    expect_mass_of({cube, inner(0.1, 0.7, 0), inner(0.15, 0.5, 0, is_inward)}, Fill::automatic,
                   rounding);
  }
  // A body beside them.
  expect_mass_of({cube, inner(0.1, 0.7, 0), inner(2, 0.8, 1)}, Fill::automatic, rounding);
}

/// Parts that cross are measured by 65536 lines: a line that counts as inside of the overlap or not
/// is one of many along its edge, which is the square root of the lines long: 1e-3 of an overlap
/// that is smaller than the whole.
TEST(RigidMass, OfPartsThatCrossIsThatOfWhatIsFilled) {
  const BoxPart left{{0, 0, 0}, {1, 0.8, 0.6}}, right{{0.6, 0.3, 0.2}, {0.7, 0.9, 0.5}};
  const Vec3d low = (left.centre - 0.5 * left.size).cwiseMax(right.centre - 0.5 * right.size),
              high = (left.centre + 0.5 * left.size).cwiseMin(right.centre + 0.5 * right.size);
  BoxPart both{0.5 * (low + high), high - low, -1, true};
  // The mesh has no such part: it is made of the first two alone.
  const auto expect = [&](shapes::Fill fill, double times) {
    const TemporaryFolder folder;
    both.times = times;
    shapes::Mesh mesh;
    mesh.file = folder.write("crossed.obj", boxes_obj({left, right})).string();
    mesh.fill = fill;
    const rigid::MassProperties found = rigid::mass_properties({mesh, {}}, 100),
                                exact = sum_of({left, right, both}, 100);
    EXPECT_NEAR(found.mass / exact.mass, 1, 1e-3);
    EXPECT_LE((found.centre - exact.centre).norm(), 1e-3);
    EXPECT_LE((found.inertia - exact.inertia).norm(), 1e-3 * exact.inertia.norm());
  };
  expect(shapes::Fill::automatic, -1);
  expect(shapes::Fill::even_odd, -2);
}

/// Measured by 32768 samples. Their sequence has products of inertia itself, up to 1.5 % of the
/// second moments of their box: 0.8 % of its inertia.
TEST(RigidMass, OfAMeshFilledByWindingNumbersIsThatOfItsSamples) {
  expect_mass_of({{{0, 0, 0}, {1, 1, 1}}, {{0.1, 0, 0}, {0.7, 0.7, 0.7}, 0}}, shapes::Fill::winding,
                 1e-2);
  // One face is missing. The places with a number above 1/2, seen from the hole, are not the whole
  // box: what is filled lies on the far side of it.
  const TemporaryFolder folder;
  BoxPart open{{0.3, 0.2, 0.1}, {1, 1, 1}};
  open.is_open = true;
  shapes::Mesh mesh;
  mesh.file = folder.write("open.obj", boxes_obj({open})).string();
  const rigid::MassProperties found = rigid::mass_properties({mesh, {}}, 1),
                              counted = counted_mass({mesh, {}});
  EXPECT_NEAR(found.mass / counted.mass, 1, 5e-3);
  EXPECT_LE((found.centre - counted.centre).norm(), 5e-3);
  EXPECT_LE((found.inertia - counted.inertia).norm(), 1e-2 * counted.inertia.norm());
}

}  // namespace

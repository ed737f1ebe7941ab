#pragma once
/// OBJ texts of closed meshes.

#include <cmath>
#include <numbers>
#include <sstream>
#include <string>
#include <utility>

#include "sim/shapes/shape.h"
#include "tests/support/temporary_folder.h"

namespace neve::test {

/// A box of quads about the origin, turned.
inline std::string box_obj(const sim::Vec3d& size,
                           const sim::Mat3d& rotation = sim::Mat3d::Identity()) {
  std::ostringstream text;
  text.precision(17);
  for (int k = 0; k < 8; ++k) {
    const sim::Vec3d corner(k & 1 ? 0.5 : -0.5, k & 2 ? 0.5 : -0.5, k & 4 ? 0.5 : -0.5);
    const sim::Vec3d x = rotation * corner.cwiseProduct(size);
    text << "v " << x[0] << ' ' << x[1] << ' ' << x[2] << '\n';
  }
  text << "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n";
  return text.str();
}

/// A ball about the origin; its faces are inside of the sphere by at most radius (pi / rings)^2 / 2
/// or so.
inline std::string ball_obj(double radius, int rings) {
  const int around = 2 * rings;
  std::ostringstream text;
  text.precision(17);
  text << "v 0 " << radius << " 0\n";
  for (int i = 1; i < rings; ++i)
    for (int j = 0; j < around; ++j) {
      const double polar = std::numbers::pi * i / rings, turn = 2 * std::numbers::pi * j / around;
      text << "v " << radius * std::sin(polar) * std::cos(turn) << ' ' << radius * std::cos(polar)
           << ' ' << radius * std::sin(polar) * std::sin(turn) << '\n';
    }
  text << "v 0 " << -radius << " 0\n";
  const auto at = [&](int i, int j) { return 2 + (i - 1) * around + j % around; };
  const int last = 2 + (rings - 1) * around;
  for (int j = 0; j < around; ++j) {
    text << "f 1 " << at(1, j + 1) << ' ' << at(1, j) << '\n';
    for (int i = 1; i + 1 < rings; ++i)
      text << "f " << at(i, j) << ' ' << at(i, j + 1) << ' ' << at(i + 1, j + 1) << ' '
           << at(i + 1, j) << '\n';
    text << "f " << last << ' ' << at(rings - 1, j) << ' ' << at(rings - 1, j + 1) << '\n';
  }
  return text.str();
}

/// A plate of quads about the origin, cut into parts along x. @param way  way(x): moves the plate
/// there, m
template <class Way>
std::string plate_obj(const sim::Vec3d& size, int parts, const Way& way) {
  std::ostringstream text;
  text.precision(17);
  const auto vertex = [&](double x, double y, double z) {
    const sim::Vec3d at = sim::Vec3d(x, y, z) + way(x);
    text << "v " << at[0] << ' ' << at[1] << ' ' << at[2] << '\n';
  };
  for (int i = 0; i <= parts; ++i) {
    const double x = size[0] * (static_cast<double>(i) / parts - 0.5);
    for (const auto& [y, z] : {std::pair{-0.5, -0.5}, {0.5, -0.5}, {0.5, 0.5}, {-0.5, 0.5}})
      vertex(x, y * size[1], z * size[2]);
  }
  const auto at = [](int i, int c) { return 4 * i + c % 4 + 1; };
  for (int i = 0; i < parts; ++i)
    for (int c = 0; c < 4; ++c)
      text << "f " << at(i, c) << ' ' << at(i, c + 1) << ' ' << at(i + 1, c + 1) << ' '
           << at(i + 1, c) << '\n';
  text << "f 4 3 2 1\nf " << at(parts, 0) << ' ' << at(parts, 1) << ' ' << at(parts, 2) << ' '
       << at(parts, 3) << '\n';
  return text.str();
}

/// Writes numbered files: text(k) for k = 0, 1, ... into NAME_000k.obj, first number 0.
template <class Text>
sim::shapes::MeshSequence written_sequence(const TemporaryFolder& folder, const std::string& name,
                                           int count, double rate, const Text& text) {
  for (int k = 0; k < count; ++k) {
    std::string digits = std::to_string(k);
    digits.insert(0, 4 - digits.size(), '0');
    folder.write(name + "_" + digits + ".obj", text(k));
  }
  sim::shapes::MeshSequence sequence;
  sequence.files = (folder / (name + "_%04d.obj")).string();
  sequence.first = 0;
  sequence.last = count - 1;
  sequence.rate = rate;
  return sequence;
}

}  // namespace neve::test

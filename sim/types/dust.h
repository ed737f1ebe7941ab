#pragma once
/// Dust of snow: parameters of the air that carries it, and what a simulation tells of it. Dust is
/// decoration: the snow keeps its mass.

#include <cstdint>
#include <vector>

#include "sim/types/math.h"

namespace neve::sim {

/// Snow sheds dust where it is fast in still air, strained fast and not packed; see Material::dust.
struct DustSettings {
  double speed = 1.5;           ///< m/s, relative to the wind: no dust below, all of it at twice
  double strain_rate = 5;       ///< 1/s, |sym grad v|: no dust below, all of it at twice
  double min_J_P = 0.8;         ///< snow packed further sheds none
  double settling_speed = 0.2;  ///< m/s, of dust in still air
  double buoyancy = 0;          ///< of dusty air, in weights of its dust; -1: it sinks by it
  double diffusion = 0.02;      ///< m2/s
  double turbulence = 0.3;      ///< gusts that the grid does not see, as a share of the air's speed
  Vec3d wind{0, 0, 0};          ///< m/s, of the air far away
  double life = 10;             ///< s, mean, of dust that does not settle; 0: for ever
  double air_cell = 3;          ///< cells of the snow's grid in one of the air's, along an axis
  int particles = 100'000;      ///< of dust, at most
  double spray_drag = 0;        ///< 1/m, k in dv/dt = k |u - v| (u - v) of loose snow; 0: none

  bool operator==(const DustSettings&) const = default;
};

/// Dust that there has been: born = airborne + settled + faded, in number and in mass.
struct DustTotals {
  std::uint64_t born = 0, settled = 0, faded = 0;
  double born_mass = 0, settled_mass = 0, faded_mass = 0;  ///< kg

  std::uint64_t airborne() const { return born - settled - faded; }
  double airborne_mass() const { return born_mass - settled_mass - faded_mass; }
};

/// Dust in the air, in the order of birth.
struct DustArrays {
  std::vector<Vec3d> x;     ///< m, measured from the lattice origin
  std::vector<Vec3d> v;     ///< m/s
  std::vector<double> m;    ///< kg
  std::vector<double> age;  ///< s
  std::vector<std::uint64_t> id;
  DustTotals totals;
  double air_spacing = 0;  ///< m, between nodes of the air; 0: dust is off
};

}  // namespace neve::sim

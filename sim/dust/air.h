#pragma once
/// The air around moving snow: an incompressible flow on a coarse staggered grid that snow drags
/// along, that goes around colliders, and that is still, or the wind, far away.
/// Source: Stam, Stable Fluids (1999); Bridson, Fluid Simulation for Computer Graphics, chapters 3
/// to 5.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "sim/base/thread_pool.h"
#include "sim/dust/air_box.h"
#include "sim/dust/chess_field.h"
#include "sim/dust/snow_grain.h"
#include "sim/dust/solids.h"
#include "sim/types/dust.h"

namespace neve::sim::dust {

/// Component a of the velocity lies in the middle of the lower face of a cell along axis a.
using FaceVelocities = std::array<std::vector<float>, 3>;

/// Memory for a cell in all fields of Air.
inline constexpr double bytes_of_air_cell = 4 * 18 + 8 * 5;

class Air {
 public:
  /// Takes a box: what both boxes hold of the air stays, the rest is wind.
  void cover(const AirBox& box, const Vec3d& wind);
  /// Snow in the box, and the solids around it, as they are now.
  void see(std::span<const SnowGrain> snow, const Solids& solids, ThreadPool& pool);
  /// One step. @param lift  m/s2 upward per cell, or empty; see lift_of
  void step(double dt, const Vec3d& wind, const Vec3d& up, std::span<const float> lift,
            ThreadPool& pool);

  const AirBox& box() const { return box_; }
  /// Returns the velocity at a place in m, m/s; the wind outside the box.
  Vec3d velocity(const Vec3d& x, const Vec3d& wind) const;
  /// Share of the cell around a place that is packed snow; 0 outside the box.
  double fill(const Vec3d& x) const;
  /// Returns the norm of the strain rate of snow in the cell around a place, 1/s; 0 outside.
  double strain_rate(const Vec3d& x) const;
  /// Returns the velocity of the snow in the cell around a place, m/s; 0 outside.
  Vec3d snow_velocity(const Vec3d& x) const;
  /// True if a solid may be within a cell of a place. Also outside the box.
  bool is_near_solid(const Vec3d& x) const;
  /// Returns the speed of the fastest air along an axis, m/s.
  double largest_speed() const;

  /// The next see() looks at the solids anew: their shapes have changed, which no pose tells.
  void forget_solids() { solids_key_ = 0; }

  const FaceVelocities& faces() const { return u_; }
  void restore(const AirBox& box, FaceVelocities faces);
  std::size_t memory_bytes() const;

 private:
  void see_solids(const Solids& solids, ThreadPool& pool);
  void see_snow(std::span<const SnowGrain> snow, ThreadPool& pool);
  void advect(double dt, const Vec3d& wind, ThreadPool& pool);
  void advect_row(int j, int k, double cells, const Vec3d& wind);
  void find_row_speeds(ThreadPool& pool);
  float fastest_around(int j, int k) const;
  void push(double dt, const Vec3d& up, std::span<const float> lift, ThreadPool& pool);
  void hold_at_solids(ThreadPool& pool);
  void project(ThreadPool& pool);
  void relax(int color, ThreadPool& pool);
  void push_by_pressure(int i, int j, int k);
  /// True if a cell has this place as its lower face along axis a, or would have it beyond the end.
  bool is_face(int a, int i, int j, int k) const {
    const Vec3i at(i, j, k);
    const int b = (a + 1) % 3, c = (a + 2) % 3;
    return at[b] < box_.size[b] && at[c] < box_.size[c];
  }
  Vec3d velocity_at_face(int a, int i, int j, int k) const;
  bool is_solid(std::size_t n) const { return !distance_.empty() && distance_[n] < 0; }
  /// body(i, j, k) for every cell, slabs on all threads.
  template <class Body>
  void each_cell(ThreadPool& pool, const Body& body) const;
  /// Index of the cell around a place; the number of places outside the box.
  std::size_t cell_of(const Vec3d& x) const;

  AirBox box_;
  FaceVelocities u_, next_;
  ChessField pressure_, divergence_, per_open_;  ///< the last: 1 / its neighbours, 0 in solids
  std::vector<float> fill_, strain_;             ///< per cell
  std::array<std::vector<float>, 3> snow_v_;     ///< per cell, m/s
  /// Mass, volume and momentum of the snow of a cell, in whole numbers of units: see see_snow.
  using SnowSum = std::array<std::int64_t, 5>;
  std::vector<SnowSum> sums_;
  /// Largest speed along an axis in each row of faces along x; see advect.
  std::vector<float> row_speed_;
  /// Distance of the middle of a cell to a solid, m; NaN: not looked at. Empty: none.
  std::vector<float> distance_;
  std::array<std::vector<float>, 3> solid_v_;  ///< per cell, m/s
  std::uint64_t solids_key_ = 0;
  bool has_unseen_ = false;  ///< cells of which the solids are not known
  bool has_solids_ = false;
};

}  // namespace neve::sim::dust

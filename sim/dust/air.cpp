#include "sim/dust/air.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace neve::sim::dust {

namespace {

/// Drag of packed snow on the air of its cell: in the time in which it crosses the cell, e^-drag of
/// the difference is left.
constexpr double snow_drag = 10;
/// Sweeps of successive over-relaxation from a pressure of 0, and its factor.
constexpr int pressure_sweeps = 24;
/// Air that moves less far in a step stays as it is, cells.
constexpr double still = 0.01;
constexpr float over_relaxation = 1.7f;

/// False for particles of a run that continues after it diverged: they have no part in the sums.
bool is_sound(const SnowGrain& grain) {
  constexpr double fastest = 1e6;  // m/s
  return grain.x.allFinite() && grain.v.cwiseAbs().maxCoeff() < fastest && grain.v.allFinite();
}

/// Interpolates a field whose first value lies at `offset` cells from the lower corner.
double sample(const AirBox& box, const std::vector<float>& field, const Vec3d& place,
              const Vec3d& offset, const Vec3i& last) {
  int at[3];
  double part[3];
  for (int a = 0; a < 3; ++a) {
    const double q = std::clamp(place[a] - offset[a], 0.0, static_cast<double>(last[a]));
    at[a] = std::min(static_cast<int>(q), std::max(last[a] - 1, 0));
    part[a] = last[a] > 0 ? q - at[a] : 0;
  }
  const std::size_t n = box.index(at[0], at[1], at[2]);
  const std::size_t sx = last[0] > 0 ? 1 : 0, sy = last[1] > 0 ? box.step(1) : 0,
                    sz = last[2] > 0 ? box.step(2) : 0;
  const auto value = [&](std::size_t m) { return static_cast<double>(field[m]); };
  const auto along_x = [&](std::size_t m) {
    return value(m) + part[0] * (value(m + sx) - value(m));
  };
  const auto along_y = [&](std::size_t m) {
    const double low = along_x(m);
    return low + part[1] * (along_x(m + sy) - low);
  };
  const double low = along_y(n);
  return low + part[2] * (along_y(n + sz) - low);
}

/// Returns the place of component a in a cell; last_face() returns the last one along each axis.
Vec3d face_offset(int a) {
  Vec3d offset(0.5, 0.5, 0.5);
  offset[a] = 0;
  return offset;
}
Vec3i last_face(const AirBox& box, int a) {
  Vec3i last = box.size - Vec3i::Ones();
  last[a] += 1;
  return last;
}

/// @param place  inside the box, in cells
Vec3d velocity_in(const AirBox& box, const FaceVelocities& u, const Vec3d& place) {
  Vec3d v;
  for (int a = 0; a < 3; ++a)
    v[a] = sample(box, u[static_cast<std::size_t>(a)], place, face_offset(a), last_face(box, a));
  return v;
}

}  // namespace

template <class Body>
void Air::each_cell(ThreadPool& pool, const Body& body) const {
  pool.ranges(static_cast<std::size_t>(box_.size.z()), pool.thread_count(),
              [&](std::size_t begin, std::size_t end) {
                for (int k = static_cast<int>(begin); k < static_cast<int>(end); ++k)
                  for (int j = 0; j < box_.size.y(); ++j)
                    for (int i = 0; i < box_.size.x(); ++i) body(i, j, k);
              });
}

void Air::cover(const AirBox& box, const Vec3d& wind) {
  if (box == box_ && u_[0].size() == box.count()) return;
  FaceVelocities u;
  for (std::size_t a = 0; a < 3; ++a)
    u[a].assign(box.count(), static_cast<float>(wind[static_cast<int>(a)]));
  const bool is_same_grid = !box_.is_empty() && !box.is_empty() && box_.spacing == box.spacing;
  const bool has_solids = is_same_grid && distance_.size() == box_.count();
  std::vector<float> distance;
  std::array<std::vector<float>, 3> solid_v;
  if (has_solids) {
    distance.assign(box.count(), std::numeric_limits<float>::quiet_NaN());
    for (std::vector<float>& v : solid_v) v.assign(box.count(), 0);
  }
  const Vec3i shift = box.low - box_.low;
  for (int k = 0; is_same_grid && k <= box.size.z(); ++k)
    for (int j = 0; j <= box.size.y(); ++j)
      for (int i = 0; i <= box.size.x(); ++i) {
        const Vec3i old = shift + Vec3i(i, j, k);
        if ((old.array() < 0).any() || (old.array() > box_.size.array()).any()) continue;
        const std::size_t from = box_.index(old.x(), old.y(), old.z()), to = box.index(i, j, k);
        for (std::size_t a = 0; a < 3; ++a) u[a][to] = u_[a][from];
        if (!has_solids || (old.array() == box_.size.array()).any()) continue;
        distance[to] = distance_[from];
        for (std::size_t a = 0; a < 3; ++a) solid_v[a][to] = solid_v_[a][from];
      }
  const std::uint64_t key = solids_key_;
  restore(box, std::move(u));
  if (!has_solids) return;
  solids_key_ = key;
  distance_ = std::move(distance);
  solid_v_ = std::move(solid_v);
  has_unseen_ = true;
}

void Air::restore(const AirBox& box, FaceVelocities faces) {
  box_ = box;
  u_ = std::move(faces);
  solids_key_ = 0;
  for (ChessField* field : {&pressure_, &divergence_, &per_open_}) field->assign(box);
  for (std::vector<float>* field : {&fill_, &strain_, &snow_v_[0], &snow_v_[1], &snow_v_[2]})
    field->assign(box.count(), 0);
  distance_.clear();
}

// ---- what is in the box -------------------------------------------------------------------------

void Air::see(std::span<const SnowGrain> snow, const Solids& solids, ThreadPool& pool) {
  see_solids(solids, pool);
  see_snow(snow, pool);
}

void Air::see_solids(const Solids& solids, ThreadPool& pool) {
  has_solids_ = !solids.are_none();
  if (!has_solids_) {
    distance_.clear();
    return;
  }
  const std::uint64_t key = solids.pose_key();
  const bool are_as_before = key != 0 && key == solids_key_ && distance_.size() == box_.count();
  if (are_as_before && !has_unseen_) return;
  solids_key_ = key;
  has_unseen_ = false;
  if (!are_as_before) {
    distance_.assign(box_.count(), std::numeric_limits<float>::quiet_NaN());
    for (std::vector<float>& v : solid_v_) v.assign(box_.count(), 0);
  }
  each_cell(pool, [&](int i, int j, int k) {
    const std::size_t n = box_.index(i, j, k);
    if (!std::isnan(distance_[n])) return;
    const Surface surface = solids.at(box_.middle(i, j, k));
    distance_[n] = static_cast<float>(std::min(surface.distance, 1e30));
    for (std::size_t a = 0; a < 3; ++a)
      solid_v_[a][n] = static_cast<float>(surface.velocity[static_cast<int>(a)]);
  });
}

/// Sums are whole numbers: the same in any order.
void Air::see_snow(std::span<const SnowGrain> snow, ThreadPool& pool) {
  double largest_mass = 0, largest_speed = 0, largest_volume = 0;
  for (const SnowGrain& grain : snow) {
    if (!is_sound(grain)) continue;
    largest_mass = std::max(largest_mass, grain.m);
    largest_volume = std::max(largest_volume, grain.volume);
    largest_speed = std::max(largest_speed, grain.v.cwiseAbs().maxCoeff());
  }
  constexpr double unit = 0x1p32;
  const double per_mass = largest_mass > 0 ? unit / largest_mass : 0;
  const double per_volume = largest_volume > 0 ? unit / largest_volume : 0;
  const double per_momentum = largest_speed > 0 ? per_mass / largest_speed : 0;
  sums_.assign(box_.count(), SnowSum{});
  for (const SnowGrain& grain : snow) {
    if (!is_sound(grain)) continue;
    const Vec3d q = box_.place(grain.x) - Vec3d::Constant(0.5);
    if (!((q.array() >= 0).all() && (q.array() < (box_.size.cast<double>().array() - 1)).all()))
      continue;
    const Vec3i at = q.cast<int>();
    const Vec3d part = q - at.cast<double>();
    for (int c = 0; c < 8; ++c) {
      const double w = (c & 1 ? part.x() : 1 - part.x()) * (c & 2 ? part.y() : 1 - part.y()) *
                       (c & 4 ? part.z() : 1 - part.z());
      const std::size_t n = box_.index(at.x() + (c & 1), at.y() + (c >> 1 & 1), at.z() + (c >> 2));
      SnowSum& sum = sums_[n];
      sum[0] += static_cast<std::int64_t>(w * grain.m * per_mass);
      sum[1] += static_cast<std::int64_t>(w * grain.volume * per_volume);
      for (int a = 0; a < 3; ++a)
        sum[static_cast<std::size_t>(a) + 2] +=
            static_cast<std::int64_t>(w * grain.m * grain.v[a] * per_momentum);
    }
  }
  const double cell = box_.spacing * box_.spacing * box_.spacing;
  each_cell(pool, [&](int i, int j, int k) {
    const std::size_t n = box_.index(i, j, k);
    const auto mass = static_cast<double>(sums_[n][0]);
    fill_[n] = per_volume > 0
                   ? static_cast<float>(static_cast<double>(sums_[n][1]) / (per_volume * cell))
                   : 0;
    for (std::size_t a = 0; a < 3; ++a)
      snow_v_[a][n] =
          mass > 0 ? static_cast<float>(static_cast<double>(sums_[n][a + 2]) * largest_speed / mass)
                   : 0;
  });
  // Strain rates count neighbours with snow alone: the edge of snow is no shear.
  each_cell(pool, [&](int i, int j, int k) {
    const std::size_t n = box_.index(i, j, k);
    if (!(fill_[n] > 0)) {
      strain_[n] = 0;
      return;
    }
    const int at[3] = {i, j, k};
    double grad[3][3] = {};
    for (int b = 0; b < 3; ++b) {
      const std::size_t s = box_.step(b);
      const bool has_low = at[b] > 0 && fill_[n - s] > 0,
                 has_high = at[b] + 1 < box_.size[b] && fill_[n + s] > 0;
      if (!has_low && !has_high) continue;
      const double width = box_.spacing * (has_low && has_high ? 2 : 1);
      for (std::size_t a = 0; a < 3; ++a)
        grad[a][b] = static_cast<double>(snow_v_[a][has_high ? n + s : n] -
                                         snow_v_[a][has_low ? n - s : n]) /
                     width;
    }
    double sum = 0;
    for (int a = 0; a < 3; ++a)
      for (int b = 0; b < 3; ++b)
        sum += 0.25 * (grad[a][b] + grad[b][a]) * (grad[a][b] + grad[b][a]);
    strain_[n] = static_cast<float>(std::sqrt(sum));
  });
}

// ---- the step -----------------------------------------------------------------------------------

void Air::step(double dt, const Vec3d& wind, const Vec3d& up, std::span<const float> lift,
               ThreadPool& pool) {
  if (box_.is_empty()) return;
  advect(dt, wind, pool);
  push(dt, up, lift, pool);
  hold_at_solids(pool);
  project(pool);
  hold_at_solids(pool);
}

/// The velocity at the face of component a: the others are means of the four faces around.
Vec3d Air::velocity_at_face(int a, int i, int j, int k) const {
  const int at[3] = {i, j, k};
  const std::size_t n = box_.index(i, j, k);
  // The cells on its two sides; at the ends of the box the one that there is.
  const std::size_t above = at[a] < box_.size[a] ? n : n - box_.step(a),
                    below = at[a] > 0 ? n - box_.step(a) : n;
  Vec3d v;
  for (int b = 0; b < 3; ++b) {
    const std::vector<float>& u = u_[static_cast<std::size_t>(b)];
    if (b == a) {
      v[b] = static_cast<double>(u[n]);
      continue;
    }
    const std::size_t high = box_.step(b);
    v[b] = 0.25 * static_cast<double>(u[above] + u[above + high] + u[below] + u[below + high]);
  }
  return v;
}

void Air::find_row_speeds(ThreadPool& pool) {
  const std::size_t row = box_.step(1), rows = row > 0 ? box_.count() / row : 0;
  row_speed_.resize(rows);
  pool.ranges(rows, pool.thread_count(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t r = begin; r < end; ++r) {
      float fastest = 0;
      for (const std::vector<float>& u : u_)
        for (std::size_t n = r * row; n < (r + 1) * row; ++n)
          fastest = std::max(fastest, std::abs(u[n]));
      row_speed_[r] = fastest;
    }
  });
}

/// Returns the largest speed in a row, and in the rows that speeds at its faces are means of.
float Air::fastest_around(int j, int k) const {
  const int rows = box_.size.y() + 1;
  float fastest = 0;
  for (int c = std::max(k - 1, 0); c <= std::min(k + 1, box_.size.z()); ++c)
    for (int b = std::max(j - 1, 0); b <= std::min(j + 1, box_.size.y()); ++b)
      fastest = std::max(fastest, row_speed_[static_cast<std::size_t>(c * rows + b)]);
  return fastest;
}

/// Carries velocities along the flow, which is followed backwards.
void Air::advect(double dt, const Vec3d& wind, ThreadPool& pool) {
  for (std::vector<float>& field : next_) field.resize(box_.count());
  const double cells = dt / box_.spacing;
  find_row_speeds(pool);
  pool.ranges(static_cast<std::size_t>(box_.size.z() + 1), pool.thread_count(),
              [&](std::size_t begin, std::size_t end) {
                for (int k = static_cast<int>(begin); k < static_cast<int>(end); ++k)
                  for (int j = 0; j <= box_.size.y(); ++j) advect_row(j, k, cells, wind);
              });
  std::swap(u_, next_);
}

/// @param cells  per m/s: how far air gets in the step
void Air::advect_row(int j, int k, double cells, const Vec3d& wind) {
  const std::size_t first = box_.index(0, j, k), row = box_.step(1);
  for (std::size_t a = 0; a < 3; ++a)
    std::copy_n(u_[a].begin() + static_cast<std::ptrdiff_t>(first), row,
                next_[a].begin() + static_cast<std::ptrdiff_t>(first));
  if (cells * static_cast<double>(fastest_around(j, k)) < still) return;
  const Vec3d size = box_.size.cast<double>();
  for (int i = 0; i <= box_.size.x(); ++i)
    for (int a = 0; a < 3; ++a) {
      if (!is_face(a, i, j, k)) continue;
      const Vec3d way = cells * velocity_at_face(a, i, j, k);
      if (way.cwiseAbs().maxCoeff() < still) continue;
      const Vec3d from = Vec3d(i, j, k) + face_offset(a) - way;
      const bool is_inside = (from.array() >= 0).all() && (from.array() <= size.array()).all();
      const auto axis = static_cast<std::size_t>(a);
      next_[axis][first + static_cast<std::size_t>(i)] = static_cast<float>(
          is_inside ? sample(box_, u_[axis], from, face_offset(a), last_face(box_, a)) : wind[a]);
    }
}

/// Snow drags the air along, by its density and the difference of velocities; dust lifts it.
void Air::push(double dt, const Vec3d& up, std::span<const float> lift, ThreadPool& pool) {
  each_cell(pool, [&](int i, int j, int k) {
    const int at[3] = {i, j, k};
    const std::size_t n = box_.index(i, j, k);
    for (int a = 0; a < 3; ++a) {
      if (at[a] == 0) continue;
      const auto axis = static_cast<std::size_t>(a);
      const std::size_t low = n - box_.step(a);
      double u = static_cast<double>(u_[axis][n]);
      if (!lift.empty()) u += dt * 0.5 * static_cast<double>(lift[n] + lift[low]) * up[a];
      const double fill_low = static_cast<double>(fill_[low]),
                   fill_high = static_cast<double>(fill_[n]), both = fill_low + fill_high;
      if (both > 0) {
        const double snow = (fill_low * static_cast<double>(snow_v_[axis][low]) +
                             fill_high * static_cast<double>(snow_v_[axis][n])) /
                            both;
        const double share = snow_drag * 0.5 * both * std::abs(snow - u) * dt / box_.spacing;
        u += (snow - u) * share / (1 + share);
      }
      u_[axis][n] = static_cast<float>(u);
    }
  });
}

/// Faces of solid cells move with the solid.
void Air::hold_at_solids(ThreadPool& pool) {
  if (!has_solids_ || distance_.empty()) return;
  each_cell(pool, [&](int i, int j, int k) {
    const int at[3] = {i, j, k};
    const std::size_t n = box_.index(i, j, k);
    for (int a = 0; a < 3; ++a) {
      const auto axis = static_cast<std::size_t>(a);
      const std::size_t low = n - (at[a] > 0 ? box_.step(a) : 0);
      if (is_solid(n))
        u_[axis][n] = solid_v_[axis][n];
      else if (is_solid(low))
        u_[axis][n] = solid_v_[axis][low];
      if (at[a] + 1 == box_.size[a] && is_solid(n)) u_[axis][n + box_.step(a)] = solid_v_[axis][n];
    }
  });
}

/// Makes the flow free of divergence. The pressure is 0 outside the box and in solids, which count
/// as no neighbours.
void Air::project(ThreadPool& pool) {
  pressure_.clear();
  each_cell(pool, [&](int i, int j, int k) {
    const int at[3] = {i, j, k};
    const std::size_t n = box_.index(i, j, k);
    float flow = 0, open = 0;
    for (int a = 0; !is_solid(n) && a < 3; ++a) {
      const std::size_t step = box_.step(a);
      const std::vector<float>& u = u_[static_cast<std::size_t>(a)];
      flow += u[n + step] - u[n];
      open += at[a] == 0 || !is_solid(n - step) ? 1.0f : 0.0f;
      open += at[a] + 1 == box_.size[a] || !is_solid(n + step) ? 1.0f : 0.0f;
    }
    divergence_.at(i, j, k) = flow;
    per_open_.at(i, j, k) = open > 0 ? 1 / open : 0;
  });
  for (int sweep = 0; sweep < pressure_sweeps; ++sweep)
    for (int color = 0; color < 2; ++color) relax(color, pool);
  pool.ranges(static_cast<std::size_t>(box_.size.z() + 1), pool.thread_count(),
              [&](std::size_t begin, std::size_t end) {
                for (int k = static_cast<int>(begin); k < static_cast<int>(end); ++k)
                  for (int j = 0; j <= box_.size.y(); ++j)
                    for (int i = 0; i <= box_.size.x(); ++i) push_by_pressure(i, j, k);
              });
}

/// The lower faces of a cell.
void Air::push_by_pressure(int i, int j, int k) {
  const int at[3] = {i, j, k};
  const std::size_t n = box_.index(i, j, k);
  for (int a = 0; a < 3; ++a) {
    if (!is_face(a, i, j, k)) continue;
    const bool has_low = at[a] > 0, has_high = at[a] < box_.size[a];
    if ((has_low && is_solid(n - box_.step(a))) || (has_high && is_solid(n))) continue;
    u_[static_cast<std::size_t>(a)][n] -=
        pressure_.at(i, j, k) - pressure_.at(i - (a == 0), j - (a == 1), k - (a == 2));
  }
}

/// One colour of a chess board reads the other alone: the same bits on any number of threads.
void Air::relax(int color, ThreadPool& pool) {
  const ChessField& field = pressure_;
  pool.ranges(static_cast<std::size_t>(box_.size.z()), pool.thread_count(),
              [&](std::size_t begin, std::size_t end) {
                for (int k = static_cast<int>(begin); k < static_cast<int>(end); ++k)
                  for (int j = 0; j < box_.size.y(); ++j) {
                    const int first = (j + k + color) & 1, other = 1 - color;
                    const int count = (box_.size.x() - first + 1) / 2;
                    float* __restrict p = pressure_.row(color, j, k);
                    const float *along = field.row(other, j, k) + first - 1,
                                *below = field.row(other, j - 1, k),
                                *above = field.row(other, j + 1, k),
                                *behind = field.row(other, j, k - 1),
                                *before = field.row(other, j, k + 1),
                                *divergence = divergence_.row(color, j, k),
                                *per_open = per_open_.row(color, j, k);
                    for (int m = 0; m < count; ++m) {
                      const float around =
                          along[m] + along[m + 1] + below[m] + above[m] + behind[m] + before[m];
                      p[m] += over_relaxation * ((around - divergence[m]) * per_open[m] - p[m]);
                    }
                  }
              });
}

// ---- what dust asks -----------------------------------------------------------------------------

Vec3d Air::velocity(const Vec3d& x, const Vec3d& wind) const {
  if (box_.is_empty()) return wind;
  const Vec3d place = box_.place(x);
  return box_.contains(place) ? velocity_in(box_, u_, place) : wind;
}

std::size_t Air::cell_of(const Vec3d& x) const {
  if (box_.is_empty()) return box_.count();
  const Vec3d place = box_.place(x);
  if (!box_.contains(place)) return box_.count();
  const Vec3i cell = place.cast<int>();
  return box_.index(cell.x(), cell.y(), cell.z());
}

double Air::fill(const Vec3d& x) const {
  const std::size_t n = cell_of(x);
  return n < box_.count() ? static_cast<double>(fill_[n]) : 0;
}

double Air::strain_rate(const Vec3d& x) const {
  const std::size_t n = cell_of(x);
  return n < box_.count() ? static_cast<double>(strain_[n]) : 0;
}

Vec3d Air::snow_velocity(const Vec3d& x) const {
  const std::size_t n = cell_of(x);
  if (n >= box_.count()) return Vec3d::Zero();
  return {static_cast<double>(snow_v_[0][n]), static_cast<double>(snow_v_[1][n]),
          static_cast<double>(snow_v_[2][n])};
}

/// A place in a solid is as far from the middle of its cell as the solid is, or further: distances
/// are bounds from below. Some is added for samples of meshes, which may be too large.
bool Air::is_near_solid(const Vec3d& x) const {
  if (!has_solids_) return false;
  const std::size_t n = cell_of(x);
  if (n >= box_.count() || distance_.empty()) return true;
  const Vec3d place = box_.place(x);
  const Vec3d in_cell = place.array() - place.array().floor() - 0.5;
  return static_cast<double>(distance_[n]) < (1.2 * in_cell.norm() + 0.2) * box_.spacing;
}

double Air::largest_speed() const {
  float largest = 0;
  for (const std::vector<float>& field : u_)
    for (const float value : field) largest = std::max(largest, std::abs(value));
  return static_cast<double>(largest);
}

std::size_t Air::memory_bytes() const {
  std::size_t bytes = 0;
  for (const auto* fields : {&u_, &next_, &snow_v_, &solid_v_})
    for (const std::vector<float>& field : *fields) bytes += 4 * field.capacity();
  for (const auto* field : {&fill_, &strain_, &distance_}) bytes += 4 * field->capacity();
  for (const auto* field : {&pressure_, &divergence_, &per_open_}) bytes += field->memory_bytes();
  bytes += sizeof(SnowSum) * sums_.capacity() + 4 * row_speed_.capacity();
  return bytes;
}

}  // namespace neve::sim::dust

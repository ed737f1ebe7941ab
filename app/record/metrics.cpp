#include "app/record/metrics.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <vector>

#include "app/scene/coarsen.h"

namespace neve::app::record {

namespace {

using Cell = std::array<int, 3>;

/// The value that a share of all is below; the list is reordered.
double quantile(std::vector<double>& values, double share) {
  if (values.empty()) return 0;
  const auto place = values.begin() + std::lround(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), place, values.end());
  return *place;
}

std::vector<std::size_t> finite_particles(const sim::ParticleArrays& particles,
                                          const std::vector<bool>& is_counted) {
  std::vector<std::size_t> ids;
  const auto counts = [&](std::size_t p) {
    return is_counted.empty() || particles.material.empty() ||
           is_counted[static_cast<std::size_t>(particles.material[p])];
  };
  for (std::size_t p = 0; p < particles.x.size(); ++p)
    if (counts(p) && particles.x[p].allFinite() && particles.x[p].cwiseAbs().maxCoeff() < 1e8)
      ids.push_back(p);
  return ids;
}

/// Occupied cells in order, each with its particles counted.
struct Occupied {
  std::vector<Cell> cells;
  std::vector<std::size_t> count;
};

Occupied occupied_cells(const sim::ParticleArrays& particles, const std::vector<std::size_t>& ids,
                        double h) {
  std::vector<Cell> all;
  all.reserve(ids.size());
  for (const std::size_t p : ids) {
    Cell cell;
    for (int a = 0; a < 3; ++a)
      // All places far away, beyond counting, are one.
      cell[static_cast<std::size_t>(a)] =
          static_cast<int>(std::clamp(std::floor(particles.x[p][a] / h), -1e9, 1e9));
    all.push_back(cell);
  }
  std::sort(all.begin(), all.end());
  Occupied occupied;
  for (const Cell& cell : all) {
    if (occupied.cells.empty() || occupied.cells.back() != cell) {
      occupied.cells.push_back(cell);
      occupied.count.push_back(0);
    }
    ++occupied.count.back();
  }
  return occupied;
}

/// Groups as trees: each cell points towards the first of its group.
class Groups {
 public:
  explicit Groups(std::size_t count) : parent_(count) {
    std::iota(parent_.begin(), parent_.end(), std::size_t{0});
  }
  std::size_t root(std::size_t k) {
    while (parent_[k] != k) k = parent_[k] = parent_[parent_[k]];
    return k;
  }
  void join(std::size_t a, std::size_t b) { parent_[root(b)] = root(a); }

 private:
  std::vector<std::size_t> parent_;
};

/// Each cell is joined with those of its 26 neighbours that come before it. All cells of a row
/// along z follow each other, so a row needs one search.
void join_neighbours(const std::vector<Cell>& cells, Groups& groups) {
  for (std::size_t k = 0; k < cells.size(); ++k) {
    const Cell& c = cells[k];
    for (const auto& [dx, dy] : {std::pair{-1, -1}, {-1, 0}, {-1, 1}, {0, -1}, {0, 0}}) {
      const Cell first{c[0] + dx, c[1] + dy, c[2] - 1};
      const auto end = cells.begin() + static_cast<std::ptrdiff_t>(k);
      for (auto other = std::lower_bound(cells.begin(), end, first);
           other != end && (*other)[0] == first[0] && (*other)[1] == first[1] &&
           (*other)[2] <= c[2] + 1;
           ++other)
        groups.join(static_cast<std::size_t>(other - cells.begin()), k);
    }
  }
}

/// Particles of the largest group that is a crumb and no piece.
constexpr std::size_t largest_crumb = 100;

void measure_fragments(const Occupied& occupied, std::size_t particle_count, Metrics& metrics) {
  Groups groups(occupied.cells.size());
  join_neighbours(occupied.cells, groups);
  std::vector<std::size_t> size(occupied.cells.size(), 0);
  for (std::size_t k = 0; k < occupied.cells.size(); ++k) size[groups.root(k)] += occupied.count[k];
  std::size_t largest = 0, powder = 0, crumbs = 0;
  for (const std::size_t count : size) {
    if (count > 0) ++metrics.fragments;
    largest = std::max(largest, count);
    (count == 1 ? powder : crumbs) += count <= largest_crumb ? count : 0;
  }
  const auto share = [&](std::size_t count) {
    return static_cast<double>(count) / static_cast<double>(particle_count);
  };
  metrics.particles = particle_count;
  metrics.largest_fragment = share(largest);
  metrics.powder = share(powder);
  metrics.crumbs = share(crumbs);
}

}  // namespace

std::optional<double> held_whole(const Metrics& first, const Metrics& last) {
  if (!(first.largest_fragment > 0 && last.largest_fragment > 0)) return std::nullopt;
  const double shares = last.largest_fragment / first.largest_fragment;
  if (first.particles == 0 || last.particles == 0) return shares;
  return shares * static_cast<double>(last.particles) / static_cast<double>(first.particles);
}

std::optional<bool> has_broken(const Metrics& first, const Metrics& last) {
  const std::optional<double> held = held_whole(first, last);
  if (!held) return std::nullopt;
  if (*held >= whole_share) return false;
  // Less of it, and yet it is as much of what is left: a sink has taken the rest.
  if (last.particles < first.particles &&
      last.largest_fragment >= whole_share * first.largest_fragment)
    return std::nullopt;
  return true;
}

Metrics measure(const sim::ParticleArrays& particles, double cell_size,
                const std::vector<bool>& is_counted) {
  Metrics metrics;
  const std::vector<std::size_t> ids = finite_particles(particles, is_counted);
  if (ids.empty()) return metrics;
  sim::Vec3d centre = sim::Vec3d::Zero();
  double mass = 0, J_P = 0;
  for (const std::size_t p : ids) {
    centre += particles.m[p] * particles.x[p];
    J_P += particles.m[p] * particles.J_P[p];
    mass += particles.m[p];
  }
  centre /= mass;
  metrics.mean_J_P = J_P / mass;
  std::vector<double> radius, height;
  for (const std::size_t p : ids) {
    radius.push_back(std::hypot(particles.x[p].x() - centre.x(), particles.x[p].z() - centre.z()));
    height.push_back(particles.x[p].y());
  }
  metrics.spread = quantile(radius, 0.9);
  metrics.height = quantile(height, 0.98) - quantile(height, 0.02);
  measure_fragments(occupied_cells(particles, ids, cell_size), ids.size(), metrics);
  return metrics;
}

Metrics measure(const sim::ParticleArrays& particles, const scene::Scene& scene) {
  return measure(particles, scene.solver.cell_size, scene::which_are_snow(scene));
}

}  // namespace neve::app::record

#include "sim/shapes/placed_points.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <compare>
#include <filesystem>
#include <map>
#include <mutex>
#include <numeric>
#include <optional>
#include <system_error>
#include <utility>

#include "sim/shapes/held_files.h"

namespace neve::sim::shapes {
namespace {

/// Cells along each side of the cube around points, in bits; three of them fit into a key.
constexpr int key_bits = 21;

/// Returns the place of a cell along the Hilbert curve of the cube: cells that follow each other
/// are neighbours. Skilling, Programming the Hilbert curve, AIP Conf. Proc. 707 (2004) 381.
std::uint64_t place_on_curve(std::array<std::uint32_t, 3> x) {
  constexpr std::uint32_t top = 1u << (key_bits - 1);
  for (std::uint32_t bit = top; bit > 1; bit >>= 1) {
    const std::uint32_t below = bit - 1;
    for (std::uint32_t& along : x) {
      const std::uint32_t swapped = (x[0] ^ along) & below;
      if ((along & bit) != 0)
        x[0] ^= below;
      else
        x[0] ^= swapped, along ^= swapped;
    }
  }
  x[1] ^= x[0];
  x[2] ^= x[1];
  std::uint32_t turned = 0;
  for (std::uint32_t bit = top; bit > 1; bit >>= 1)
    if ((x[2] & bit) != 0) turned ^= bit - 1;
  std::uint64_t place = 0;
  for (int bit = key_bits - 1; bit >= 0; --bit)
    for (const std::uint32_t along : x) place = place << 1 | ((along ^ turned) >> bit & 1);
  return place;
}

template <class T>
void keep(const std::vector<std::size_t>& kept, std::vector<T>& list) {
  if (list.empty()) return;
  for (std::size_t k = 0; k < kept.size(); ++k) list[k] = list[kept[k]];
  list.resize(kept.size());
}

double sum(const std::vector<double>& list) {
  return std::accumulate(list.begin(), list.end(), 0.0);
}

void scale_to(double total, std::vector<double>& list) {
  const double factor = list.empty() ? 1 : total / sum(list);
  for (double& value : list) value *= factor;
}

class PointsSolid final : public Form {
 public:
  explicit PointsSolid(const Points& points) : points_(points) {}

  double volume() const override { return summary().volume; }
  Bounds bounds_after(const Mat3d& rotation) const override {
    return summary_of(points_, rotation).bounds;
  }
  /// Points have no surface; their bounds are as much as can be said.
  bool contains(const Vec3d& y) const override {
    const Bounds b = summary().bounds;
    return (y.array() >= b.min.array()).all() && (y.array() <= b.max.array()).all();
  }
  double clearance(const Vec3d&) const override { return 0; }
  Vec3d inner_point() const override { return summary().first; }

 private:
  PointsSummary summary() const { return summary_of(points_, Mat3d::Identity()); }

  Points points_;
};

PointsSummary summarize(const PlacedPoints& placed, const Mat3d& rotation) {
  PointsSummary summary{placed.x.size(),
                        placed.expected_count,
                        placed.volume,
                        placed.V0,
                        placed.has_volumes,
                        sum(placed.m),
                        0,
                        placed.x.front(),
                        placed.bounds_after(rotation)};
  for (const Vec3d& v : placed.v) summary.max_speed = std::max(summary.max_speed, v.norm());
  return summary;
}

/// Inputs of a summary. Size and time of writing identify a file.
struct SummaryKey {
  std::string file;
  std::uintmax_t size = 0;
  std::filesystem::file_time_type written{};
  std::array<double, 14> numbers{};  ///< spacing, thinning, rotation, origin
  auto operator<=>(const SummaryKey&) const = default;
};

/// @return nothing if a later change of the file could go unnoticed
std::optional<SummaryKey> key_of(const Points& points, const Mat3d& rotation) {
  std::error_code no_size, no_time;
  SummaryKey key{points.file,
                 std::filesystem::file_size(points.file, no_size),
                 std::filesystem::last_write_time(points.file, no_time),
                 {points.spacing, points.thinning}};
  if (no_size || no_time) return std::nullopt;
  std::copy_n(rotation.data(), 9, key.numbers.begin() + 2);
  std::copy_n(points.origin.data(), 3, key.numbers.begin() + 11);
  return key;
}

/// The same content as long as it is held.
files::PointCloud read_held(const std::string& file, const std::vector<std::string>& further = {}) {
  require_unchanged(file);
  files::PointCloud cloud = files::read_points(file, further);
  require_unchanged(file);
  return cloud;
}

}  // namespace

/// One of every `thinning` along a curve through space. Along the rows of the file it was one plane
/// of a lattice, where the points of a row fit into that number.
std::vector<std::size_t> kept_points(const std::vector<Vec3d>& x, double thinning) {
  Bounds box;
  for (const Vec3d& place : x) box.add(place);
  const double size = (box.max - box.min).maxCoeff();
  constexpr double last = (1u << key_bits) - 1;
  std::vector<std::pair<std::uint64_t, std::size_t>> order;
  order.reserve(x.size());
  for (std::size_t p = 0; p < x.size(); ++p) {
    std::array<std::uint32_t, 3> cell{};
    for (int a = 0; a < 3; ++a)
      if (const double share = (x[p][a] - box.min[a]) / size; share > 0)
        cell[static_cast<std::size_t>(a)] = static_cast<std::uint32_t>(last * std::min(share, 1.0));
    order.emplace_back(place_on_curve(cell), p);
  }
  std::sort(order.begin(), order.end());
  std::vector<std::size_t> kept;
  for (std::size_t k = 0; k < order.size(); ++k) {
    const double before = std::floor(static_cast<double>(k) / thinning);
    if (std::floor(static_cast<double>(k + 1) / thinning) > before) kept.push_back(order[k].second);
  }
  if (kept.empty() && !x.empty()) kept.push_back(0);
  std::sort(kept.begin(), kept.end());
  return kept;
}

std::vector<files::PointColumn> placed_columns(const Points& points,
                                               const std::vector<std::string>& names) {
  files::PointCloud cloud = read_held(points.file, names);
  if (points.thinning != 1) {
    const std::vector<std::size_t> kept = kept_points(cloud.x, points.thinning);
    for (files::PointColumn& column : cloud.further) keep(kept, column.value);
  }
  return std::move(cloud.further);
}

std::vector<std::string> column_names(const Points& points) {
  return files::further_columns(points.file);
}

PlacedPoints::PlacedPoints(const Points& points)
    : PlacedPoints(read_held(points.file), points, points.file) {}

PlacedPoints::PlacedPoints(files::PointCloud cloud, const Points& points, const std::string& name)
    : PointCloud(std::move(cloud)) {
  std::vector<std::size_t> kept;  // by the numbers of the file, as for its further columns
  if (points.thinning != 1) kept = kept_points(x, points.thinning);
  constexpr double furthest = 1e6;  // m, where single precision is 6 cm
  for (Vec3d& place : x) {
    place -= points.origin;
    if (!(place.cwiseAbs().maxCoeff() <= furthest))
      throw ShapeError(name + ": it has a point more than 1e6 m from the scene's origin; " +
                       "coordinates = \"world\" takes the offset of a map out");
  }
  const auto count = static_cast<double>(x.size());
  if (V.empty() && !(points.spacing > 0))
    throw ShapeError(name +
                     ": it has no column volume; give spacing, the distance between neighbouring "
                     "points in metres");
  has_volumes = !V.empty();
  volume = V.empty() ? count * std::pow(points.spacing, 3) : sum(V);
  V0 = sum(V);
  if (V.empty())
    for (const double packed : J_P) V0 += std::pow(points.spacing, 3) / packed;
  expected_count = count / points.thinning;
  if (points.thinning == 1) return;
  // The remaining points represent all: total mass and volume stay the same.
  const double mass = sum(m);
  if (V.empty())
    for (const double packed : J_P) V.push_back(1 / packed);
  for (std::vector<Vec3d>* list : {&x, &v}) keep(kept, *list);
  for (std::vector<double>* list : {&m, &V, &J_P, &stiffness, &threshold}) keep(kept, *list);
  for (std::vector<Mat3d>* list : {&F_E, &C}) keep(kept, *list);
  scale_to(mass, m);
  scale_to(V0, V);
}

Bounds PlacedPoints::bounds_after(const Mat3d& rotation) const {
  Bounds b;
  for (const Vec3d& point : x) b.add(Vec3d(rotation * point));
  const double half = 0.5 * std::cbrt(volume / static_cast<double>(x.size()));
  return {b.min.array() - half, b.max.array() + half};
}

PointsSummary summary_of(const Points& points, const Mat3d& rotation) {
  constexpr std::size_t max_remembered = 256;
  static std::mutex mutex;
  static std::map<SummaryKey, PointsSummary> remembered;
  const std::optional<SummaryKey> key = key_of(points, rotation);
  if (key) {
    const std::lock_guard lock(mutex);
    if (const auto found = remembered.find(*key); found != remembered.end()) return found->second;
  }
  const PointsSummary summary = summarize(PlacedPoints(points), rotation);
  if (key) {
    const std::lock_guard lock(mutex);
    if (remembered.size() >= max_remembered) remembered.clear();
    remembered.emplace(*key, summary);
  }
  return summary;
}

std::unique_ptr<const Form> make_points_solid(const Points& points) {
  return std::make_unique<PointsSolid>(points);
}

}  // namespace neve::sim::shapes

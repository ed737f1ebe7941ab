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

namespace neve::sim::shapes {
namespace {

template <class T>
void thin(std::vector<T>& list, double thinning) {
  if (list.empty()) return;
  const std::vector<std::size_t> kept = kept_points(list.size(), thinning);
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
  PointsSummary summary{
      placed.x.size(),  placed.expected_count,        placed.volume, placed.V0, sum(placed.m), 0,
      placed.x.front(), placed.bounds_after(rotation)};
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

}  // namespace

/// One of every `thinning`, evenly, at least one. Neighbours in a file tend to be neighbours in
/// space, so the rest is spread evenly there too.
std::vector<std::size_t> kept_points(std::size_t count, double thinning) {
  std::vector<std::size_t> kept;
  for (std::size_t p = 0; p < count; ++p) {
    const double before = std::floor(static_cast<double>(p) / thinning);
    if (std::floor(static_cast<double>(p + 1) / thinning) > before) kept.push_back(p);
  }
  if (kept.empty() && count > 0) kept.push_back(0);
  return kept;
}

std::vector<files::PointColumn> placed_columns(const Points& points,
                                               const std::vector<std::string>& names) {
  std::vector<files::PointColumn> columns = files::read_points(points.file, names).further;
  if (points.thinning != 1)
    for (files::PointColumn& column : columns) thin(column.value, points.thinning);
  return columns;
}

std::vector<std::string> column_names(const Points& points) {
  return files::further_columns(points.file);
}

PlacedPoints::PlacedPoints(const Points& points)
    : PlacedPoints(files::read_points(points.file), points, points.file) {}

PlacedPoints::PlacedPoints(files::PointCloud cloud, const Points& points, const std::string& name)
    : PointCloud(std::move(cloud)) {
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
  thin(x, points.thinning);
  thin(v, points.thinning);
  thin(m, points.thinning);
  thin(V, points.thinning);
  for (std::vector<double>* list : {&J_P, &stiffness, &threshold}) thin(*list, points.thinning);
  for (std::vector<Mat3d>* list : {&F_E, &C}) thin(*list, points.thinning);
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

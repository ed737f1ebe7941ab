#include "app/compare/series.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>
#include <utility>

#include "app/picture/to_float.h"

namespace neve::app::compare {

namespace {

constexpr std::size_t nodes_of_block = 64;

/// Blocks in the order of a lattice.
struct BlockOrder {
  bool operator()(const Vec3i& p, const Vec3i& q) const {
    return std::tie(p.x, p.y, p.z) < std::tie(q.x, q.y, q.z);
  }
};

/// A block of nodes has a place in the memory of each run; null where a run has no snow there.
using Places = std::map<Vec3i, std::pair<const float*, const float*>, BlockOrder>;

Places places_of(const picture::FieldSamples& a, const picture::FieldSamples& b) {
  Places places;
  for (const auto& [run, place] :
       {std::pair{&a, &Places::mapped_type::first}, std::pair{&b, &Places::mapped_type::second}})
    for (std::size_t k = 0; run->lattice && k < run->lattice->block.size(); ++k)
      places[run->lattice->block[k]].*place = run->density.data() + nodes_of_block * k;
  return places;
}

}  // namespace

Displacement displacement(const sim::ParticleArrays& a, const sim::ParticleArrays& b) {
  Displacement d;
  double sum = 0, largest = 0;
  for (std::size_t p = 0; p < a.x.size(); ++p) {
    const auto other = b.index_of(a.id_of(p));
    if (!other) continue;
    const double distance = (a.x[p] - b.x[*other]).norm();
    if (!std::isfinite(distance)) continue;
    ++d.in_both;
    sum += distance;
    largest = std::max(largest, distance);
  }
  d.only_a = a.x.size() - d.in_both;
  d.only_b = b.x.size() - d.in_both;
  if (d.in_both == 0) return d;
  d.mean = sum / static_cast<double>(d.in_both);
  d.largest = largest;
  return d;
}

void color_by_displacement(const sim::ParticleArrays& other, double range, render::Points& points) {
  std::vector<Vec3f> position;
  std::vector<std::uint32_t> id;
  std::vector<float> value;
  for (std::size_t p = 0; p < points.position.size(); ++p) {
    const auto index = other.index_of(points.id[p]);
    if (!index) continue;
    position.push_back(points.position[p]);
    id.push_back(points.id[p]);
    const float distance = length(position.back() - picture::to_float(other.x[*index]));
    value.push_back(std::isfinite(distance) ? distance : static_cast<float>(range));
  }
  points.position = std::move(position);
  points.id = std::move(id);
  points.value = std::move(value);
  points.range_min = 0;
  points.range_max = static_cast<float>(range);
}

MassDifference mass_difference(const picture::FieldSamples& a, const picture::FieldSamples& b) {
  MassDifference result;
  const picture::FieldSamples& any = a.lattice ? a : b;
  if (!any.lattice) return result;
  auto lattice = std::make_shared<render::NodeLattice>();
  lattice->origin = any.lattice->origin;
  lattice->spacing = any.lattice->spacing;
  const double volume = std::pow(static_cast<double>(lattice->spacing), 3);
  for (const auto& [block, nodes] : places_of(a, b)) {
    lattice->block.push_back(block);
    for (std::size_t n = 0; n < nodes_of_block; ++n) {
      const double more = (nodes.second ? static_cast<double>(nodes.second[n]) : 0) -
                          (nodes.first ? static_cast<double>(nodes.first[n]) : 0);
      (more > 0 ? result.more_in_b : result.more_in_a) += std::abs(more) * volume;
      result.smoke.density.edit().push_back(static_cast<float>(std::abs(more)));
      result.smoke.value.edit().push_back(static_cast<float>(more));
    }
  }
  result.smoke.nodes = lattice;
  result.smoke.colormap = render::ColorMap::coolwarm;
  return result;
}

}  // namespace neve::app::compare

#include "app/picture/wires.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include "app/picture/attributes.h"
#include "app/picture/to_float.h"
#include "app/support/text.h"

namespace neve::app::picture {

namespace {

using sim::Vec3d;

/// An edge of a block: the axis along it, and in blocks where it starts.
using Edge = std::array<int, 4>;

bool has_mass(const std::vector<float>& density, std::size_t block) {
  return std::any_of(density.begin() + static_cast<std::ptrdiff_t>(64 * block),
                     density.begin() + static_cast<std::ptrdiff_t>(64 * (block + 1)),
                     [](float d) { return d > 0; });
}

std::vector<Edge> edges_of(const render::NodeLattice& lattice, const std::vector<float>& density) {
  std::vector<Edge> edges;
  for (std::size_t b = 0; b < lattice.block.size(); ++b) {
    if (!has_mass(density, b)) continue;
    const Vec3i at = lattice.block[b];
    for (int axis = 0; axis < 3; ++axis)
      for (int side = 0; side < 4; ++side) {
        Vec3i start = at;
        start[(axis + 1) % 3] += side & 1;
        start[(axis + 2) % 3] += side >> 1;
        // The place along the edge is last, so that sorted edges of one line follow each other.
        edges.push_back({axis, start[(axis + 1) % 3], start[(axis + 2) % 3], start[axis]});
      }
  }
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  return edges;
}

}  // namespace

render::Lines block_lines(const render::NodeLattice& lattice, const std::vector<float>& density) {
  const std::vector<Edge> edges = edges_of(lattice, density);
  const float side = 4 * lattice.spacing;
  render::Lines lines;
  lines.opacity = 0.35f;
  lines.width = 1;
  const auto corner = [&](const Edge& edge, int along) {
    const int axis = edge[0];
    Vec3f p;
    p[axis] = static_cast<float>(along) * side;
    p[(axis + 1) % 3] = static_cast<float>(edge[1]) * side;
    p[(axis + 2) % 3] = static_cast<float>(edge[2]) * side;
    return lattice.origin + p;
  };
  // Edges that continue one another make one line.
  for (std::size_t first = 0; first < edges.size();) {
    std::size_t next = first + 1;
    Edge expected = edges[first];
    while (++expected[3], next < edges.size() && edges[next] == expected) ++next;
    lines.ends.push_back(corner(edges[first], edges[first][3]));
    lines.ends.push_back(corner(edges[first], expected[3]));
    first = next;
  }
  return lines;
}

void append_box(const Vec3d& low, const Vec3d& high, render::Lines& lines) {
  const auto corner = [&](int k) {
    const Vec3d p(k & 1 ? high.x() : low.x(), k & 2 ? high.y() : low.y(),
                  k & 4 ? high.z() : low.z());
    return to_float(p);
  };
  for (int k = 0; k < 8; ++k)
    for (const int bit : {1, 2, 4})
      if (!(k & bit)) {
        lines.ends.push_back(corner(k));
        lines.ends.push_back(corner(k | bit));
      }
}

namespace {

Vec3i node_of(const render::NodeLattice& lattice, std::size_t n) {
  const Vec3i block = lattice.block[n / 64];
  const int r = static_cast<int>(n % 64);
  return {4 * block.x + r / 16, 4 * block.y + r / 4 % 4, 4 * block.z + r % 4};
}

Vec3f place_of(const render::NodeLattice& lattice, std::size_t n) {
  const Vec3i node = node_of(lattice, n);
  const Vec3f steps{static_cast<float>(node.x), static_cast<float>(node.y),
                    static_cast<float>(node.z)};
  return lattice.origin + steps * lattice.spacing;
}

/// Values of a field on all nodes, of vectors their lengths.
struct MarkedField {
  AttributeName name{"", ""};
  std::vector<float> values;
  bool is_speed = false;
};

MarkedField lengths_of(const FieldSamples& fields, scene::VectorField field) {
  MarkedField marked{attribute_name(field),
                     {},
                     field != scene::VectorField::momentum && field != scene::VectorField::force};
  if (const auto found = fields.vectors.find(field); found != fields.vectors.end())
    for (const Vec3f& v : found->second) marked.values.push_back(length(v));
  return marked;
}

MarkedField scalars_of(const FieldSamples& fields, scene::ScalarField field) {
  const bool is_mass = field == scene::ScalarField::mass;
  MarkedField marked{attribute_name(is_mass ? scene::ScalarField::density : field),
                     {},
                     field == scene::ScalarField::speed};
  const auto found = fields.scalars.find(field);
  if (found != fields.scalars.end())
    marked.values = found->second;
  else if (is_mass)
    marked.values = fields.density;
  return marked;
}

/// Returns the field that the view shows first of all.
MarkedField field_shown(const scene::View& view, const FieldSamples& fields) {
  const auto has = [&](scene::Layer layer) { return scene::has_layer(view, layer); };
  const bool has_vectors = has(scene::Layer::arrows) || has(scene::Layer::streamlines);
  if (has_vectors && !has(scene::Layer::heatmap)) return lengths_of(fields, view.slice.field);
  if (has(scene::Layer::smoke) && !has(scene::Layer::heatmap))
    return scalars_of(fields, view.smoke.field);
  return scalars_of(fields, view.slice.scalar);
}

/// Draws three lines through a node.
void add_cross(Vec3f at, float reach, render::Lines& lines) {
  for (int axis = 0; axis < 3; ++axis)
    for (const float side : {-reach, reach}) {
      Vec3f end = at;
      end[axis] += side;
      lines.ends.push_back(end);
    }
}

std::string extreme_text(const char* which, const MarkedField& field, float value, Vec3i node) {
  const std::string unit = field.name.unit;
  return fmt::format("{} {} {}{}, node {} {} {}", which, field.name.title,
                     rough_text(static_cast<double>(value)), unit.empty() ? "" : " " + unit, node.x,
                     node.y, node.z);
}

}  // namespace

scene::View with_ranges_of_frame(scene::View view, const FieldSamples& fields) {
  if (view.slice.range_from != scene::RangeFrom::frame || !fields.lattice) return view;
  const auto range_of = [&](const std::vector<float>& values) -> std::optional<scene::Range> {
    std::optional<scene::Range> range;
    for (std::size_t n = 0; n < values.size(); ++n) {
      if (!(fields.density[n] > 0) || !std::isfinite(values[n])) continue;
      const auto value = static_cast<double>(values[n]);
      if (!range) range = scene::Range{value, value};
      range = scene::Range{std::min(range->min, value), std::max(range->max, value)};
    }
    return range;
  };
  const auto scalars = fields.scalars.find(view.slice.scalar);
  if (scalars != fields.scalars.end())
    if (const auto range = range_of(scalars->second)) view.slice.scalar_range = range;
  if (fields.vectors.contains(view.slice.field))
    if (const auto range = range_of(lengths_of(fields, view.slice.field).values))
      view.slice.range = scene::Range{0, range->max};
  return view;
}

void mark_extremes(const scene::View& view, const FieldSamples& fields, double dt,
                   render::Frame& frame) {
  if (!fields.lattice) return;
  constexpr std::size_t max_bad = 500;
  const render::NodeLattice& lattice = *fields.lattice;
  const MarkedField field = field_shown(view, fields);
  std::optional<std::size_t> smallest, largest;
  std::vector<std::size_t> bad;
  for (std::size_t n = 0; n < field.values.size(); ++n) {
    if (!(fields.density[n] > 0)) continue;
    const float value = field.values[n];
    const bool is_number = std::isfinite(value);
    if (!is_number ||
        (field.is_speed && static_cast<double>(value) * dt > static_cast<double>(lattice.spacing)))
      bad.push_back(n);
    if (!is_number) continue;
    if (!smallest || value < field.values[*smallest]) smallest = n;
    if (!largest || value > field.values[*largest]) largest = n;
  }
  const float reach = 0.7f * lattice.spacing;
  render::Lines marks, wrong;
  marks.color = {1, 0.85f, 0.25f};
  wrong.color = {0.95f, 0.1f, 0.08f};
  marks.width = wrong.width = 2.5f;
  for (const auto& [which, n] : {std::pair{"largest", largest}, std::pair{"smallest", smallest}}) {
    if (!n) continue;
    const Vec3f at = place_of(lattice, *n);
    add_cross(at, reach, marks);
    frame.labels.push_back(
        {at, extreme_text(which, field, field.values[*n], node_of(lattice, *n))});
  }
  for (std::size_t k = 0; k < std::min(bad.size(), max_bad); ++k)
    add_cross(place_of(lattice, bad[k]), reach, wrong);
  if (!bad.empty())
    frame.footnote += fmt::format("{}{} {} red: no number, or more than a cell in a step",
                                  frame.footnote.empty() ? "" : ", ", bad.size(),
                                  bad.size() == 1 ? "node is" : "nodes are");
  if (!marks.ends.empty()) frame.lines.push_back(std::move(marks));
  if (!wrong.ends.empty()) frame.lines.push_back(std::move(wrong));
}

}  // namespace neve::app::picture

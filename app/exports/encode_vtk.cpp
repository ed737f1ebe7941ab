#include <cstdint>
#include <numeric>

#include "app/exports/bytes.h"
#include "app/exports/encode.h"
#include "app/support/errors.h"
#include "app/support/room.h"
#include "app/support/text.h"

namespace neve::app::exports {

namespace {

using sim::Vec3d;
using sim::Vec3i;

/// Nodes that a grid file may have: 4 GiB of mass and velocity.
constexpr double max_nodes = 134'217'728;

/// Data arrays behind the XML: each with its size in front.
class AppendedArrays {
 public:
  template <class T>
  std::string add(const std::string& name, int components, const std::vector<T>& numbers) {
    std::string xml = std::string("<DataArray type=\"") + vtk_type<T>() + "\" Name=\"" + name +
                      "\" NumberOfComponents=\"" + std::to_string(components) +
                      "\" format=\"appended\" offset=\"" + std::to_string(bytes_.size()) + "\"/>\n";
    append_little(static_cast<std::uint64_t>(numbers.size() * sizeof(T)), bytes_);
    append_all(numbers, bytes_);
    return xml;
  }
  /// The end of the file.
  std::string take() {
    return "<AppendedData encoding=\"raw\">\n_" + bytes_ + "\n</AppendedData>\n</VTKFile>\n";
  }

 private:
  template <class T>
  static const char* vtk_type() {
    if (std::is_same_v<T, float>) return "Float32";
    if (std::is_same_v<T, double>) return "Float64";
    return sizeof(T) == 4 ? "Int32" : "Int64";
  }

  std::string bytes_;
};

std::string vtk_start(const std::string& type) {
  return "<?xml version=\"1.0\"?>\n<VTKFile type=\"" + type +
         "\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n<" + type;
}

/// ParaView shows it as the time of the file.
std::string vtk_time(const ExportMoment& moment) {
  std::string text =
      "<FieldData>\n<DataArray type=\"Float64\" Name=\"TimeValue\" NumberOfTuples=\"1\" "
      "format=\"ascii\">";
  append_text(moment.state.time, text);
  return text + "</DataArray>\n</FieldData>\n";
}

/// Cells of one size, by the numbers of their points.
template <class Number>
std::string vtk_cells(const std::string& kind, const std::vector<Number>& points, std::size_t size,
                      AppendedArrays& arrays) {
  std::vector<std::int64_t> ends(points.size() / size);
  for (std::size_t k = 0; k < ends.size(); ++k) ends[k] = static_cast<std::int64_t>((k + 1) * size);
  const std::vector<std::int64_t> numbers(points.begin(), points.end());
  const std::string connectivity = arrays.add("connectivity", 1, numbers);
  return "<" + kind + ">\n" + connectivity + arrays.add("offsets", 1, ends) + "</" + kind + ">\n";
}

/// The smallest box of nodes around all blocks.
struct NodeBox {
  Vec3i first = Vec3i::Zero(), size = Vec3i::Ones();
};

NodeBox box_of(const sim::RasterizedNodes& nodes) {
  if (nodes.block.empty()) return {};
  Vec3i low = nodes.block.front(), high = low;
  for (const Vec3i& block : nodes.block) {
    low = low.cwiseMin(block);
    high = high.cwiseMax(block);
  }
  // Counted in double: far apart blocks would overflow.
  const Vec3d size = 4 * (high.cast<double>() - low.cast<double>() + Vec3d::Ones());
  if (size.prod() > max_nodes)
    throw LimitError("refused: the box of nodes around the snow has " + fixed_text(size.prod(), 0) +
                         " nodes; a vti file holds at most " + fixed_text(max_nodes, 0),
                     "vti",
                     "write vtp instead, or let a [[sink]] with outside = true remove snow that is "
                     "far away");
  // Mass and velocity as numbers, as bytes, and as the text of the file.
  require_room(
      size.prod() * 4 * sizeof(double) * 3, "the box of nodes around the snow", "vti",
      "write vtp or vdb instead, or let a [[sink]] with outside = true remove snow that is "
      "far away");
  return {4 * low, 4 * (high - low + Vec3i::Ones())};
}

/// Nodes of the box as the file has them: x fastest, axes turned.
struct DenseGrid {
  Vec3i size;
  Vec3d origin;
  double spacing;
  std::vector<double> mass, velocity;
};

DenseGrid dense_grid(const sim::RasterizedNodes& nodes, const Axes& axes) {
  const NodeBox box = box_of(nodes);
  const bool is_z_up = axes.is_z_up();
  // With z up, the second axis of the file runs against the third of the simulation.
  const Vec3i last = box.first + box.size - Vec3i::Ones();
  const Vec3i corner = is_z_up ? Vec3i(box.first.x(), box.first.y(), last.z()) : box.first;
  DenseGrid grid;
  grid.size = is_z_up ? Vec3i(box.size.x(), box.size.z(), box.size.y()) : box.size;
  grid.spacing = axes.scale() * nodes.spacing;
  grid.origin = axes.placed(nodes.spacing * corner.cast<double>());
  const auto count = static_cast<std::size_t>(grid.size.x()) *
                     static_cast<std::size_t>(grid.size.y()) *
                     static_cast<std::size_t>(grid.size.z());
  grid.mass.assign(count, 0.0);
  grid.velocity.assign(3 * count, 0.0);
  const auto place = [&](const Vec3i& node) {
    const Vec3i at = node - box.first;
    const Vec3i out = is_z_up ? Vec3i(at.x(), box.size.z() - 1 - at.z(), at.y()) : at;
    return (static_cast<std::size_t>(out.z()) * static_cast<std::size_t>(grid.size.y()) +
            static_cast<std::size_t>(out.y())) *
               static_cast<std::size_t>(grid.size.x()) +
           static_cast<std::size_t>(out.x());
  };
  for (std::size_t b = 0; b < nodes.block.size(); ++b)
    for (int n = 0; n < 64; ++n) {
      const std::size_t from = 64 * b + static_cast<std::size_t>(n);
      const std::size_t to = place(4 * nodes.block[b] + Vec3i(n / 16, n / 4 % 4, n % 4));
      grid.mass[to] = nodes.mass[from];
      const Vec3d v = axes.scaled(nodes.velocity[from]);
      for (std::size_t a = 0; a < 3; ++a)
        grid.velocity[3 * to + a] = v[static_cast<Eigen::Index>(a)];
    }
  return grid;
}

}  // namespace

std::string encode_vtp(const ExportMoment& moment) {
  return vtp_text(moment.table, vtk_time(moment));
}

std::string vtp_text(const Table& table, const std::string& time) {
  const std::size_t first = table.mesh ? table.mesh->vertices : 0;
  std::vector<std::int64_t> points(table.rows - first);
  std::iota(points.begin(), points.end(), static_cast<std::int64_t>(first));
  const std::size_t triangles = table.mesh ? table.mesh->triangles() : 0;
  AppendedArrays arrays;
  std::string text = vtk_start("PolyData") + ">\n" + time + "<Piece NumberOfPoints=\"" +
                     std::to_string(table.rows) + "\" NumberOfVerts=\"" +
                     std::to_string(points.size()) +
                     "\" NumberOfLines=\"0\" NumberOfStrips=\"0\" NumberOfPolys=\"" +
                     std::to_string(triangles) + "\">\n<Points>\n";
  text += arrays.add("Points", 3, table.places());
  text += "</Points>\n" + vtk_cells("Verts", points, 1, arrays);
  if (table.mesh) text += vtk_cells("Polys", table.mesh->corners, 3, arrays);
  text += table.mesh ? "<PointData Normals=\"Normals\">\n" : "<PointData>\n";
  if (table.mesh) text += arrays.add("Normals", 3, table.mesh->normal);
  for (const Column& column : table.columns) {
    if (column.attribute == scene::ExportAttribute::x) continue;
    text += std::visit(
        [&](const auto& numbers) { return arrays.add(column.name, column.components, numbers); },
        column.numbers);
  }
  return text + "</PointData>\n</Piece>\n</PolyData>\n" + arrays.take();
}

std::string encode_vti(const ExportMoment& moment) {
  const DenseGrid grid = dense_grid(moment.nodes(), Axes(moment.scene, moment.spec));
  AppendedArrays arrays;
  std::string extent;
  for (int a = 0; a < 3; ++a) extent += (a > 0 ? " 0 " : "0 ") + std::to_string(grid.size[a] - 1);
  std::string text = vtk_start("ImageData") + " WholeExtent=\"" + extent + "\" Origin=\"";
  for (int a = 0; a < 3; ++a) {
    append_text(grid.origin[a], text);
    text += a < 2 ? " " : "\" Spacing=\"";
  }
  for (int a = 0; a < 3; ++a) {
    append_text(grid.spacing, text);
    text += a < 2 ? " " : "\">\n";
  }
  text += vtk_time(moment) + "<Piece Extent=\"" + extent + "\">\n<PointData>\n";
  text += arrays.add("mass", 1, grid.mass);
  text += arrays.add("velocity", 3, grid.velocity);
  return text + "</PointData>\n</Piece>\n</ImageData>\n" + arrays.take();
}

}  // namespace neve::app::exports

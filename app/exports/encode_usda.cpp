#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <vector>

#include "app/exports/encode.h"
#include "app/exports/usda.h"

namespace neve::app::exports {

namespace {

using scene::ExportAttribute;

/// A property of Points or of a Mesh: its type and its name.
struct UsdProperty {
  std::string type, name;
  bool is_primvar = false;
};

UsdProperty property_of(const Column& column, UsdPrim prim) {
  static constexpr std::array scalars{"float[]", "double[]", "int[]"};
  switch (column.attribute.value_or(ExportAttribute::density)) {
    case ExportAttribute::x:
      return {"point3f[]", "points"};
    case ExportAttribute::v:
      return {"vector3f[]", "velocities"};
    case ExportAttribute::id:
      if (prim == UsdPrim::points) return {"int64[]", "ids"};
      break;
    case ExportAttribute::radius:
      if (prim == UsdPrim::points) return {"float[]", "widths"};
      break;
    default:
      break;
  }
  return {scalars[column.numbers.index()], "primvars:" + usd_name(column.name), true};
}

constexpr const char* masses = "physics:masses";

/// Solvers of USD look for masses there, in single precision. A mesh has none.
bool has_masses(const Column& column, UsdPrim prim) {
  return prim == UsdPrim::points && column.attribute == ExportAttribute::m;
}

/// USD has places, velocities and widths in single precision; widths are diameters.
template <class Number>
void append_usd_number(const std::string& property, Number number, std::string& text) {
  if (property == "widths")
    append_text(static_cast<float>(2 * number), text);
  else if (property == "points" || property == "velocities" || property == masses)
    append_text(static_cast<float>(number), text);
  else
    append_text(number, text);
}

/// "(1, 2, 3)" of a vector; the numbers of a tensor are nine elements, row by row.
void append_usd_row(const Column& column, const std::string& property, std::size_t row,
                    std::string& text) {
  const bool is_vector = column.components == 3;
  const char* before = is_vector ? "(" : "";
  for_row(column, row, [&](auto number) {
    text += before;
    before = ", ";
    append_usd_number(property, number, text);
  });
  if (is_vector) text += ')';
}

/// Rows of a table that one prim has.
struct RowRange {
  std::size_t begin, end;
};

/// Lowest and highest place, as far out as the points are wide.
std::string extent_of(const Table& table, RowRange rows) {
  const std::vector<double>& x = table.places();
  if (rows.begin == rows.end) return "[(0, 0, 0), (0, 0, 0)]";
  const auto place_of = [&](std::size_t row) {
    return sim::Vec3d(x[3 * row], x[3 * row + 1], x[3 * row + 2]);
  };
  sim::Vec3d low = place_of(rows.begin), high = low;
  double widest = 0;
  const Column* radius = table.find(ExportAttribute::radius);
  for (std::size_t row = rows.begin; row < rows.end; ++row) {
    low = low.cwiseMin(place_of(row));
    high = high.cwiseMax(place_of(row));
    if (radius) widest = std::max(widest, std::get<std::vector<double>>(radius->numbers)[row]);
  }
  const sim::Vec3d margin = sim::Vec3d::Constant(widest);
  return "[" + usd_tuple(low - margin) + ", " + usd_tuple(high + margin) + "]";
}

/// A property at the time of the layer.
std::string usd_sample(const std::string& type, const std::string& name, const std::string& time,
                       const std::string& value) {
  const std::string indent(8, ' ');
  return indent + type + " " + name + ".timeSamples = {\n" + indent + "    " + time + ": " + value +
         ",\n" + indent + "}\n";
}

/// Values of a list with something between them. @param append  puts the value of an index
template <class Append>
std::string usd_list(RowRange rows, const Append& append) {
  std::string text = "[";
  for (std::size_t row = rows.begin; row < rows.end; ++row) {
    if (row > rows.begin) text += ", ";
    append(row, text);
  }
  return text + "]";
}

std::string usd_columns(const Table& table, UsdPrim prim, RowRange rows, const std::string& time) {
  std::string text = usd_sample("float3[]", "extent", time, extent_of(table, rows));
  for (const Column& column : table.columns) {
    const auto add = [&](const std::string& type, const std::string& name) {
      text += usd_sample(type, name, time, usd_list(rows, [&](std::size_t row, std::string& list) {
                           append_usd_row(column, name, row, list);
                         }));
    };
    const UsdProperty property = property_of(column, prim);
    add(property.type, property.name);
    if (has_masses(column, prim)) add("float[]", masses);
  }
  return text;
}

std::string usd_faces(const MeshRows& mesh, const std::string& time) {
  const auto joined = [](const auto& numbers) {
    return fmt::format("[{}]", fmt::join(numbers, ", "));
  };
  return usd_sample("int[]", "faceVertexCounts", time,
                    joined(std::vector<int>(mesh.triangles(), 3))) +
         usd_sample("int[]", "faceVertexIndices", time, joined(mesh.corners)) +
         usd_sample("normal3f[]", "normals", time,
                    usd_list({0, mesh.vertices}, [&](std::size_t v, std::string& list) {
                      const float* n = mesh.normal.data() + 3 * v;
                      list += usd_tuple({n[0], n[1], n[2]});
                    }));
}

}  // namespace

std::vector<std::pair<UsdPrim, std::string>> usd_prims(const scene::Export& spec) {
  if (!spec.surface) return {{UsdPrim::points, spec.dust ? "dust" : "snow"}};
  return {{UsdPrim::mesh, "snow"}, {UsdPrim::points, "spray"}};
}

std::string usd_declarations(const Table& columns, UsdPrim prim, const std::string& indent) {
  std::string text = indent + "float3[] extent\n";
  if (prim == UsdPrim::mesh)
    text += indent + "int[] faceVertexCounts\n" + indent + "int[] faceVertexIndices\n" + indent +
            "normal3f[] normals (\n" + indent + "    interpolation = \"vertex\"\n" + indent + ")\n";
  for (const Column& column : columns.columns) {
    const UsdProperty property = property_of(column, prim);
    if (has_masses(column, prim)) text += indent + "float[] " + masses + "\n";
    text += indent + property.type + " " + property.name;
    if (property.is_primvar || property.name == "widths") {
      text += " (\n";
      // A tensor needs more than one element a point.
      if (column.components == 9) text += indent + "    elementSize = 9\n";
      text += indent + "    interpolation = \"vertex\"\n" + indent + ")";
    }
    text += "\n";
  }
  return text;
}

std::string encode_usda(const ExportMoment& moment) {
  const double frame = moment.frame();
  const std::string indent(8, ' '), time = usd_number(frame);
  const Table& table = moment.table;
  std::string text = usd_header(moment.scene, moment.spec, frame, frame) +
                     "def Xform \"neve\"\n{\n" + usd_world(moment.scene, moment.spec);
  for (const auto& [prim, name] : usd_prims(moment.spec)) {
    const bool is_mesh = prim == UsdPrim::mesh;
    const std::size_t middle = table.mesh ? table.mesh->vertices : 0;
    const RowRange rows = is_mesh ? RowRange{0, middle} : RowRange{middle, table.rows};
    text += "    def " + std::string(usd_type(prim)) + " \"" + name + "\"\n    {\n" +
            usd_fixed(prim, indent) + usd_declarations(table, prim, indent) +
            (is_mesh ? usd_faces(*table.mesh, time) : std::string()) +
            usd_columns(table, prim, rows, time) + "    }\n";
  }
  return text + "}\n";
}

}  // namespace neve::app::exports

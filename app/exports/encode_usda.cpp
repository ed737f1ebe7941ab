#include <algorithm>
#include <array>

#include "app/exports/encode.h"
#include "app/exports/usda.h"

namespace neve::app::exports {

namespace {

using scene::ExportAttribute;

/// A property of Points: its type, its name, and the text of its value.
struct UsdProperty {
  std::string type, name;
  bool is_primvar = false;
};

UsdProperty property_of(const Column& column) {
  static constexpr std::array scalars{"float[]", "double[]", "int[]"};
  switch (column.attribute) {
    case ExportAttribute::x:
      return {"point3f[]", "points"};
    case ExportAttribute::v:
      return {"vector3f[]", "velocities"};
    case ExportAttribute::id:
      return {"int64[]", "ids"};
    case ExportAttribute::radius:
      return {"float[]", "widths"};
    default:
      return {scalars[column.numbers.index()], "primvars:" + column.name, true};
  }
}

/// USD has places, velocities and widths in single precision; widths are diameters.
template <class Number>
void append_usd_number(ExportAttribute attribute, Number number, std::string& text) {
  if (attribute == ExportAttribute::radius)
    append_text(static_cast<float>(2 * number), text);
  else if (attribute == ExportAttribute::x || attribute == ExportAttribute::v)
    append_text(static_cast<float>(number), text);
  else
    append_text(number, text);
}

/// "(1, 2, 3)" of a vector; the numbers of a tensor are nine elements, row by row.
void append_usd_row(const Column& column, std::size_t row, std::string& text) {
  const bool is_vector = column.components == 3;
  const char* before = is_vector ? "(" : "";
  for_row(column, row, [&](auto number) {
    text += before;
    before = ", ";
    append_usd_number(column.attribute, number, text);
  });
  if (is_vector) text += ')';
}

/// Lowest and highest place, as far out as the points are wide.
std::string extent_of(const Table& table) {
  const std::vector<double>& x = table.places();
  if (x.empty()) return "[(0, 0, 0), (0, 0, 0)]";
  sim::Vec3d low(x[0], x[1], x[2]), high = low;
  double widest = 0;
  for (std::size_t p = 0; p < table.rows; ++p) {
    const sim::Vec3d place(x[3 * p], x[3 * p + 1], x[3 * p + 2]);
    low = low.cwiseMin(place);
    high = high.cwiseMax(place);
  }
  if (const Column* radius = table.find(ExportAttribute::radius))
    for (const double r : std::get<std::vector<double>>(radius->numbers))
      widest = std::max(widest, r);
  const sim::Vec3d margin = sim::Vec3d::Constant(widest);
  return "[" + usd_tuple(low - margin) + ", " + usd_tuple(high + margin) + "]";
}

}  // namespace

std::string usd_declarations(const Table& columns, const std::string& indent) {
  std::string text = indent + "float3[] extent\n";
  for (const Column& column : columns.columns) {
    const UsdProperty property = property_of(column);
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

std::string encode_usda(const Moment& moment) {
  const double frame = moment.frame();
  const std::string indent(8, ' '), time = usd_number(frame);
  std::string text = usd_header(moment.scene, moment.spec, frame, frame) +
                     "def Xform \"neve\"\n{\n    def Points \"snow\"\n    {\n" +
                     usd_declarations(moment.table, indent);
  text += indent + "float3[] extent.timeSamples = {\n" + indent + "    " + time + ": " +
          extent_of(moment.table) + ",\n" + indent + "}\n";
  for (const Column& column : moment.table.columns) {
    const UsdProperty property = property_of(column);
    text += indent + property.type + " " + property.name + ".timeSamples = {\n" + indent + "    " +
            time + ": [";
    for (std::size_t row = 0; row < moment.table.rows; ++row) {
      if (row > 0) text += ", ";
      append_usd_row(column, row, text);
    }
    text += "],\n" + indent + "}\n";
  }
  return text + "    }\n}\n";
}

}  // namespace neve::app::exports

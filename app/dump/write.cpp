#include "app/dump/write.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>

#include "app/support/text.h"

namespace neve::app::dump {

namespace {

/// The shortest text that reads as the same bits.
template <class T>
std::string digits(T value) {
  char text[40];
  return {text, std::to_chars(text, text + sizeof text, value).ptr};
}

/// Of a run in single precision; its places are of double precision all the same.
bool is_single(const Quantity& q) {
  return q.name != "x" && std::all_of(q.values.begin(), q.values.end(), [](double value) {
           return std::isnan(value) || static_cast<double>(static_cast<float>(value)) == value;
         });
}

std::string value_text(const Quantity& q, double value) {
  return is_index(q) ? fixed_text(value, 0) : rough_text(value);
}

std::string expected_text(const Quantity& q) {
  if (!q.expected) return "";
  const scene::Range r = *q.expected;
  if (!std::isfinite(r.max)) return "any (" + q.why + ")";
  return rough_text(r.min) + " to " + rough_text(r.max) + " (" + q.why + ")";
}

std::string title(const Quantity& q) {
  return q.name + (q.unit.empty() ? "" : " (" + q.unit + ")");
}

/// Title of the quantity whose extremes are printed: |v| of vectors and tensors.
std::string summary_title(const Quantity& q) {
  if (q.components == 1) return title(q);
  return "|" + q.name + "|" + (q.unit.empty() ? "" : " (" + q.unit + ")");
}

std::string found_text(const Quantity& q, double value) {
  return std::isnan(value) ? "-" : value_text(q, value);
}

/// Padded on the right to a width, at least one space.
std::string column_text(const std::string& text, std::size_t width) {
  return text + std::string(text.size() < width ? width - text.size() : 1, ' ');
}

template <class T>
void append_block(const std::vector<T>& values, std::string& bytes) {
  const std::uint64_t size = values.size() * sizeof(T);
  bytes.append(reinterpret_cast<const char*>(&size), sizeof size);
  bytes.append(reinterpret_cast<const char*>(values.data()), size);
}

}  // namespace

std::vector<std::string> summary_lines(const Listing& listing) {
  std::vector<std::string> lines;
  lines.push_back(column_text("quantity", 22) + column_text("least", 12) +
                  column_text("greatest", 12) + column_text("outside", 9) + "expected");
  for (const Quantity& q : listing.quantities) {
    if (is_index(q) && q.components > 1) continue;  // the length of i, j, k means nothing
    const Extremes e = extremes(listing, q);
    lines.push_back(
        column_text(summary_title(q), 22) + column_text(found_text(q, e.least), 12) +
        column_text(found_text(q, e.greatest), 12) +
        column_text(q.expected || e.outside_expected > 0 ? std::to_string(e.outside_expected) : "-",
                    9) +
        expected_text(q));
  }
  return lines;
}

std::string to_table(const Listing& listing, const std::vector<std::string>& heading) {
  // Names first: numpy takes them from the first line, and comments anywhere below.
  std::string text;
  for (const Quantity& q : listing.quantities)
    for (int c = 0; c < q.components; ++c)
      text += (text.empty() ? "" : "\t") + component_name(q, c);
  text += "\n";
  for (const std::string& line : heading) text += "# " + line + "\n";
  for (const std::string& line : summary_lines(listing)) text += "# " + line + "\n";
  std::vector<bool> are_single;
  for (const Quantity& q : listing.quantities) are_single.push_back(is_single(q));
  for (std::size_t row = 0; row < listing.place.size(); ++row) {
    const std::size_t begin = text.size();
    for (std::size_t k = 0; k < listing.quantities.size(); ++k) {
      const Quantity& q = listing.quantities[k];
      const auto width = static_cast<std::size_t>(q.components);
      for (std::size_t at = row * width; at < (row + 1) * width; ++at) {
        if (text.size() > begin) text += '\t';
        text += are_single[k] ? digits(static_cast<float>(q.values[at])) : digits(q.values[at]);
      }
    }
    text += '\n';
  }
  return text;
}

std::string to_vtk(const Listing& listing) {
  const std::size_t count = listing.place.size();
  std::vector<double> points;
  for (const sim::Vec3d& x : listing.place)
    for (int a = 0; a < 3; ++a) points.push_back(x[a]);
  std::vector<std::int64_t> vertices(count), ends(count);
  for (std::size_t k = 0; k < count; ++k) {
    vertices[k] = static_cast<std::int64_t>(k);
    ends[k] = static_cast<std::int64_t>(k + 1);
  }
  std::size_t offset = 0;
  const auto array = [&](const char* type, const std::string& name, int components,
                         std::size_t numbers) {
    std::string xml = std::string("<DataArray type=\"") + type + "\" Name=\"" + name +
                      "\" NumberOfComponents=\"" + std::to_string(components) +
                      "\" format=\"appended\" offset=\"" + std::to_string(offset) + "\"/>\n";
    offset += sizeof(std::uint64_t) + 8 * numbers;
    return xml;
  };
  std::string text =
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"1.0\" "
      "byte_order=\"LittleEndian\" header_type=\"UInt64\">\n<PolyData>\n<Piece NumberOfPoints=\"" +
      std::to_string(count) + "\" NumberOfVerts=\"" + std::to_string(count) +
      "\" NumberOfLines=\"0\" NumberOfStrips=\"0\" NumberOfPolys=\"0\">\n<Points>\n";
  text += array("Float64", "Points", 3, points.size());
  text += "</Points>\n<Verts>\n";
  text += array("Int64", "connectivity", 1, count);
  text += array("Int64", "offsets", 1, count);
  text += "</Verts>\n<PointData>\n";
  for (const Quantity& q : listing.quantities)
    text += array("Float64", q.name, q.components, q.values.size());
  text += "</PointData>\n</Piece>\n</PolyData>\n<AppendedData encoding=\"raw\">\n_";
  append_block(points, text);
  append_block(vertices, text);
  append_block(ends, text);
  for (const Quantity& q : listing.quantities) append_block(q.values, text);
  return text + "\n</AppendedData>\n</VTKFile>\n";
}

std::vector<std::string> probe_lines(const Listing& listing, std::size_t row) {
  std::vector<std::string> lines;
  for (const Quantity& q : listing.quantities) {
    std::string value;
    const auto width = static_cast<std::size_t>(q.components);
    for (std::size_t c = 0; c < width; ++c)
      value += (c == 0 ? "" : c % 3 == 0 ? "; " : " ") + value_text(q, q.values[row * width + c]);
    lines.push_back((q.is_outside_expected(row) ? "! " : "  ") + column_text(title(q), 22) +
                    column_text(value, 30) +
                    (q.components > 1 && q.expected
                         ? "magnitude " + rough_text(q.magnitude(row)) + ", expected "
                     : q.expected ? "expected "
                                  : "") +
                    expected_text(q));
  }
  return lines;
}

Json summary_json(const Listing& listing) {
  Json list = Json::array();
  for (const Quantity& q : listing.quantities) {
    const Extremes e = extremes(listing, q);
    Json json = {{"name", q.name},
                 {"unit", q.unit},
                 {"components", q.components},
                 {"is_magnitude", q.components > 1},
                 {"least", number_or_null(e.least)},
                 {"greatest", number_or_null(e.greatest)},
                 {"outside", e.outside_expected}};
    if (q.expected) {
      json["expected"] = {number_or_null(q.expected->min), number_or_null(q.expected->max)};
      json["why"] = q.why;
    }
    list.push_back(json);
  }
  return list;
}

Json probe_json(const Listing& listing, std::size_t row) {
  Json json = Json::object();
  for (const Quantity& q : listing.quantities) {
    const auto width = static_cast<std::size_t>(q.components);
    Json value = Json::array();
    for (std::size_t c = 0; c < width; ++c)
      value.push_back(number_or_null(q.values[row * width + c]));
    json[q.name] = {{"value", width == 1 ? value[0] : value},
                    {"strange", q.is_outside_expected(row)}};
    if (q.expected)
      json[q.name]["expected"] = {number_or_null(q.expected->min), number_or_null(q.expected->max)};
  }
  return json;
}

}  // namespace neve::app::dump

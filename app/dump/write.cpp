#include "app/dump/quantities.h"

#include <algorithm>
#include <cmath>

#include "app/exports/bytes.h"
#include "app/exports/encode.h"
#include "app/support/text.h"

namespace neve::app::dump {

namespace {

/// True if all values fit single precision, as in such a run. Places are doubles in any run.
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
        if (are_single[k])
          exports::append_text(static_cast<float>(q.values[at]), text);
        else
          exports::append_text(q.values[at], text);
      }
    }
    text += '\n';
  }
  return text;
}

std::string to_vtk(const Listing& listing) {
  exports::Table table;
  table.rows = listing.place.size();
  std::vector<double> points;
  for (const sim::Vec3d& x : listing.place) points.insert(points.end(), x.data(), x.data() + 3);
  table.columns.push_back({scene::ExportAttribute::x, "x", "m", 3, points});
  for (const Quantity& q : listing.quantities)
    table.columns.push_back({std::nullopt, q.name, q.unit, q.components, q.values});
  return exports::vtp_text(table);
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

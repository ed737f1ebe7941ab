#include <algorithm>

#include "sim/files/input_file.h"
#include "sim/files/ply_header.h"
#include "sim/files/point_table.h"

namespace neve::sim::files {
namespace {

/// Elements after the points are ignored. @param has_more  gets whether there are any
PlyHeader header_of_points(TableLines& lines, const std::string& name, bool& has_more) {
  PlyHeader header = read_ply_header(lines, name);
  std::vector<PlyElement>& elements = header.elements;
  const auto points = std::find_if(elements.begin(), elements.end(), [](const PlyElement& element) {
    return element.name == "vertex";
  });
  if (points == elements.end()) refuse_input(name, "the PLY has no element vertex");
  has_more = points + 1 != elements.end();
  elements.erase(points + 1, elements.end());
  return header;
}

/// Bytes of a row whose lists are empty.
std::size_t min_row_size(const PlyElement& element) {
  std::size_t bytes = 0;
  for (const PlyProperty& property : element.properties)
    bytes += property.count ? property.count->size : property.type.size;
  return bytes;
}

class PointPly {
 public:
  PointPly(std::string_view bytes, const std::string& name)
      : lines_(bytes), name_(name), header_(header_of_points(lines_, name, has_more_)) {
    for (const PlyProperty& property : header_.elements.back().properties)
      if (!property.count) columns_.push_back(property.name);
  }

  PointCloud read(const std::vector<std::string>& further) {
    const PlyElement& element = header_.elements.back();
    PointTable points(columns_, element.where);
    points.carry(further, columns_, column_types(element), element.where);
    points.use(header_.axes);
    if (header_.format == PlyFormat::ascii)
      read_text(points);
    else
      read_binary(points);
    return points.take(name_);
  }

  std::vector<std::string> further() const { return unknown_columns(columns_); }

 private:
  std::string here() const { return name_ + ":" + std::to_string(lines_.number()); }

  static std::vector<PointColumn::Type> column_types(const PlyElement& element) {
    using enum PointColumn::Type;
    std::vector<PointColumn::Type> types;
    for (const PlyProperty& property : element.properties) {
      if (property.count) continue;
      const PlyType type = property.type;
      const bool fits = type.size < 4 || type.kind == PlyType::is_signed;
      if (type.kind == PlyType::is_float)
        types.push_back(type.size == 4 ? real32 : real64);
      else
        types.push_back(fits ? int32 : real64);
    }
    return types;
  }

  /// Compares the count of the header with the bytes left in the file, at a least size of a row.
  static void check_count(const PlyElement& element, std::size_t row_size, std::size_t left) {
    if (row_size > 0 && element.count > left / row_size)
      refuse_input(element.where, "truncated: the header promises " +
                                      std::to_string(element.count) + " of " +
                                      quoted_input(element.name) + ", which the " +
                                      std::to_string(left) + " bytes after it cannot hold");
  }

  void read_text(PointTable& points) {
    std::vector<double> row;
    for (const PlyElement& element : header_.elements) {
      // A digit and what ends it for every number; the last may end with the file.
      check_count(element, 2 * element.properties.size(), lines_.rest().size() + 1);
      const bool is_points = &element == &header_.elements.back();
      if (is_points) points.reserve(element.count);
      for (std::uint64_t k = 0; k < element.count; ++k) {
        if (lines_.at_end())
          refuse_input(name_, "truncated: it ends after " + std::to_string(k) + " of " +
                                  std::to_string(element.count) + " of " +
                                  quoted_input(element.name));
        const std::string_view line = lines_.next();
        if (!is_points) continue;
        read_text_row(line, element, row);
        points.add(row, [&] { return here(); });
      }
    }
    while (!has_more_ && !lines_.at_end())
      if (!trimmed(lines_.next()).empty()) refuse_more(here());
  }

  void read_text_row(std::string_view line, const PlyElement& element,
                     std::vector<double>& row) const {
    row.clear();
    const auto next = [&] {
      const std::string_view word = next_ply_word(line);
      if (word.empty())
        refuse_input(here(), std::to_string(row.size()) + " numbers; the header has " +
                                 std::to_string(element.properties.size()) + " properties");
      return word;
    };
    for (const PlyProperty& property : element.properties) {
      const std::string_view word = next();
      const std::optional<double> value = number_in(word);
      if (!value)
        refuse_input(here(),
                     quoted_input(word) + " is not a number, in " +
                         (property.count ? "a list" : "property " + quoted_input(property.name)));
      if (!property.count) row.push_back(*value);
      // Every number of a list has a character at least.
      const double length = property.count ? *value : 0;
      if (!(length >= 0 && length <= static_cast<double>(line.size())))
        refuse_input(here(), "a list is longer than its line");
      for (double k = 0; k < length; ++k) next();
    }
    if (!next_ply_word(line).empty())
      refuse_input(here(), "more numbers than the header's " +
                               std::to_string(element.properties.size()) + " properties");
  }

  void read_binary(PointTable& points) {
    std::string_view bytes = lines_.rest();
    std::vector<double> row;
    for (const PlyElement& element : header_.elements) {
      check_count(element, min_row_size(element), bytes.size());
      const bool is_points = &element == &header_.elements.back();
      if (is_points) points.reserve(element.count);
      for (std::uint64_t p = 0; p < element.count && !element.properties.empty(); ++p) {
        row.clear();
        for (const PlyProperty& property : element.properties)
          read_binary_property(property, bytes, row);
        if (is_points) points.add(row, [&] { return name_ + ": point " + std::to_string(p + 1); });
      }
    }
    // Some writers end with a byte or two of their own.
    if (!has_more_ && bytes.size() >= min_row_size(header_.elements.back())) refuse_more(name_);
  }

  /// Refuses what would be missing, and nobody would know.
  [[noreturn]] void refuse_more(const std::string& where) const {
    const PlyElement& element = header_.elements.back();
    refuse_input(where, "more data than the " + std::to_string(element.count) + " of " +
                            quoted_input(element.name) + " that the header promises");
  }

  void read_binary_property(const PlyProperty& property, std::string_view& bytes,
                            std::vector<double>& row) const {
    const auto take = [&](PlyType type) {
      if (bytes.size() < type.size) refuse_input(name_, "truncated: the points are incomplete");
      const double value = binary_number(bytes, type, header_.format);
      bytes.remove_prefix(type.size);
      return value;
    };
    if (!property.count) return row.push_back(take(property.type));
    const double count = take(*property.count), left = static_cast<double>(bytes.size());
    if (!(count >= 0 && count * static_cast<double>(property.type.size) <= left))
      refuse_input(name_, "truncated: a list is longer than the file");
    bytes.remove_prefix(static_cast<std::size_t>(count) * property.type.size);
  }

  TableLines lines_;
  const std::string& name_;
  bool has_more_ = false;             ///< elements after the points
  PlyHeader header_;                  ///< up to the points, which are the last
  std::vector<std::string> columns_;  ///< of the points
};

}  // namespace

PointCloud parse_ply_points(std::string_view bytes, const std::string& name,
                            const std::vector<std::string>& further) {
  return PointPly(bytes, name).read(further);
}

std::vector<std::string> further_ply_columns(std::string_view bytes, const std::string& name) {
  return PointPly(bytes, name).further();
}

}  // namespace neve::sim::files

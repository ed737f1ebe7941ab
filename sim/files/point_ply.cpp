// An own reader rather than RPly (Debian's librply), which reads numbers of ascii files by the
// locale, tells neither the line nor the file of an error, and takes values that are missing
// from the next line; happly and miniply are no packages. Lists are passed over.
#include <algorithm>
#include <charconv>
#include <system_error>

#include "sim/files/input_file.h"
#include "sim/files/ply_types.h"
#include "sim/files/point_table.h"

namespace neve::sim::files {
namespace {

/// A table of the file: vertex, face and so on.
struct PlyElement {
  std::string name;
  std::uint64_t count = 0;  ///< as the header claims
  std::string where;        ///< of its line in the header
  /// A single number, or a list of numbers behind their count.
  struct Property {
    PlyType type;
    std::optional<PlyType> count;
  };
  std::vector<Property> properties;
  std::vector<PlyType> types;        ///< of the single numbers
  std::vector<std::string> columns;  ///< their names

  /// Bytes of a row whose lists are empty.
  std::size_t min_row_size() const {
    std::size_t bytes = 0;
    for (const Property& property : properties)
      bytes += property.count ? property.count->size : property.type.size;
    return bytes;
  }
};

struct PlyHeader {
  enum class Format { none, ascii, little, big } format = Format::none;
  std::vector<PlyElement> elements;  ///< up to the points, which are the last
};

class PlyHeaderReader {
 public:
  PlyHeaderReader(TableLines& lines, const std::string& name) : lines_(lines), name_(name) {}

  PlyHeader read() {
    while (read_line()) {
    }
    if (header_.format == PlyHeader::Format::none)
      refuse_input(name_, "the header of the PLY names no format");
    keep_up_to_points();
    return std::move(header_);
  }

 private:
  std::string here() const { return name_ + ":" + std::to_string(lines_.number()); }

  /// @return whether more follows
  bool read_line() {
    if (lines_.at_end()) refuse_input(name_, "the header of the PLY ends without end_header");
    std::string_view line = lines_.next();
    const std::string_view keyword = next_ply_word(line);
    if (keyword == "end_header") return false;
    if (keyword == "ply" || keyword == "comment" || keyword == "obj_info") return true;
    if (keyword == "format")
      read_format(line);
    else if (keyword == "element")
      read_element(line);
    else if (keyword == "property")
      read_property(line);
    else
      refuse_input(here(), quoted_input(keyword) + " is not a keyword of a PLY header");
    return true;
  }

  void read_format(std::string_view line) {
    using enum PlyHeader::Format;
    const std::string_view word = next_ply_word(line);
    if (word == "ascii")
      header_.format = ascii;
    else if (word == "binary_little_endian")
      header_.format = little;
    else if (word == "binary_big_endian")
      header_.format = big;
    else
      refuse_input(here(), "the format " + quoted_input(word) +
                               "; expected ascii, binary_little_endian or binary_big_endian");
  }

  void read_element(std::string_view line) {
    const std::string_view name = next_ply_word(line);
    const std::string_view count = next_ply_word(line);
    for (const PlyElement& other : header_.elements)
      if (other.name == name) refuse_input(here(), "a second element " + quoted_input(name));
    if (header_.elements.size() == max_columns) refuse_input(here(), "more than 256 elements");
    PlyElement& element = header_.elements.emplace_back();
    element.name = name;
    element.where = here();
    const char* end = count.data() + count.size();
    const auto [stop, error] = std::from_chars(count.data(), end, element.count);
    if (count.empty() || error != std::errc{} || stop != end)
      refuse_input(here(), quoted_input(count) + " is not a number of elements");
  }

  void read_property(std::string_view line) {
    if (header_.elements.empty()) refuse_input(here(), "a property before the first element");
    PlyElement& element = header_.elements.back();
    if (element.properties.size() == max_columns) refuse_input(here(), "more than 256 properties");
    std::string_view rest = line;
    const bool is_list = next_ply_word(rest) == "list";
    if (is_list) line = rest;
    std::optional<PlyType> count;
    if (is_list) count = type_in(line);
    const PlyType type = type_in(line);
    element.properties.push_back({type, count});
    if (is_list) return;
    element.types.push_back(type);
    element.columns.emplace_back(next_ply_word(line));
  }

  PlyType type_in(std::string_view& line) const {
    const std::string_view word = next_ply_word(line);
    const std::optional<PlyType> type = type_called(word);
    if (!type) refuse_input(here(), quoted_input(word) + " is not a type of PLY");
    return *type;
  }

  /// Elements after the points are ignored.
  void keep_up_to_points() {
    std::vector<PlyElement>& elements = header_.elements;
    const auto points =
        std::find_if(elements.begin(), elements.end(),
                     [](const PlyElement& element) { return element.name == "vertex"; });
    if (points == elements.end()) refuse_input(name_, "the PLY has no element vertex");
    elements.erase(points + 1, elements.end());
  }

  TableLines& lines_;
  const std::string& name_;
  PlyHeader header_;
};

class PointPly {
 public:
  PointPly(std::string_view bytes, const std::string& name)
      : lines_(bytes), name_(name), header_(PlyHeaderReader(lines_, name).read()) {}

  PointCloud read(const std::vector<std::string>& further) {
    const PlyElement& element = header_.elements.back();
    PointTable points(element.columns, element.where);
    points.carry(further, element.columns, column_types(element), element.where);
    if (header_.format == PlyHeader::Format::ascii)
      read_text(points);
    else
      read_binary(points);
    return points.take(name_);
  }

  std::vector<std::string> further() const {
    return unknown_columns(header_.elements.back().columns);
  }

 private:
  std::string here() const { return name_ + ":" + std::to_string(lines_.number()); }

  static std::vector<PointColumn::Type> column_types(const PlyElement& element) {
    using enum PointColumn::Type;
    std::vector<PointColumn::Type> types;
    for (const PlyType& type : element.types) {
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
    for (const PlyElement::Property& property : element.properties) {
      const std::string_view word = next();
      const std::optional<double> value = number_in(word);
      if (!value)
        refuse_input(
            here(), quoted_input(word) + " is not a number, in " +
                        (property.count ? "a list"
                                        : "property " + quoted_input(element.columns[row.size()])));
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
      check_count(element, element.min_row_size(), bytes.size());
      const bool is_points = &element == &header_.elements.back();
      if (is_points) points.reserve(element.count);
      for (std::uint64_t p = 0; p < element.count && !element.properties.empty(); ++p) {
        row.clear();
        for (const PlyElement::Property& property : element.properties)
          read_binary_property(property, bytes, row);
        if (is_points) points.add(row, [&] { return name_ + ": point " + std::to_string(p + 1); });
      }
    }
  }

  void read_binary_property(const PlyElement::Property& property, std::string_view& bytes,
                            std::vector<double>& row) const {
    const auto take = [&](PlyType type) {
      if (bytes.size() < type.size) refuse_input(name_, "truncated: the points are incomplete");
      const double value = number_of(bits(bytes, type.size), type);
      bytes.remove_prefix(type.size);
      return value;
    };
    if (!property.count) return row.push_back(take(property.type));
    const double count = take(*property.count), left = static_cast<double>(bytes.size());
    if (!(count >= 0 && count * static_cast<double>(property.type.size) <= left))
      refuse_input(name_, "truncated: a list is longer than the file");
    bytes.remove_prefix(static_cast<std::size_t>(count) * property.type.size);
  }

  std::uint64_t bits(std::string_view bytes, std::size_t size) const {
    std::uint64_t value = 0;
    for (std::size_t k = 0; k < size; ++k) {
      const bool is_little = header_.format == PlyHeader::Format::little;
      const std::size_t place = is_little ? k : size - 1 - k;
      value |= static_cast<std::uint64_t>(static_cast<unsigned char>(bytes[k])) << (8 * place);
    }
    return value;
  }

  TableLines lines_;
  const std::string& name_;
  PlyHeader header_;
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

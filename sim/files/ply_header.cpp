// An own reader rather than RPly (Debian's librply), which reads numbers of ascii files by the
// locale, tells neither the line nor the file of an error, and takes values that are missing
// from the next line; happly and miniply are no packages.
#include "sim/files/ply_header.h"

#include <charconv>
#include <system_error>
#include <utility>

namespace neve::sim::files {
namespace {

/// Returns the type of a name; nothing for names that are no type.
std::optional<PlyType> type_called(std::string_view name) {
  if (name == "char" || name == "int8") return PlyType{1, PlyType::is_signed};
  if (name == "uchar" || name == "uint8") return PlyType{1, PlyType::is_unsigned};
  if (name == "short" || name == "int16") return PlyType{2, PlyType::is_signed};
  if (name == "ushort" || name == "uint16") return PlyType{2, PlyType::is_unsigned};
  if (name == "int" || name == "int32") return PlyType{4, PlyType::is_signed};
  if (name == "uint" || name == "uint32") return PlyType{4, PlyType::is_unsigned};
  if (name == "float" || name == "float32") return PlyType{4, PlyType::is_float};
  if (name == "double" || name == "float64") return PlyType{8, PlyType::is_float};
  return std::nullopt;
}

class PlyHeaderReader {
 public:
  PlyHeaderReader(TableLines& lines, const std::string& name) : lines_(lines), name_(name) {}

  PlyHeader read() {
    while (read_line()) {
    }
    if (header_.format == PlyFormat::none)
      refuse_input(name_, "the header of the PLY names no format");
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
    if (keyword == "comment" && axes_.read(line, here())) header_.axes = axes_.axes();
    if (keyword.empty() || keyword == "comment" || keyword == "obj_info") return true;
    if (keyword == "format")
      read_format(line);
    else if (keyword == "element")
      read_element(line);
    else if (keyword == "property")
      read_property(line);
    else if (!header_.elements.empty())
      refuse_input(here(), quoted_input(keyword) + " is not a keyword of a PLY header");
    return true;
  }

  void read_format(std::string_view line) {
    using enum PlyFormat;
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
    element.properties.push_back({std::string(next_ply_word(line)), type, count});
  }

  PlyType type_in(std::string_view& line) const {
    const std::string_view word = next_ply_word(line);
    const std::optional<PlyType> type = type_called(word);
    if (!type) refuse_input(here(), quoted_input(word) + " is not a type of PLY");
    return *type;
  }

  TableLines& lines_;
  const std::string& name_;
  PlyHeader header_;
  AxesComment axes_;
};

}  // namespace

PlyHeader read_ply_header(TableLines& lines, const std::string& name) {
  return PlyHeaderReader(lines, name).read();
}

}  // namespace neve::sim::files

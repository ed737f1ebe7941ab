#pragma once
/// Headers and numbers of PLY files, for the readers of points and of meshes.

#include <bit>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "sim/files/file_axes.h"
#include "sim/files/input_file.h"
#include "sim/files/point_table.h"

namespace neve::sim::files {

struct PlyType {
  std::size_t size;  ///< bytes
  enum Kind { is_signed, is_unsigned, is_float } kind;
};

/// Returns the number of up to 8 bytes, the least significant first.
inline double number_of(std::uint64_t bits, PlyType type) {
  if (type.kind == PlyType::is_unsigned) return static_cast<double>(bits);
  if (type.kind == PlyType::is_float && type.size == 4)
    return static_cast<double>(std::bit_cast<float>(static_cast<std::uint32_t>(bits)));
  if (type.kind == PlyType::is_float) return std::bit_cast<double>(bits);
  const auto unused = static_cast<unsigned>(64 - 8 * type.size);
  return static_cast<double>(static_cast<std::int64_t>(bits << unused) >> unused);
}

enum class PlyFormat { none, ascii, little, big };

/// The number at the beginning of bytes, which has to be there.
inline double binary_number(std::string_view bytes, PlyType type, PlyFormat format) {
  std::uint64_t bits = 0;
  for (std::size_t k = 0; k < type.size; ++k) {
    const std::size_t place = format == PlyFormat::little ? k : type.size - 1 - k;
    bits |= static_cast<std::uint64_t>(static_cast<unsigned char>(bytes[k])) << (8 * place);
  }
  return number_of(bits, type);
}

/// A single number, or a list of numbers behind their count.
struct PlyProperty {
  std::string name;
  PlyType type;
  std::optional<PlyType> count;
};

/// A table of the file: vertex, face and so on.
struct PlyElement {
  std::string name;
  std::uint64_t count = 0;  ///< as the header claims
  std::string where;        ///< of its line in the header
  std::vector<PlyProperty> properties;
};

struct PlyHeader {
  PlyFormat format = PlyFormat::none;
  std::vector<PlyElement> elements;
  FileAxes axes;  ///< other than metres, y up, only of a file that neve says it wrote
};

/// Removes the first word of a line. @return "" at its end
inline std::string_view next_ply_word(std::string_view& line) {
  line = trimmed(line);
  std::size_t end = 0;
  while (end < line.size() && !is_blank(line[end])) ++end;
  const std::string_view word = line.substr(0, end);
  line.remove_prefix(end);
  return word;
}

/// Reads up to end_header. Before the first element other words than those of PLY are remarks:
/// Blender wrote "Created by" without "comment".
/// @throws ShapeError with the line
PlyHeader read_ply_header(TableLines& lines, const std::string& name);

}  // namespace neve::sim::files

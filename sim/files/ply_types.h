#pragma once
/// Numbers and words of PLY files, for the readers of points and of meshes.

#include <bit>
#include <cstdint>
#include <optional>
#include <string_view>

#include "sim/files/input_file.h"

namespace neve::sim::files {

struct PlyType {
  std::size_t size;  ///< bytes
  enum Kind { is_signed, is_unsigned, is_float } kind;
};

/// Nothing for names that are no type.
inline std::optional<PlyType> type_called(std::string_view name) {
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

/// Up to 8 bytes, the least significant first.
inline double number_of(std::uint64_t bits, PlyType type) {
  if (type.kind == PlyType::is_unsigned) return static_cast<double>(bits);
  if (type.kind == PlyType::is_float && type.size == 4)
    return static_cast<double>(std::bit_cast<float>(static_cast<std::uint32_t>(bits)));
  if (type.kind == PlyType::is_float) return std::bit_cast<double>(bits);
  const auto unused = static_cast<unsigned>(64 - 8 * type.size);
  return static_cast<double>(static_cast<std::int64_t>(bits << unused) >> unused);
}

/// Removes the first word of a line. @return "" at its end
inline std::string_view next_ply_word(std::string_view& line) {
  line = trimmed(line);
  std::size_t end = 0;
  while (end < line.size() && !is_blank(line[end])) ++end;
  const std::string_view word = line.substr(0, end);
  line.remove_prefix(end);
  return word;
}

}  // namespace neve::sim::files

#pragma once
/// Numbers as bytes of files.

#include <bit>
#include <charconv>
#include <concepts>
#include <cstdint>
#include <cstring>
#include <string>
#include <type_traits>
#include <vector>

#include "app/exports/columns.h"

namespace neve::app::exports {

static_assert(std::endian::native == std::endian::little,
              "numbers are written in the byte order of this machine");

template <class T>
requires std::is_arithmetic_v<T>
void append_little(T value, std::string& bytes) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

template <class T>
requires std::is_arithmetic_v<T>
void append_big(T value, std::string& bytes) {
  char text[sizeof value];
  std::memcpy(text, &value, sizeof value);
  for (std::size_t k = sizeof value; k-- > 0;) bytes.push_back(text[k]);
}

template <class T>
void append_all(const std::vector<T>& values, std::string& bytes) {
  bytes.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
}

/// The shortest text that reads as the same bits.
template <class T>
requires std::is_arithmetic_v<T>
void append_text(T value, std::string& text) {
  char digits[40];
  text.append(digits, std::to_chars(digits, digits + sizeof digits, value).ptr);
}

/// Calls for each number of a row, with its type.
template <class Use>
void for_row(const Column& column, std::size_t row, const Use& use) {
  const auto width = static_cast<std::size_t>(column.components);
  std::visit(
      [&](const auto& numbers) {
        for (std::size_t k = 0; k < width; ++k) use(numbers[row * width + k]);
      },
      column.numbers);
}

inline std::size_t row_size(const Table& table) {
  std::size_t bytes = 0;
  for (const Column& column : table.columns)
    bytes += number_size(column) * static_cast<std::size_t>(column.components);
  return bytes;
}

}  // namespace neve::app::exports

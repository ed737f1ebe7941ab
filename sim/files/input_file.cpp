#include "sim/files/input_file.h"

#include <charconv>
#include <filesystem>
#include <fstream>
#include <system_error>

#include "sim/base/byte_order_mark.h"
#include "sim/types/errors.h"

namespace neve::sim::files {

void refuse_input(const std::string& where, const std::string& what) {
  throw ShapeError(where + ": " + what);
}

std::string read_input_file(const std::string& path, std::uintmax_t max_mebibytes,
                            const std::string& whats) {
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) refuse_input(path, "no such file");
  if (!std::filesystem::is_regular_file(status)) refuse_input(path, "not a file");
  const std::uintmax_t size = std::filesystem::file_size(path, error);
  if (error) refuse_input(path, "cannot be read: " + error.message());
  if (size > max_mebibytes << 20)
    refuse_input(path, std::to_string(size >> 20) + " MiB; " + whats + " of up to " +
                           std::to_string(max_mebibytes) + " MiB are read. Simplify the mesh");
  std::ifstream file(path, std::ios::binary);
  std::string bytes(size, '\0');
  file.read(bytes.data(), static_cast<std::streamsize>(size));
  if (!file) refuse_input(path, "cannot be read");
  return bytes;
}

std::string_view plain_text(std::string_view text, const std::string& name) {
  text = without_mark(text);
  if (text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF"))
    refuse_input(name, "the text is UTF-16; save it as UTF-8");
  return text;
}

std::string quoted_input(std::string_view word) {
  std::string shown(word.substr(0, 40));
  for (char& c : shown)
    if (c < ' ' || c > '~') c = '?';
  return '"' + shown + (word.size() > 40 ? "...\"" : "\"");
}

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return text;
}

std::optional<double> number_in(std::string_view word) {
  word = trimmed(word);
  if (word.starts_with('+')) word.remove_prefix(1);
  double value = 0;
  const auto [stop, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc{} || stop != word.data() + word.size()) return std::nullopt;
  return value;
}

}  // namespace neve::sim::files

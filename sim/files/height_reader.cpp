#include "sim/files/height_reader.h"

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "sim/files/height_grid.h"
#include "sim/files/input_file.h"

namespace neve::sim::files {
namespace {

constexpr std::uintmax_t max_mebibytes = 1024;

bool is_tiff(std::string_view bytes) {
  using namespace std::string_view_literals;
  return bytes.starts_with("II*\0"sv) || bytes.starts_with("MM\0*"sv) ||
         bytes.starts_with("II+\0"sv) || bytes.starts_with("MM\0+"sv);
}

bool is_png(std::string_view bytes) {
  return bytes.starts_with("\x89PNG");
}

std::string start_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::string start(512, '\0');
  file.read(start.data(), static_cast<std::streamsize>(start.size()));
  start.resize(static_cast<std::size_t>(std::max<std::streamsize>(file.gcount(), 0)));
  return start;
}

/// The number behind a key of the header of a grid; 0: it is not there.
double number_after(std::string_view text, std::string_view key) {
  const auto same = [](char a, char b) { return (a | 0x20) == (b | 0x20); };
  const auto found = std::search(text.begin(), text.end(), key.begin(), key.end(), same);
  if (found == text.end()) return 0;
  text = trimmed(text.substr(static_cast<std::size_t>(found - text.begin()) + key.size()));
  const auto end = std::find_if(text.begin(), text.end(), [](char c) { return c <= ' '; });
  return number_in(text.substr(0, static_cast<std::size_t>(end - text.begin()))).value_or(0);
}

/// Posts that a file says it has; of a grid no more than its bytes could be.
double posts_in(std::string_view start, double size) {
  if (!is_png(start))
    return std::clamp(number_after(start, "ncols") * number_after(start, "nrows"), 0.0, 0.5 * size);
  if (start.size() < 24) return 0;
  const auto number_at = [&](std::size_t at) {
    double number = 0;
    for (std::size_t k = at; k < at + 4; ++k)
      number = 256 * number + static_cast<unsigned char>(start[k]);
    return number;
  };
  return number_at(16) * number_at(20);
}

}  // namespace

HeightGrid parse_heights(std::string_view bytes, const std::string& name,
                         const HeightScale& scale) {
  // Debian's libgeotiff is 13 packages and 36 MB, with PROJ, and libtiff alone, which does not know
  // where the picture lies, 7 and 5 MB: one command does the same (docs/scenes.md).
  if (is_tiff(bytes))
    refuse_input(name,
                 "a TIFF, which is not read; expected an ESRI ASCII grid or a PNG of 16 bits. Make "
                 "one: gdal_translate -of AAIGrid " +
                     name + " terrain.asc");
  if (is_png(bytes)) return parse_height_png(bytes, name, scale);
  return parse_ascii_grid(bytes, name);
}

HeightGrid read_heights(const std::string& path, const HeightScale& scale) {
  return parse_heights(read_input_file(path, max_mebibytes, "height fields"), path, scale);
}

bool takes_scale(const std::string& path) {
  return is_png(start_of(path));
}

double memory_of_heights(const std::string& path) {
  const std::string start = start_of(path);
  std::error_code error;
  const auto size = std::filesystem::file_size(path, error);
  if (error) return 0;
  // Rows as they are packed and heights of a picture; numbers and heights of a text.
  return static_cast<double>(size) +
         12 * std::min(posts_in(start, static_cast<double>(size)), max_posts);
}

}  // namespace neve::sim::files

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

double memory_of_heights(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::string start(26, '\0');
  file.read(start.data(), static_cast<std::streamsize>(start.size()));
  start.resize(static_cast<std::size_t>(std::max<std::streamsize>(file.gcount(), 0)));
  std::error_code error;
  const auto size = std::filesystem::file_size(path, error);
  if (error) return 0;
  double posts = 0;
  if (is_png(start) && start.size() == 26) {
    const auto number_at = [&](std::size_t at) {
      double number = 0;
      for (std::size_t k = at; k < at + 4; ++k)
        number = 256 * number + static_cast<unsigned char>(start[k]);
      return number;
    };
    posts = std::min(number_at(16) * number_at(20), max_posts);
  } else {
    posts = std::min(0.5 * static_cast<double>(size), max_posts);
  }
  return static_cast<double>(size) + 14 * posts;
}

}  // namespace neve::sim::files

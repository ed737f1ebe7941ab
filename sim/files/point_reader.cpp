#include "sim/files/point_reader.h"

#include "sim/files/input_file.h"

namespace neve::sim::files {

namespace {

bool is_ply_file(std::string_view bytes, const std::string& name) {
  const bool is_ply = bytes.starts_with("ply\n") || bytes.starts_with("ply\r\n");
  if (!is_ply && name.ends_with(".ply"))
    refuse_input(name, "it does not begin with a line \"ply\"; expected a PLY file");
  // The head line of a table is text, and no markup.
  const std::string_view head = bytes.substr(0, bytes.find('\n'));
  const bool is_binary = head.find('\0') != std::string_view::npos || head.starts_with("PK");
  const bool is_mesh =
      name.ends_with(".obj") || head.starts_with("v ") || head.starts_with("#usda");
  if (!is_ply && (is_binary || is_mesh || head.starts_with("<")))
    refuse_input(name,
                 "it is not a table of points; expected PLY or CSV: neve export writes both with "
                 "--format, most programs write PLY");
  return is_ply;
}

std::string bytes_of_points(const std::string& path) {
  return read_input_file(path, 1024, "point files");
}

}  // namespace

PointCloud parse_points(std::string_view bytes, const std::string& name,
                        const std::vector<std::string>& further) {
  bytes = plain_text(bytes, name);
  return is_ply_file(bytes, name) ? parse_ply_points(bytes, name, further)
                                  : parse_csv_points(bytes, name, further);
}

PointCloud read_points(const std::string& path, const std::vector<std::string>& further) {
  return parse_points(bytes_of_points(path), path, further);
}

std::vector<std::string> further_columns(const std::string& path) {
  const std::string file = bytes_of_points(path);
  const std::string_view bytes = plain_text(file, path);
  return is_ply_file(bytes, path) ? further_ply_columns(bytes, path)
                                  : further_csv_columns(bytes, path);
}

}  // namespace neve::sim::files

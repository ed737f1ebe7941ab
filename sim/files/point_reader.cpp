#include "sim/files/point_reader.h"

#include "sim/files/input_file.h"

namespace neve::sim::files {

namespace {

bool is_ply_file(std::string_view bytes, const std::string& name) {
  const bool is_ply = bytes.starts_with("ply\n") || bytes.starts_with("ply\r\n");
  if (!is_ply && name.ends_with(".ply"))
    refuse_input(name, "it does not begin with a line \"ply\"; expected a PLY file");
  return is_ply;
}

std::string bytes_of_points(const std::string& path) {
  return read_input_file(path, 1024, "point files");
}

}  // namespace

PointCloud parse_points(std::string_view bytes, const std::string& name,
                        const std::vector<std::string>& further) {
  return is_ply_file(bytes, name) ? parse_ply_points(bytes, name, further)
                                  : parse_csv_points(bytes, name, further);
}

PointCloud read_points(const std::string& path, const std::vector<std::string>& further) {
  return parse_points(bytes_of_points(path), path, further);
}

std::vector<std::string> further_columns(const std::string& path) {
  const std::string bytes = bytes_of_points(path);
  return is_ply_file(bytes, path) ? further_ply_columns(bytes, path)
                                  : further_csv_columns(bytes, path);
}

}  // namespace neve::sim::files

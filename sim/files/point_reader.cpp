#include "sim/files/point_reader.h"

#include "sim/files/input_file.h"

namespace neve::sim::files {

PointCloud parse_points(std::string_view bytes, const std::string& name) {
  const bool is_ply = bytes.starts_with("ply\n") || bytes.starts_with("ply\r\n");
  if (!is_ply && name.ends_with(".ply"))
    refuse_input(name, "it does not begin with a line \"ply\"; expected a PLY file");
  return is_ply ? parse_ply_points(bytes, name) : parse_csv_points(bytes, name);
}

PointCloud read_points(const std::string& path) {
  return parse_points(read_input_file(path, 1024, "point files"), path);
}

}  // namespace neve::sim::files

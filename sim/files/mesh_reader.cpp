#include "sim/files/mesh_reader.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "sim/files/ply_header.h"
#include "sim/files/point_table.h"

namespace neve::sim::files {
namespace {

constexpr std::size_t stl_header = 84, stl_triangle = 50;

/// Words of an STL have either case.
bool is_word(std::string_view word, std::string_view small) {
  return std::ranges::equal(word, small, [](char a, char b) {
    return (a >= 'A' && a <= 'Z' ? static_cast<char>(a - 'A' + 'a') : a) == b;
  });
}

bool is_ascii_stl(std::string_view bytes) {
  constexpr std::string_view spaces = " \t\r\n\f\v";
  std::string_view start = bytes.substr(0, 4096);
  start.remove_prefix(std::min(start.find_first_not_of(spaces), start.size()));
  if (!is_word(start.substr(0, 5), "solid")) return false;
  while (!start.empty()) {
    const std::string_view word = start.substr(0, start.find_first_of(spaces));
    if (is_word(word, "facet") || is_word(word, "endsolid")) return true;
    start.remove_prefix(word.size());
    start.remove_prefix(std::min(start.find_first_not_of(spaces), start.size()));
  }
  return false;
}

/// Triangles of a binary STL; 0: it is none. Some programs write a count of 0 and triangles all the
/// same, others something behind the triangles.
/// @param is_certain  that it is no other format: a count that leaves bytes is believed
std::size_t binary_stl_count(std::string_view bytes, bool is_certain) {
  if (bytes.size() < stl_header) return 0;
  std::uint32_t count = 0;
  std::memcpy(&count, bytes.data() + 80, sizeof count);
  const std::size_t size = bytes.size() - stl_header, room = size / stl_triangle;
  if (count > 0 && size == stl_triangle * std::size_t{count}) return count;
  if (!is_certain || is_ascii_stl(bytes)) return 0;
  if (count == 0) return size == stl_triangle * room ? room : 0;
  return count <= room ? count : 0;
}

bool is_binary_stl(std::string_view bytes) {
  return binary_stl_count(bytes, false) > 0;
}

bool has_suffix(std::string_view name, std::string_view suffix) {
  return name.size() >= suffix.size() && is_word(name.substr(name.size() - suffix.size()), suffix);
}

/// Formats of other programs: no text of theirs is an OBJ.
void refuse_other_formats(const std::string& name) {
  static constexpr std::array others{".fbx",  ".glb",  ".gltf", ".dae",   ".abc", ".usd", ".usda",
                                     ".usdc", ".usdz", ".3ds",  ".blend", ".3mf", ".step"};
  for (const std::string_view other : others)
    if (has_suffix(name, other))
      refuse_input(name, "neve reads meshes as OBJ, PLY and STL; in Blender, File > Import reads " +
                             std::string(other.substr(1)) +
                             " and File > Export > Wavefront writes OBJ");
}

class AsciiStl {
 public:
  AsciiStl(std::string_view text, const std::string& name) : lines_(text), name_(name) {}

  PolygonMesh read() {
    while (!lines_.at_end()) read_line(lines_.next());
    if (corners_ != 0) fail("the file ends inside a triangle");
    return std::move(mesh_);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    refuse_input(name_ + ":" + std::to_string(lines_.number()), what);
  }

  void read_line(std::string_view line) {
    const std::string_view keyword = next_ply_word(line);
    if (is_word(keyword, "endfacet") && corners_ != 3)
      fail("a triangle of " + std::to_string(corners_) + " corners");
    if (is_word(keyword, "endfacet")) corners_ = 0;
    if (!is_word(keyword, "vertex")) return;
    if (corners_ == 0) mesh_.polygons.push_back({mesh_.corners.size(), lines_.number()});
    if (++corners_ > 3) fail("a triangle of more than 3 corners");
    Vec3d x;
    for (double& value : x) {
      const std::string_view word = next_ply_word(line);
      const std::optional<double> number = number_in(word);
      if (!number || !std::isfinite(*number))
        fail("the coordinate " + quoted_input(word) + " is not a finite number");
      value = *number;
    }
    mesh_.corners.push_back(static_cast<std::uint32_t>(mesh_.vertices.size()));
    mesh_.vertices.push_back(x);
  }

  TableLines lines_;
  const std::string& name_;
  PolygonMesh mesh_;
  int corners_ = 0;  ///< of the triangle so far
};

PolygonMesh parse_binary_stl(std::string_view bytes, std::size_t count, const std::string& name) {
  PolygonMesh mesh;
  for (std::size_t t = 0; t < count; ++t) {
    std::array<float, 9> numbers;
    // Behind the normal.
    std::memcpy(numbers.data(), bytes.data() + stl_header + stl_triangle * t + 12, sizeof numbers);
    mesh.polygons.push_back({mesh.corners.size(), 0});
    for (std::size_t c = 0; c < 3; ++c) {
      const Vec3d x(static_cast<double>(numbers[3 * c]), static_cast<double>(numbers[3 * c + 1]),
                    static_cast<double>(numbers[3 * c + 2]));
      if (!x.allFinite())
        refuse_input(
            name, "a coordinate of triangle " + std::to_string(t + 1) + " is not a finite number");
      mesh.corners.push_back(static_cast<std::uint32_t>(mesh.vertices.size()));
      mesh.vertices.push_back(x);
    }
  }
  return mesh;
}

}  // namespace

PolygonMesh parse_stl(std::string_view bytes, const std::string& name) {
  const std::size_t count = binary_stl_count(bytes, true);
  if (count == 0 && !is_ascii_stl(bytes))
    refuse_input(name,
                 "neither an ascii STL, which begins with \"solid\", nor a binary one, of 84 "
                 "bytes and 50 for each triangle");
  const std::size_t size = bytes.size() - std::min(bytes.size(), stl_header);
  if (count > 0 && count < size / stl_triangle && size % stl_triangle == 0)
    refuse_input(name, "its header counts " + std::to_string(count) + " triangles, and " +
                           std::to_string(size / stl_triangle) +
                           " are in the file: some would be missing");
  PolygonMesh mesh =
      count > 0 ? parse_binary_stl(bytes, count, name) : AsciiStl(bytes, name).read();
  if (mesh.polygons.empty()) refuse_input(name, "no triangles");
  return mesh;
}

PolygonMesh parse_mesh(std::string_view bytes, const std::string& name) {
  if (!is_binary_stl(bytes)) bytes = plain_text(bytes, name);
  if (bytes.starts_with("ply\n") || bytes.starts_with("ply\r\n"))
    return parse_ply_mesh(bytes, name);
  if (has_suffix(name, ".ply"))
    refuse_input(name, "it does not begin with a line \"ply\"; expected a PLY file");
  if (is_binary_stl(bytes) || is_ascii_stl(bytes) || has_suffix(name, ".stl"))
    return parse_stl(bytes, name);
  refuse_other_formats(name);
  return parse_obj(bytes, name);
}

PolygonMesh read_mesh(const std::string& path) {
  return parse_mesh(read_input_file(path, 256, "meshes"), path);
}

}  // namespace neve::sim::files

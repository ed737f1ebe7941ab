#include <algorithm>
#include <cmath>

#include "sim/files/mesh_reader.h"
#include "sim/files/ply_header.h"

namespace neve::sim::files {
namespace {

/// The numbers behind the header, one after the other.
class PlyNumbers {
 public:
  PlyNumbers(std::string_view bytes, PlyFormat format, const std::string& name)
      : bytes_(bytes), format_(format), name_(name) {}

  std::size_t left() const { return bytes_.size(); }
  /// A text has more than blanks.
  bool has_more_text() {
    skip_blanks();
    return !bytes_.empty();
  }

  double next(PlyType type) {
    return format_ == PlyFormat::ascii ? next_text() : next_binary(type);
  }

 private:
  void skip_blanks() {
    while (!bytes_.empty() && (is_blank(bytes_.front()) || bytes_.front() == '\n'))
      bytes_.remove_prefix(1);
  }

  double next_text() {
    skip_blanks();
    std::size_t end = 0;
    while (end < bytes_.size() && !is_blank(bytes_[end]) && bytes_[end] != '\n') ++end;
    if (end == 0) refuse_input(name_, "truncated: the mesh is incomplete");
    const std::optional<double> value = number_in(bytes_.substr(0, end));
    if (!value) refuse_input(name_, quoted_input(bytes_.substr(0, end)) + " is not a number");
    bytes_.remove_prefix(end);
    return *value;
  }

  double next_binary(PlyType type) {
    if (bytes_.size() < type.size) refuse_input(name_, "truncated: the mesh is incomplete");
    const double value = binary_number(bytes_, type, format_);
    bytes_.remove_prefix(type.size);
    return value;
  }

  std::string_view bytes_;
  PlyFormat format_;
  const std::string& name_;
};

class MeshPly {
 public:
  MeshPly(std::string_view bytes, const std::string& name) : lines_(bytes), name_(name) {}

  PolygonMesh read() {
    const PlyHeader header = read_ply_header(lines_, name_);
    PlyNumbers numbers(lines_.rest(), header.format, name_);
    for (const PlyElement& element : header.elements) {
      has_faces_ = has_faces_ || (element.name == "face" && element.count > 0);
      read_element(element, numbers);
    }
    const bool has_more =
        header.format == PlyFormat::ascii
            ? numbers.has_more_text()
            : !header.elements.empty() && numbers.left() >= triangle_size(header.elements.back());
    if (has_more)
      refuse_input(name_, "more data than the elements of the header: faces would be missing");
    if (!header.axes.are_ours())
      for (Vec3d& x : mesh_.vertices) x = header.axes.metres(x);
    check();
    return std::move(mesh_);
  }

 private:
  /// Bytes of the smallest face in a row: some writers end with a byte or two of their own.
  static std::size_t triangle_size(const PlyElement& element) {
    std::size_t size = 0;
    for (const PlyProperty& property : element.properties) {
      size += property.count.value_or(property.type).size;
      if (has_corners(property)) size += 3 * property.type.size;
    }
    return std::max<std::size_t>(size, 3);
  }

  static bool has_corners(const PlyProperty& property) {
    const std::string& name = property.name;
    return property.count &&
           (name == "vertex_indices" || name == "vertex_index" || name == "indices");
  }

  void read_element(const PlyElement& element, PlyNumbers& numbers) {
    if (element.properties.empty()) return;
    // Each has a byte at least.
    if (element.count > numbers.left())
      refuse_input(name_, "truncated: the header promises " + std::to_string(element.count) +
                              " of " + quoted_input(element.name));
    for (std::uint64_t k = 0; k < element.count; ++k) {
      if (element.name == "vertex") mesh_.vertices.emplace_back(Vec3d::Zero());
      for (const PlyProperty& property : element.properties)
        read_property(element, property, numbers);
    }
  }

  static bool is_place(const PlyProperty& property) {
    return property.name.size() == 1 &&
           std::string_view("xyzXYZ").find(property.name) != std::string_view::npos;
  }

  void read_property(const PlyElement& element, const PlyProperty& property, PlyNumbers& numbers) {
    if (!property.count) {
      const double value = numbers.next(property.type);
      const std::size_t axis = std::string_view("xyzXYZ").find(property.name) % 3;
      if (element.name == "vertex" && is_place(property))
        mesh_.vertices.back()[static_cast<Eigen::Index>(axis)] = value;
      return;
    }
    const double count = numbers.next(*property.count);
    if (!(count >= 0 && count <= static_cast<double>(numbers.left())))
      refuse_input(name_, "truncated: a list is longer than the file");
    const bool is_face = has_corners(property) && element.name == "face";
    const bool is_strip = has_corners(property) && element.name == "tristrips";
    if (is_face) mesh_.polygons.push_back({mesh_.corners.size(), 0});
    strip_.clear();
    for (double k = 0; k < count; ++k) {
      const double corner = numbers.next(property.type);
      if (is_face) mesh_.corners.push_back(vertex_in(corner));
      if (is_strip) add_to_strip(corner);
    }
  }

  std::uint32_t vertex_in(double corner) const {
    if (!(corner >= 0 && corner < 4294967295.0 && corner == std::floor(corner)))
      refuse_input(name_, "face " + std::to_string(mesh_.polygons.size()) +
                              " names a vertex that is not a number from 0");
    return static_cast<std::uint32_t>(corner);
  }

  /// Every corner makes a triangle with the two before it, every second one wound the other way; -1
  /// begins a new strip.
  void add_to_strip(double corner) {
    if (corner == -1) return strip_.clear();
    strip_.push_back(vertex_in(corner));
    const std::size_t n = strip_.size();
    if (n < 3) return;
    const std::size_t turn = n % 2 == 0 ? 1 : 0;
    const std::uint32_t a = strip_[n - 3 + turn], b = strip_[n - 2 - turn], c = strip_[n - 1];
    if (a == b || b == c || a == c) return;  // a strip turns by repeating a corner
    mesh_.polygons.push_back({mesh_.corners.size(), 0});
    mesh_.corners.insert(mesh_.corners.end(), {a, b, c});
  }

  void check() const {
    if (mesh_.polygons.empty())
      refuse_input(name_, has_faces_
                              ? "its faces have no list of their vertices; expected one that is "
                                "called vertex_indices"
                              : "no faces: the PLY has points only. shape = { points = { file = "
                                "... } } makes a body of them");
    for (const Vec3d& x : mesh_.vertices)
      if (!x.allFinite()) refuse_input(name_, "a coordinate is not a finite number");
    for (std::size_t p = 0; p < mesh_.polygons.size(); ++p) {
      const std::size_t first = mesh_.polygons[p].first, end = mesh_.corner_end(p);
      const std::string face = "face " + std::to_string(p + 1);
      if (end - first < 3)
        refuse_input(name_,
                     face + " has " + std::to_string(end - first) + " corners; expected 3 or more");
      for (std::size_t c = first; c < end; ++c)
        if (mesh_.corners[c] >= mesh_.vertices.size())
          refuse_input(name_, face + " names vertex " + std::to_string(mesh_.corners[c]) +
                                  "; the file has " + std::to_string(mesh_.vertices.size()) +
                                  ", counted from 0");
    }
  }

  TableLines lines_;
  const std::string& name_;
  std::vector<std::uint32_t> strip_;  ///< corners of the present one
  PolygonMesh mesh_;
  bool has_faces_ = false;  ///< by its header
};

}  // namespace

PolygonMesh parse_ply_mesh(std::string_view bytes, const std::string& name) {
  return MeshPly(bytes, name).read();
}

}  // namespace neve::sim::files

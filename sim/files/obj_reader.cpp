#include "sim/files/obj_reader.h"

#include <charconv>
#include <cmath>
#include <limits>
#include <optional>
#include <system_error>
#include <utility>

#include "sim/files/file_axes.h"
#include "sim/files/input_file.h"

// An own reader rather than tinyobjloader (2.0rc10 tried): that reads "v 1 abc" as (1, 0, 0), lets
// the index 99999999999999 wrap round into a valid range, returns indices out of range with a
// warning only, and knows the line of no face, which messages about holes should name.

namespace neve::sim::files {
namespace {

/// The words of a text, line by line.
class Words {
 public:
  explicit Words(std::string_view text) : rest_(text) {}

  bool at_end() const { return rest_.empty(); }
  std::size_t line() const { return line_; }

  /// The next word of this line, empty at its end.
  std::string_view next() {
    skip_blanks();
    std::size_t length = 0;
    while (length < rest_.size() && rest_[length] != '\n' && !is_blank(rest_[length]) &&
           continuation_at(length) == 0)
      ++length;
    const std::string_view word = rest_.substr(0, length);
    rest_.remove_prefix(length);
    return word;
  }

  /// Returns the rest of this line.
  std::string_view rest_of_line() const { return rest_.substr(0, rest_.find('\n')); }

  void next_line() {
    for (;;) {
      const std::size_t end = rest_.find('\n');
      if (end == std::string_view::npos) {
        rest_ = {};
        return;
      }
      ++line_;
      const std::string_view line = rest_.substr(0, end);
      rest_.remove_prefix(end + 1);
      const bool is_continued = line.ends_with('\\') || line.ends_with("\\\r");
      if (!is_continued) return;
    }
  }

 private:
  /// Length of a backslash with the line end behind it, which joins two lines.
  std::size_t continuation_at(std::size_t at) const {
    const std::string_view tail = rest_.substr(at, 3);
    if (tail.starts_with("\\\n")) return 2;
    return tail == "\\\r\n" ? 3 : 0;
  }

  void skip_blanks() {
    while (!rest_.empty()) {
      if (is_blank(rest_.front())) {
        rest_.remove_prefix(1);
      } else if (const std::size_t length = continuation_at(0)) {
        ++line_;
        rest_.remove_prefix(length);
      } else {
        return;
      }
    }
  }

  std::string_view rest_;
  std::size_t line_ = 1;
};

class Parser {
 public:
  Parser(std::string_view text, const std::string& name) : words_(text), name_(name) {}

  PolygonMesh run() {
    while (!words_.at_end()) {
      const std::string_view keyword = words_.next();
      if (keyword == "v") read_vertex();
      if (keyword == "f") read_polygon();
      if (keyword == "#") axes_.read(words_.rest_of_line(), here());
      words_.next_line();
    }
    check_indices();
    if (!axes_.axes().are_ours())
      for (Vec3d& x : mesh_.vertices) x = axes_.axes().metres(x);
    return std::move(mesh_);
  }

 private:
  std::string here() const { return name_ + ":" + std::to_string(words_.line()); }

  void read_vertex() {
    Vec3d x;
    for (double& value : x) value = read_coordinate(words_.next());
    mesh_.vertices.push_back(x);
  }

  double read_coordinate(std::string_view word) const {
    if (word.empty()) refuse_input(here(), "a vertex with less than three coordinates");
    const std::optional<double> value = number_in(word);
    if (!value || !std::isfinite(*value))
      refuse_input(here(), "the coordinate " + quoted_input(word) + " is not a finite number");
    return *value;
  }

  void read_polygon() {
    mesh_.polygons.push_back({mesh_.corners.size(), words_.line()});
    std::size_t count = 0;
    for (std::string_view word = words_.next(); !word.empty(); word = words_.next(), ++count)
      mesh_.corners.push_back(read_index(word));
    if (count < 3)
      refuse_input(here(), "a face of " + std::to_string(count) + " corners; expected 3 or more");
  }

  /// Index from 0. One beyond the last vertex so far may still come true, see check_indices.
  std::uint32_t read_index(std::string_view word) const {
    long long index = 0;
    const char* end = word.data() + word.size();
    const auto [stop, error] = std::from_chars(word.data(), end, index);
    const auto count = static_cast<long long>(mesh_.vertices.size());
    const bool is_number = error == std::errc{} && (stop == end || *stop == '/');
    if (!is_number || index == 0 || index < -count ||
        index > std::numeric_limits<std::uint32_t>::max())
      refuse_input(here(), "the face names the vertex " + quoted_input(word) + "; there are " +
                               std::to_string(count) +
                               " so far, counted from 1, or from -1 backwards");
    return static_cast<std::uint32_t>(index > 0 ? index - 1 : index + count);
  }

  void check_indices() const {
    if (mesh_.polygons.empty())
      refuse_input(name_,
                   "no faces; expected an OBJ with lines f 1 2 3. neve reads OBJ, PLY and STL");
    for (std::size_t p = 0; p < mesh_.polygons.size(); ++p)
      for (std::size_t c = mesh_.polygons[p].first; c < mesh_.corner_end(p); ++c)
        if (mesh_.corners[c] >= mesh_.vertices.size())
          refuse_input(name_ + ":" + std::to_string(mesh_.polygons[p].line),
                       "the face names vertex " + std::to_string(mesh_.corners[c] + 1ull) +
                           "; the file has " + std::to_string(mesh_.vertices.size()));
  }

  Words words_;
  const std::string& name_;
  PolygonMesh mesh_;
  AxesComment axes_;
};

}  // namespace

PolygonMesh parse_obj(std::string_view text, const std::string& name) {
  return Parser(text, name).run();
}

}  // namespace neve::sim::files

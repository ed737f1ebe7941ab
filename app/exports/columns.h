#pragma once
/// Attributes of particles as columns of numbers, in the precision of the state.

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "app/exports/axes.h"
#include "app/exports/origins.h"
#include "app/exports/state.h"
#include "app/scene/scene.h"
#include "sim/shapes/placed_points.h"

namespace neve::app::exports {

class Carried {
 public:
  Carried() = default;
  /// Reads the columns that the exports of the scene name.
  /// @param body_end  see Origins
  /// @throws ShapeError for a file that cannot be read
  Carried(const scene::Scene& scene, const std::vector<std::size_t>& body_end);

  /// The column of a name, its values by id, its type exact for all of them. Null if no file has
  /// it. Particles whose file has no such column have 0; ids past its end come from no file.
  const sim::files::PointColumn* find(const std::string& name) const;

 private:
  void add(const sim::files::PointColumn& column, std::size_t first, std::size_t ids);

  std::vector<sim::files::PointColumn> columns_;  ///< values by id
};

/// Numbers that the state has in single precision are float, so that no bit is lost or invented.
/// Places, and all that is computed from several numbers, are double.
using Numbers = std::variant<std::vector<float>, std::vector<double>, std::vector<std::int32_t>>;

struct Column {
  std::optional<scene::ExportAttribute> attribute;  ///< absent: carried along from a file
  std::string name, unit;                           ///< the unit may be empty
  int components = 1;                               ///< 1, 3, or 9: row by row
  Numbers numbers;
};

/// "x", "vy", "F_E_xz", "J_P"
std::string component_name(const Column& column, int component);

/// "float32", "float64" or "int32"
const char* type_name(const Column& column);
std::size_t number_size(const Column& column);

/// Triangles between the first rows of a table. The rows after these are points beside the mesh.
struct MeshRows {
  std::size_t vertices = 0;
  std::vector<float> normal;          ///< three a row, of unit length; 0 for points
  std::vector<std::int32_t> corners;  ///< three a triangle, counter-clockwise from outside

  std::size_t triangles() const { return corners.size() / 3; }
};

/// Particles for one file, or the vertices of their surface.
struct Table {
  std::size_t rows = 0;
  std::vector<Column> columns;
  std::optional<MeshRows> mesh;

  /// Null if there is none.
  const Column* find(scene::ExportAttribute attribute) const;
  /// x, 3 numbers a row.
  const std::vector<double>& places() const;
};

/// The attributes of an export in its order, with x in front where it is not named, then the
/// columns that are carried along.
/// @throws LimitError for a surface that does not fit in memory
Table make_table(const scene::Scene& scene, const scene::Export& e, const Origins& origins,
                 const Carried& carried, const State& state);

/// The same without rows: names, types and units. They depend on the scene and its files alone.
Table empty_table(const scene::Scene& scene, const scene::Export& e, const Carried& carried);

}  // namespace neve::app::exports

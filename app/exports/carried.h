#pragma once
/// Columns of point files that mean nothing to neve, carried along by the ids of particles.

#include <string>
#include <vector>

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

}  // namespace neve::app::exports

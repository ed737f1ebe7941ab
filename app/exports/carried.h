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

  /// Of a particle: 0 for particles whose file has no such column, or that come from no file.
  double value(const std::string& name, std::uint32_t id) const;
  /// The type in which all numbers of a column are exact.
  sim::files::PointColumn::Type type_of(const std::string& name) const;

 private:
  /// Null where no file has it.
  const sim::files::PointColumn* find(const std::string& name) const;
  void add(const sim::files::PointColumn& column, std::size_t first, std::size_t ids);

  std::vector<sim::files::PointColumn> columns_;  ///< values by id
};

}  // namespace neve::app::exports

#pragma once
/// Axes and units of a file that neve wrote with --up or --scale.

#include <optional>
#include <string>
#include <string_view>

#include "sim/types/math.h"

namespace neve::sim::files {

/// The way of a file back to metres, y up: the inverse of what an export does. Masses and volumes
/// are SI in any file.
struct FileAxes {
  bool is_z_up = false;
  double scale = 1;  ///< units per metre

  bool are_ours() const { return !is_z_up && scale == 1; }
  Vec3d direction(const Vec3d& v) const { return is_z_up ? Vec3d(v.x(), v.z(), -v.y()) : v; }
  /// Turns places and velocities into metres.
  Vec3d metres(const Vec3d& v) const { return direction(v) / scale; }
  /// Turns both sides of a tensor.
  Mat3d tensor(const Mat3d& a) const {
    Mat3d rows, both;
    for (int c = 0; c < 3; ++c) rows.col(c) = direction(a.col(c));
    for (int r = 0; r < 3; ++r) both.row(r) = direction(rows.row(r).transpose()).transpose();
    return both;
  }
};

/// Looks for the axes in the comments of a text, of PLY and OBJ: "neve 0.2.0", then "up z, units
/// per metre 100". Comments of other programs mean nothing here.
class AxesComment {
 public:
  /// @param where  of the comment, for messages
  /// @return whether it says the axes @throws ShapeError where neve wrote it and it cannot be read
  bool read(std::string_view comment, const std::string& where);
  /// Returns the axes: metres, y up, unless a comment says other ones.
  const FileAxes& axes() const { return axes_; }

 private:
  bool is_of_neve_ = false;
  FileAxes axes_;
};

/// Column of a CSV, the same number in each row: readers of such files know no comments.
inline constexpr std::string_view y_up_column = "up_y_units_per_metre",
                                  z_up_column = "up_z_units_per_metre";

/// Returns the axes of a column; nothing for one of another name.
/// @throws ShapeError for a value that is no scale
std::optional<FileAxes> axes_of_column(std::string_view name, double value,
                                       const std::string& where);

}  // namespace neve::sim::files

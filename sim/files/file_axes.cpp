#include "sim/files/file_axes.h"

#include "sim/files/input_file.h"

namespace neve::sim::files {
namespace {

/// True for a number in the range of the option --scale.
bool is_scale(double scale) {
  return scale >= 1e-6 && scale <= 1e6;
}

}  // namespace

bool AxesComment::read(std::string_view comment, const std::string& where) {
  comment = trimmed(comment);
  if (comment == "neve" || comment.starts_with("neve ")) is_of_neve_ = true;
  if (!is_of_neve_ || !(comment == "up" || comment.starts_with("up "))) return false;
  comment = trimmed(comment.substr(2));
  constexpr std::string_view before = ", units per metre ";
  const bool is_z_up = comment.starts_with('z');
  std::optional<double> scale;
  if ((is_z_up || comment.starts_with('y')) && comment.substr(1).starts_with(before))
    scale = number_in(comment.substr(1 + before.size()));
  if (!scale || !is_scale(*scale))
    refuse_input(where,
                 "the comment on the axes of a file of neve cannot be read; expected "
                 "up y, units per metre 1, or none");
  axes_ = {is_z_up, *scale};
  return true;
}

std::optional<FileAxes> axes_of_column(std::string_view name, double value,
                                       const std::string& where) {
  if (name != y_up_column && name != z_up_column) return std::nullopt;
  if (!is_scale(value))
    refuse_input(where,
                 "the column " + std::string(name) +
                     " of a file of neve cannot be read; expected 1 where a unit is a metre");
  return FileAxes{name == z_up_column, value};
}

}  // namespace neve::sim::files

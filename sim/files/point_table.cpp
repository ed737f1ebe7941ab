#include "sim/files/point_table.h"

#include <Eigen/LU>
#include <algorithm>
#include <utility>

#include "sim/files/input_file.h"
#include "sim/types/number_text.h"

namespace neve::sim::files {
namespace {

/// The places of all quantities in one list; tensors have nine.
enum PointQuantity : std::size_t {
  position,
  velocity = 3,
  mass = 6,
  rest_volume,
  volume,
  plastic_volume,
  stiffness,
  threshold,
  deformation = 12,
  affine = 21
};
constexpr std::array quantity_names{
    "x",      "y",      "z",         "vx",        "vy",     "vz",     "mass",   "V0",
    "volume", "J_P",    "stiffness", "threshold", "F_E_xx", "F_E_xy", "F_E_xz", "F_E_yx",
    "F_E_yy", "F_E_yz", "F_E_zx",    "F_E_zy",    "F_E_zz", "C_xx",   "C_xy",   "C_xz",
    "C_yx",   "C_yy",   "C_yz",      "C_zx",      "C_zy",   "C_zz"};

/// Numbers that a quantity may have, and how a message says so.
struct AllowedNumbers {
  double least, most;
  const char* text;
};

AllowedNumbers allowed_numbers(std::size_t quantity) {
  // m, of a map too
  if (quantity <= position + 2) return {-1e8, 1e8, "a finite number, at most 1e8 from 0"};
  // m/s
  if (quantity < mass) return {-1e6, 1e6, "a finite number, at most 1e6 from 0"};
  // kg and m3; single precision ends at 1e-38
  if (quantity <= volume) return {1e-30, 1e12, "a number from 1e-30 to 1e12"};
  if (quantity < deformation) return {1e-6, 1e6, "a number from 1e-6 to 1e6"};
  if (quantity < affine) return {-1e6, 1e6, "a finite number, at most 1e6 from 0"};
  return {-1e9, 1e9, "a finite number, at most 1e9 from 0"};
}

/// "velocity_x", "Velocity.X" and "velocityx" are the same.
std::string plain_column_name(std::string_view name) {
  std::string text;
  for (const char c : name.substr(0, 64)) {
    if (c >= 'A' && c <= 'Z') text += static_cast<char>(c - 'A' + 'a');
    if ((c >= 'a' && c <= 'z') || (c >= '0' && c <= '9')) text += c;
  }
  return text;
}

/// "fexy" or "cxy": the place of the component.
std::optional<std::size_t> tensor_component(std::string_view name) {
  const std::size_t first = name.starts_with("fe") ? deformation : affine;
  if (name.starts_with("fe"))
    name.remove_prefix(2);
  else if (name.starts_with("c"))
    name.remove_prefix(1);
  else
    return std::nullopt;
  const auto is_axis = [](char c) { return c >= 'x' && c <= 'z'; };
  if (name.size() != 2 || !is_axis(name[0]) || !is_axis(name[1])) return std::nullopt;
  return first + 3 * static_cast<std::size_t>(name[0] - 'x') +
         static_cast<std::size_t>(name[1] - 'x');
}

std::optional<std::size_t> quantity_called(const std::string& name) {
  static constexpr std::array positions{"", "p", "x", "pos", "position", "points"};
  static constexpr std::array velocities{"v", "vel", "velocity"};
  if (name == "m" || name == "mass") return mass;
  if (name == "v0") return rest_volume;
  if (name == "vol" || name == "volume") return volume;
  if (name == "jp") return plastic_volume;
  if (name == "stiffness") return stiffness;
  if (name == "threshold") return threshold;
  if (const auto component = tensor_component(name)) return component;
  if (name.empty()) return std::nullopt;
  const std::string vector = name.substr(0, name.size() - 1);
  const char last = name.back();
  const bool is_letter = last >= 'x' && last <= 'z';
  // Numbers need a word: "p0" may be anything.
  if (!is_letter && !(last >= '0' && last <= '2' && vector.size() > 2)) return std::nullopt;
  const auto axis = static_cast<std::size_t>(is_letter ? last - 'x' : last - '0');
  const auto is = [&](const char* word) { return vector == word; };
  if (std::any_of(positions.begin(), positions.end(), is)) return position + axis;
  if (std::any_of(velocities.begin(), velocities.end(), is)) return velocity + axis;
  return std::nullopt;
}

/// The first few names of a header, as written.
std::string listed_columns(const std::vector<std::string>& columns) {
  std::string text;
  for (std::size_t k = 0; k < std::min<std::size_t>(columns.size(), 8); ++k)
    text += (k ? ", " : "") + quoted_input(columns[k]);
  return text + (columns.size() > 8 ? ", ..." : "");
}

}  // namespace

std::vector<std::string> unknown_columns(const std::vector<std::string>& columns) {
  std::vector<std::string> unknown;
  for (const std::string& column : columns)
    if (!quantity_called(plain_column_name(column))) unknown.push_back(column);
  return unknown;
}

std::string_view TableLines::next() {
  ++number_;
  const std::size_t end = std::min(rest_.find('\n'), rest_.size());
  std::string_view line = rest_.substr(0, end);
  rest_.remove_prefix(std::min(end + 1, rest_.size()));
  if (line.ends_with('\r')) line.remove_suffix(1);
  return line;
}

PointTable::PointTable(const std::vector<std::string>& columns, const std::string& where) {
  for (std::size_t k = 0; k < columns.size(); ++k) {
    const auto quantity = quantity_called(plain_column_name(columns[k]));
    if (!quantity) continue;
    if (column_[*quantity])
      refuse_input(where, "two columns are the point's " + std::string(quantity_names[*quantity]) +
                              ", " + quoted_input(columns[*column_[*quantity]]) + " and " +
                              quoted_input(columns[k]));
    column_[*quantity] = k;
  }
  require(position, columns, where, "no");
  if (column_[velocity] || column_[velocity + 1] || column_[velocity + 2])
    require(velocity, columns, where, "a velocity without");
  for (const std::size_t tensor : {deformation, affine}) {
    const auto* first = column_.data() + tensor;
    const auto count = std::count_if(first, first + 9, [](const auto& c) { return c.has_value(); });
    if (count > 0 && count < 9)
      refuse_input(where, std::string("a part of ") + (tensor == affine ? "C" : "F_E") +
                              " only; expected nine columns, " + quantity_names[tensor] + " to " +
                              quantity_names[tensor + 8]);
  }
  // The volume before deformation is the one that counts.
  if (column_[rest_volume]) column_[volume].reset();
}

void PointTable::require(std::size_t first, const std::vector<std::string>& columns,
                         const std::string& where, const std::string& what) const {
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (!column_[first + axis])
      refuse_input(where, what + " column " + quantity_names[first + axis] + " among " +
                              listed_columns(columns) +
                              "; expected x, y, z and, if wanted, vx, vy, vz, mass, volume" +
                              (columns.size() == 1 && columns[0].find(' ') != std::string::npos
                                   ? ", with commas, semicolons or tabs between them"
                                   : ""));
}

void PointTable::carry(const std::vector<std::string>& names,
                       const std::vector<std::string>& columns,
                       const std::vector<PointColumn::Type>& types, const std::string& where) {
  for (const std::string& name : names) {
    const auto found = std::find(columns.begin(), columns.end(), name);
    if (found == columns.end()) continue;
    if (std::find(found + 1, columns.end(), name) != columns.end())
      refuse_input(where, "two columns are called " + quoted_input(name));
    const auto k = static_cast<std::size_t>(found - columns.begin());
    if (quantity_called(plain_column_name(name))) continue;
    further_.push_back(k);
    cloud_.further.push_back({name, types.empty() ? PointColumn::Type::real64 : types[k], {}});
  }
}

bool PointTable::uses(std::size_t column) const {
  return std::find(column_.begin(), column_.end(), std::optional(column)) != column_.end() ||
         std::find(further_.begin(), further_.end(), column) != further_.end();
}

void PointTable::reserve(std::size_t count) {
  cloud_.x.reserve(count);
  if (column_[velocity]) cloud_.v.reserve(count);
  if (column_[mass]) cloud_.m.reserve(count);
  if (column_[volume] || column_[rest_volume]) cloud_.V.reserve(count);
  if (column_[deformation]) cloud_.F_E.reserve(count);
}

double PointTable::value(const std::vector<double>& row, std::size_t quantity,
                         const std::function<std::string()>& where) const {
  const double value = row[*column_[quantity]];
  const AllowedNumbers allowed = allowed_numbers(quantity);
  if (!(value >= allowed.least && value <= allowed.most))
    refuse_input(where(), std::string(quantity_names[quantity]) + " = " + number_text(value, 6) +
                              "; expected " + allowed.text);
  return value;
}

Vec3d PointTable::vector(const std::vector<double>& row, std::size_t first,
                         const std::function<std::string()>& where) const {
  return {value(row, first, where), value(row, first + 1, where), value(row, first + 2, where)};
}

Mat3d PointTable::tensor(const std::vector<double>& row, std::size_t first,
                         const std::function<std::string()>& where) const {
  Mat3d a;
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 3; ++c)
      a(r, c) = value(row, first + static_cast<std::size_t>(3 * r + c), where);
  return a;
}

/// Adds all that the snow has been through.
void PointTable::add_history(const std::vector<double>& row,
                             const std::function<std::string()>& where) {
  if (column_[plastic_volume]) cloud_.J_P.push_back(value(row, plastic_volume, where));
  if (column_[stiffness]) cloud_.stiffness.push_back(value(row, stiffness, where));
  if (column_[threshold]) cloud_.threshold.push_back(value(row, threshold, where));
  if (column_[affine]) cloud_.C.push_back(tensor(row, affine, where));
  if (!column_[deformation]) return;
  const Mat3d F_E = tensor(row, deformation, where);
  if (!(F_E.determinant() > 0))
    refuse_input(where(), "det F_E = " + number_text(F_E.determinant(), 6) +
                              "; expected a number above 0: snow that is not turned inside out");
  cloud_.F_E.push_back(F_E);
}

/// Converts the columns that are vectors or tensors; further ones are passed on as they are.
std::vector<double> PointTable::in_metres(std::vector<double> row) const {
  const auto at = [&](std::size_t quantity) -> double& { return row[*column_[quantity]]; };
  for (const std::size_t first : {position, velocity}) {
    if (!column_[first]) continue;
    const Vec3d v = axes_.metres({at(first), at(first + 1), at(first + 2)});
    for (int axis = 0; axis < 3; ++axis) at(first + static_cast<std::size_t>(axis)) = v[axis];
  }
  for (const std::size_t first : {deformation, affine}) {
    if (!column_[first]) continue;
    const auto element = [&](int r, int c) -> double& {
      return at(first + static_cast<std::size_t>(3 * r + c));
    };
    Mat3d a;
    for (int r = 0; r < 3; ++r)
      for (int c = 0; c < 3; ++c) a(r, c) = element(r, c);
    a = axes_.tensor(a);
    for (int r = 0; r < 3; ++r)
      for (int c = 0; c < 3; ++c) element(r, c) = a(r, c);
  }
  return row;
}

void PointTable::add(const std::vector<double>& row, const std::function<std::string()>& where) {
  if (axes_.are_ours())
    add_in_metres(row, where);
  else
    add_in_metres(in_metres(row), where);
}

void PointTable::add_in_metres(const std::vector<double>& row,
                               const std::function<std::string()>& where) {
  cloud_.x.push_back(vector(row, position, where));
  if (column_[velocity]) cloud_.v.push_back(vector(row, velocity, where));
  if (column_[mass]) cloud_.m.push_back(value(row, mass, where));
  if (column_[rest_volume]) cloud_.V.push_back(value(row, rest_volume, where));
  if (column_[volume]) cloud_.V.push_back(value(row, volume, where));
  for (std::size_t k = 0; k < further_.size(); ++k)
    cloud_.further[k].value.push_back(row[further_[k]]);
  add_history(row, where);
}

PointCloud PointTable::take(const std::string& name) {
  if (cloud_.x.empty()) refuse_input(name, "it has no points");
  return std::move(cloud_);
}

}  // namespace neve::sim::files

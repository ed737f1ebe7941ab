#include "sim/files/point_table.h"

#include <algorithm>
#include <utility>

#include "sim/files/input_file.h"
#include "sim/types/number_text.h"

namespace neve::sim::files {
namespace {

/// The places of x y z, vx vy vz, mass and volume in one list.
enum PointQuantity : std::size_t { position, velocity = 3, mass = 6, volume = 7 };
constexpr std::array quantity_names{"x", "y", "z", "vx", "vy", "vz", "mass", "volume"};

constexpr double max_coordinate = 1e6;  // m and m/s
constexpr double max_amount = 1e12;     // kg and m3
constexpr double min_amount = 1e-30;    // single precision ends at 1e-38

/// "velocity_x", "Velocity.X" and "velocityx" are the same.
std::string plain_column_name(std::string_view name) {
  std::string text;
  for (const char c : name.substr(0, 64)) {
    if (c >= 'A' && c <= 'Z') text += static_cast<char>(c - 'A' + 'a');
    if ((c >= 'a' && c <= 'z') || (c >= '0' && c <= '9')) text += c;
  }
  return text;
}

std::optional<std::size_t> quantity_called(const std::string& name) {
  static constexpr std::array positions{"", "p", "pos", "position", "points"};
  static constexpr std::array velocities{"v", "vel", "velocity"};
  if (name == "m" || name == "mass") return mass;
  if (name == "vol" || name == "volume" || name == "v0") return volume;
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
}

void PointTable::require(std::size_t first, const std::vector<std::string>& columns,
                         const std::string& where, const std::string& what) const {
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (!column_[first + axis])
      refuse_input(where, what + " column " + quantity_names[first + axis] + " among " +
                              listed_columns(columns) +
                              "; expected x, y, z and, if wanted, vx, vy, vz, mass, volume");
}

bool PointTable::uses(std::size_t column) const {
  return std::find(column_.begin(), column_.end(), std::optional(column)) != column_.end();
}

void PointTable::reserve(std::size_t count) {
  cloud_.x.reserve(count);
  if (column_[velocity]) cloud_.v.reserve(count);
  if (column_[mass]) cloud_.m.reserve(count);
  if (column_[volume]) cloud_.V.reserve(count);
}

double PointTable::value(const std::vector<double>& row, std::size_t quantity,
                         const std::function<std::string()>& where) const {
  const double value = row[*column_[quantity]];
  const bool is_amount = quantity >= mass;
  const bool is_allowed = is_amount ? value >= min_amount && value <= max_amount
                                    : value >= -max_coordinate && value <= max_coordinate;
  if (!is_allowed)
    refuse_input(where(), std::string(quantity_names[quantity]) + " = " + number_text(value, 6) +
                              (is_amount ? "; expected a number from 1e-30 to 1e12"
                                         : "; expected a finite number, at most 1e6 from 0"));
  return value;
}

Vec3d PointTable::vector(const std::vector<double>& row, std::size_t first,
                         const std::function<std::string()>& where) const {
  return {value(row, first, where), value(row, first + 1, where), value(row, first + 2, where)};
}

void PointTable::add(const std::vector<double>& row, const std::function<std::string()>& where) {
  cloud_.x.push_back(vector(row, position, where));
  if (column_[velocity]) cloud_.v.push_back(vector(row, velocity, where));
  if (column_[mass]) cloud_.m.push_back(value(row, mass, where));
  if (column_[volume]) cloud_.V.push_back(value(row, volume, where));
}

PointCloud PointTable::take(const std::string& name) {
  if (cloud_.x.empty()) refuse_input(name, "it has no points");
  return std::move(cloud_);
}

}  // namespace neve::sim::files

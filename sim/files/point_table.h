#pragma once
/// A table of numbers in a file as points: the meaning of its columns, and their allowed values.

#include <array>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "sim/files/file_axes.h"
#include "sim/files/point_reader.h"

namespace neve::sim::files {

/// Lines of a text, with their numbers.
class TableLines {
 public:
  explicit TableLines(std::string_view text) : rest_(text) {}

  bool at_end() const { return rest_.empty(); }
  std::string_view rest() const { return rest_; }
  std::size_t number() const { return number_; }  ///< of the line that next() gave, from 1
  std::string_view next();

 private:
  std::string_view rest_;
  std::size_t number_ = 0;
};

inline constexpr std::size_t max_columns = 256;

/// Returns the columns that mean nothing to neve.
std::vector<std::string> unknown_columns(const std::vector<std::string>& columns);

/// Collects the points from the rows of a table.
class PointTable {
 public:
  /// @param where  of the header, for messages
  /// @throws ShapeError without x, y or z, with a part of a velocity, with one quantity twice
  PointTable(const std::vector<std::string>& columns, const std::string& where);

  /// Also reads these of the columns that mean nothing here.
  /// @param types  of all columns; empty: real64
  /// @throws ShapeError where two have one of the names
  void carry(const std::vector<std::string>& names, const std::vector<std::string>& columns,
             const std::vector<PointColumn::Type>& types, const std::string& where);

  /// Rows are in these axes and units; points are in metres, y up.
  void use(const FileAxes& axes) { axes_ = axes; }

  bool uses(std::size_t column) const;
  void reserve(std::size_t count);

  /// @param row    a number for each column that is used
  /// @param where  tells the place of the row
  /// @throws ShapeError for numbers out of range
  void add(const std::vector<double>& row, const std::function<std::string()>& where);

  /// @throws ShapeError if there are none
  PointCloud take(const std::string& name);

 private:
  static constexpr std::size_t quantity_count = 30;  ///< see point_table.cpp

  std::vector<double> in_metres(std::vector<double> row) const;
  void add_in_metres(const std::vector<double>& row, const std::function<std::string()>& where);
  void require(std::size_t first, const std::vector<std::string>& columns, const std::string& where,
               const std::string& what) const;
  double value(const std::vector<double>& row, std::size_t quantity,
               const std::function<std::string()>& where) const;
  Vec3d vector(const std::vector<double>& row, std::size_t first,
               const std::function<std::string()>& where) const;
  Mat3d tensor(const std::vector<double>& row, std::size_t first,
               const std::function<std::string()>& where) const;
  void add_history(const std::vector<double>& row, const std::function<std::string()>& where);

  std::array<std::optional<std::size_t>, quantity_count> column_{};
  std::vector<std::size_t> further_;  ///< columns of cloud_.further
  FileAxes axes_;
  PointCloud cloud_;
};

}  // namespace neve::sim::files

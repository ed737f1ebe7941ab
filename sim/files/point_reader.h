#pragma once
/// Particles from a file: PLY (ascii, binary of either byte order) or CSV with a header line.

#include <string>
#include <string_view>
#include <vector>

#include "sim/types/math.h"

namespace neve::sim::files {

/// A column that means nothing to neve, as programs before it wrote it.
struct PointColumn {
  enum class Type { real32, real64, int32 };
  std::string name;
  Type type = Type::real64;
  std::vector<double> value;  ///< exact: a double holds the numbers of every type
};

/// Points in file order. All but x are as long as x, or empty if the file has none.
struct PointCloud {
  std::vector<Vec3d> x;              ///< m
  std::vector<Vec3d> v;              ///< m/s
  std::vector<double> m;             ///< kg, > 0
  std::vector<double> V;             ///< m3, > 0
  std::vector<double> J_P;           ///< > 0
  std::vector<Mat3d> F_E;            ///< det > 0
  std::vector<Mat3d> C;              ///< 1/s
  std::vector<double> stiffness;     ///< factor, > 0
  std::vector<double> threshold;     ///< factor, > 0
  std::vector<PointColumn> further;  ///< that were asked for and exist
};

/// Columns are found by name, in any order, case and punctuation: position x y z, or with
/// p, x, pos, position before the axis, or Points:0 to 2; velocity vx vy vz, or with vel, velocity;
/// mass m or mass; volume V0, or where there is none vol or volume; J_P, stiffness, threshold; F_E
/// and C with xx to zz. Others are passed over unless they are asked for. Independent of the
/// locale.
/// @param name of the text in messages, NAME:LINE: ...; of binary points NAME: point NUMBER
/// @param further  names of other columns to read, exactly as in the file
/// @throws ShapeError for text neither PLY nor CSV, without positions, with a part of a vector
///         only or one column twice, truncated, with numbers that are missing, not finite or out of
///         range (|x| <= 1e8 m, |v| <= 1e6 m/s, mass and volume above 0 and up to 1e12, J_P and
///         factors from 1e-6 to 1e6, det F_E above 0), or without
///         points. Counts in a file are compared with its length before anything is allocated.
PointCloud parse_points(std::string_view bytes, const std::string& name,
                        const std::vector<std::string>& further = {});

/// Reads the single numbers of the element vertex; lists, and other elements, are passed over.
/// Positions, velocities, F_E and C of a file that neve wrote with z up or in other units are
/// turned and scaled back, as the comments of its header say.
PointCloud parse_ply_points(std::string_view bytes, const std::string& name,
                            const std::vector<std::string>& further = {});

/// Fields are separated by commas, semicolons or tabs, the most frequent in the header, or by
/// blanks where it has none of them, and may be between double quotes. Numbers may have a comma for
/// a point where commas do not separate. Lines that are empty or start with # are passed over; the
/// last of these is the header where the first other line has numbers, as numpy writes it. A column
/// up_z_units_per_metre, or up_y_, says how neve turned and scaled its row: it is turned and scaled
/// back.
PointCloud parse_csv_points(std::string_view text, const std::string& name,
                            const std::vector<std::string>& further = {});

/// @throws ShapeError also when the file cannot be read or is larger than 1 GiB
PointCloud read_points(const std::string& path, const std::vector<std::string>& further = {});

/// Names of the columns that mean nothing to neve. @throws ShapeError as read_points for a header
std::vector<std::string> further_columns(const std::string& path);
std::vector<std::string> further_ply_columns(std::string_view bytes, const std::string& name);
std::vector<std::string> further_csv_columns(std::string_view text, const std::string& name);

}  // namespace neve::sim::files

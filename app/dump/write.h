#pragma once
/// Writes a listing as text for the user and for scripts, and for ParaView.

#include <string>
#include <vector>

#include "app/dump/quantities.h"
#include "app/support/json.h"

namespace neve::app::dump {

/// One line per quantity: least and greatest magnitude, expected range, number outside.
std::vector<std::string> summary_lines(const Listing& listing);

/// The lines above behind '#', a header line, one line per node or particle; tabs between columns.
std::string to_table(const Listing& listing, const std::vector<std::string>& heading);

/// VTK XML PolyData (.vtp), raw little-endian float64: points with all quantities as arrays.
std::string to_vtk(const Listing& listing);

/// Quantity, value and expected range of one row.
std::vector<std::string> probe_lines(const Listing& listing, std::size_t row);

Json summary_json(const Listing& listing);
Json probe_json(const Listing& listing, std::size_t row);

}  // namespace neve::app::dump

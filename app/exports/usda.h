#pragma once
/// Parts of USD layers as text. Source: OpenUSD, the usda file format.

#include <string>
#include <utility>
#include <vector>

#include "app/exports/bytes.h"

namespace neve::app::exports {

inline std::string usd_number(double value) {
  std::string text;
  append_text(value, text);
  return text;
}

/// "(1, 2, 3)" in single precision.
std::string usd_tuple(const sim::Vec3d& v);

/// A string between quotes.
std::string usd_string(const std::string& text);

/// A name that USD allows: letters, digits and _, no digit first.
std::string usd_name(const std::string& name);

/// The head of a layer: units, axis, frames per second, and the frames that it covers.
std::string usd_header(const scene::Scene& scene, const scene::Export& spec, double first,
                       double last);

/// The offset of files with coordinates of a map as a translation of the root in double precision;
/// "" where there are none.
std::string usd_world(const scene::Scene& scene, const scene::Export& spec);

/// Prims of the snow in a layer: the particles are points, a surface is a mesh.
enum class UsdPrim { points, mesh };

/// Returns the prims of an export, with their names below the root.
std::vector<std::pair<UsdPrim, std::string>> usd_prims(const scene::Export& spec);

inline const char* usd_type(UsdPrim prim) {
  return prim == UsdPrim::mesh ? "Mesh" : "Points";
}

/// Properties that are the same at all times.
inline std::string usd_fixed(UsdPrim prim, const std::string& indent) {
  return prim == UsdPrim::mesh ? indent + "uniform token subdivisionScheme = \"none\"\n" : "";
}

/// Names and types of the properties that change, without values.
std::string usd_declarations(const Table& columns, UsdPrim prim, const std::string& indent);

}  // namespace neve::app::exports

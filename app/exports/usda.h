#pragma once
/// Parts of USD layers as text. Source: OpenUSD, the usda file format.

#include <string>

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

/// Names and types of the properties of the particles, without values.
std::string usd_declarations(const Table& columns, const std::string& indent);

}  // namespace neve::app::exports

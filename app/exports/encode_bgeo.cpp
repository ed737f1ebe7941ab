#include <cstdint>
#include <type_traits>

#include "app/exports/bytes.h"
#include "app/exports/encode.h"

namespace neve::app::exports {

namespace {

enum BgeoType : std::int32_t { bgeo_float = 0, bgeo_int = 1, bgeo_vector = 5 };

/// Houdini knows the size of a point as pscale.
std::string bgeo_name(const Column& column) {
  return column.attribute == scene::ExportAttribute::radius ? "pscale" : column.name;
}

BgeoType bgeo_type(const Column& column) {
  if (std::holds_alternative<std::vector<std::int32_t>>(column.numbers)) return bgeo_int;
  return column.components == 3 ? bgeo_vector : bgeo_float;
}

void append_definition(const std::string& name, int size, BgeoType type, std::string& bytes) {
  append_big(static_cast<std::uint16_t>(name.size()), bytes);
  bytes += name;
  append_big(static_cast<std::uint16_t>(size), bytes);
  append_big(static_cast<std::int32_t>(type), bytes);
  bytes.append(static_cast<std::size_t>(4 * size), '\0');  // defaults
}

}  // namespace

std::string encode_bgeo(const ExportMoment& moment) {
  const Table& table = moment.table;
  constexpr std::int32_t version = 5, none = 0, details = 4;
  std::string bytes = "BgeoV";
  append_big(version, bytes);
  append_big(static_cast<std::int32_t>(table.rows), bytes);
  for (int k = 0; k < 3; ++k) append_big(none, bytes);  // primitives, groups of both kinds
  append_big(static_cast<std::int32_t>(table.columns.size() - 1), bytes);
  for (int k = 0; k < 2; ++k) append_big(none, bytes);  // attributes of vertices and primitives
  append_big(details, bytes);
  // Words of four bytes.
  const auto put = [&](auto number) {
    constexpr bool is_whole = std::is_integral_v<decltype(number)>;
    append_big(static_cast<std::conditional_t<is_whole, std::int32_t, float>>(number), bytes);
  };
  const Column* x = table.find(scene::ExportAttribute::x);
  for (const Column& column : table.columns)
    if (&column != x)
      append_definition(bgeo_name(column), column.components, bgeo_type(column), bytes);
  for (std::size_t row = 0; row < table.rows; ++row) {
    for_row(*x, row, put);
    put(1.0f);  // the fourth coordinate of a place
    for (const Column& column : table.columns)
      if (&column != x) for_row(column, row, put);
  }
  for (const char* name : {"time", "frame", "fps", "scale"})
    append_definition(name, 1, bgeo_float, bytes);
  for (const double value :
       {moment.state.time, moment.frame(), moment.scene.fps, moment.spec.scale})
    put(value);
  bytes += '\0';
  bytes += '\xff';
  return bytes;
}

}  // namespace neve::app::exports

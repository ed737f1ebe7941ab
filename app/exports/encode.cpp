#include "app/exports/encode.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "app/exports/bytes.h"
#include "app/scene/names.h"
#include "app/support/errors.h"
#include "app/support/text.h"
#include "app/support/version.h"

namespace neve::app::exports {

namespace {

const char* ply_type(const Column& column) {
  static constexpr const char* types[] = {"float", "double", "int"};
  return types[column.numbers.index()];
}

/// Says which vertices are particles beside the mesh.
std::string spray_comment(const Table& table) {
  if (!table.mesh) return {};
  return "comment the last " + std::to_string(table.rows - table.mesh->vertices) +
         " vertices are spray, in no face\n";
}

void append_faces(const MeshRows& mesh, std::string& bytes) {
  constexpr std::size_t corners = 3 * sizeof(std::int32_t);
  std::size_t to = bytes.size();
  bytes.resize(to + mesh.triangles() * (1 + corners));
  for (std::size_t t = 0; t < mesh.triangles(); ++t, to += 1 + corners) {
    bytes[to] = 3;
    std::memcpy(bytes.data() + to + 1, mesh.corners.data() + 3 * t, corners);
  }
}

/// Copies a column into records, one a row.
/// @param to  where it goes in the first @param record  bytes from one to the next
template <class T>
void put_column(const std::vector<T>& numbers, std::size_t rows, std::size_t record, char* to) {
  if (rows == 0) return;
  const std::size_t width = numbers.size() / rows;
  for (std::size_t row = 0; row < rows; ++row)
    for (std::size_t c = 0; c < width; ++c)
      std::memcpy(to + row * record + c * sizeof(T), &numbers[row * width + c], sizeof(T));
}

/// Rows of all columns side by side, and of the normals.
void append_rows(const Table& table, std::string& bytes) {
  const std::size_t record = row_size(table) + (table.mesh ? 3 * sizeof(float) : 0);
  std::size_t to = bytes.size();
  bytes.resize(to + table.rows * record);
  for (const Column& column : table.columns) {
    std::visit([&](const auto& n) { put_column(n, table.rows, record, bytes.data() + to); },
               column.numbers);
    to += number_size(column) * static_cast<std::size_t>(column.components);
  }
  if (table.mesh) put_column(table.mesh->normal, table.rows, record, bytes.data() + to);
}

/// Rows of an archive without the further fields of ZIP64, whose places are numbers of 32 bits.
double max_rows_in_zip(const Table& columns) {
  constexpr double zip_limit = 4294967295.0, file_overhead = 512, other_files = 8;
  double row_bytes = 0;
  for (const Column& column : columns.columns)
    row_bytes += static_cast<double>(number_size(column)) * column.components;
  const double files = static_cast<double>(columns.columns.size()) + other_files;
  return std::floor((zip_limit - file_overhead * files) / std::max(1.0, row_bytes));
}

}  // namespace

std::string encode_ply(const ExportMoment& moment) {
  const Table& table = moment.table;
  std::string bytes = "ply\nformat binary_little_endian 1.0\ncomment neve " + std::string(version) +
                      "\ncomment time ";
  append_text(moment.state.time, bytes);
  bytes += " s, frame ";
  append_text(moment.frame(), bytes);
  bytes += "\ncomment up " + std::string(scene::name(moment.spec.up)) + ", units per metre ";
  append_text(moment.spec.scale, bytes);
  bytes += "\n" + spray_comment(table) + "element vertex " + std::to_string(table.rows) + "\n";
  for (const Column& column : table.columns)
    for (int c = 0; c < column.components; ++c)
      bytes += std::string("property ") + ply_type(column) + " " + component_name(column, c) + "\n";
  if (table.mesh)
    bytes += "property float nx\nproperty float ny\nproperty float nz\nelement face " +
             std::to_string(table.mesh->triangles()) + "\nproperty list uchar int vertex_indices\n";
  bytes += "end_header\n";
  bytes.reserve(bytes.size() + table.rows * (row_size(table) + 12) +
                (table.mesh ? 13 * table.mesh->triangles() : 0));
  append_rows(table, bytes);
  if (table.mesh) append_faces(*table.mesh, bytes);
  return bytes;
}

std::string encode_csv(const ExportMoment& moment) {
  const Table& table = moment.table;
  std::string text;
  for (const Column& column : table.columns)
    for (int c = 0; c < column.components; ++c)
      text += (text.empty() ? "" : ",") + component_name(column, c);
  // A column tells the axes: a comment is a line too much for most readers of such files.
  std::string axes;
  if (moment.spec.up == scene::UpAxis::z || moment.spec.scale != 1) {
    text += moment.spec.up == scene::UpAxis::z ? ",up_z_units_per_metre" : ",up_y_units_per_metre";
    append_text(moment.spec.scale, axes);
    axes += ',';
  }
  text += "\n";
  for (std::size_t row = 0; row < table.rows; ++row) {
    for (const Column& column : table.columns)
      for_row(column, row, [&](auto number) {
        append_text(number, text);
        text += ',';
      });
    text += axes;
    text.back() = '\n';
  }
  return text;
}

std::string encode_obj(const ExportMoment& moment) {
  const Table& table = moment.table;
  const MeshRows& mesh = *table.mesh;
  std::string text = "# neve " + std::string(version) + ", time ";
  append_text(moment.state.time, text);
  text += " s\n# up " + std::string(scene::name(moment.spec.up)) + ", units per metre ";
  append_text(moment.spec.scale, text);
  const auto add_line = [&](const char* word, const auto* numbers) {
    text += word;
    for (int a = 0; a < 3; ++a) {
      text += ' ';
      append_text(static_cast<float>(numbers[a]), text);
    }
  };
  for (std::size_t row = 0; row < table.rows; ++row)
    add_line("\nv", table.places().data() + 3 * row);
  for (std::size_t v = 0; v < mesh.vertices; ++v) add_line("\nvn", mesh.normal.data() + 3 * v);
  for (std::size_t k = 0; k < mesh.corners.size(); ++k) {
    const std::string corner = std::to_string(mesh.corners[k] + 1);
    text += (k % 3 == 0 ? "\nf " : " ") + corner + "//" + corner;
  }
  for (std::size_t row = mesh.vertices; row < table.rows; ++row)
    text += "\np " + std::to_string(row + 1);
  return text + "\n";
}

std::string encode(const ExportMoment& moment) {
  switch (moment.spec.format) {
    case scene::ExportFormat::ply:
      return encode_ply(moment);
    case scene::ExportFormat::vtp:
      return encode_vtp(moment);
    case scene::ExportFormat::vti:
      return encode_vti(moment);
    case scene::ExportFormat::vdb:
      return encode_vdb(moment);
    case scene::ExportFormat::bgeo:
      return encode_bgeo(moment);
    case scene::ExportFormat::usda:
      return encode_usda(moment);
    case scene::ExportFormat::npz:
      return encode_npz(moment);
    case scene::ExportFormat::csv:
      return encode_csv(moment);
    case scene::ExportFormat::obj:
      return encode_obj(moment);
  }
  return {};
}

void check_capacity(const scene::Export& spec, const Table& columns, double particles) {
  double most = std::numeric_limits<double>::infinity();
  if (spec.format == scene::ExportFormat::bgeo) most = std::numeric_limits<std::int32_t>::max();
  if (spec.format == scene::ExportFormat::npz) most = max_rows_in_zip(columns);
  if (particles <= most) return;
  throw LimitError("refused: a file of format " + std::string(scene::name(spec.format)) +
                       " holds at most " + fixed_text(most, 0) +
                       " of these particles, and there are " + fixed_text(particles, 0),
                   scene::name(spec.format), "use ply or vtp, or write fewer attributes");
}

}  // namespace neve::app::exports

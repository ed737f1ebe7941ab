#include "app/health/mesh_findings.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <variant>

#include "app/health/findings.h"
#include "app/scene/toml/value.h"
#include "app/setup/snow_pieces.h"
#include "app/support/text.h"
#include "sim/shapes/deforming_mesh.h"
#include "sim/shapes/height_field.h"
#include "sim/shapes/mesh.h"
#include "sim/shapes/solid.h"

namespace neve::app::health {

namespace {

using sim::shapes::MeshReading;

std::string counted(std::size_t count, const char* one, const char* many) {
  return fmt::format("{} {}", count, count == 1 ? one : many);
}

/// Closed parts that overlap. Shares below a thousandth are as good as touching.
void check_crossings(const MeshReading& reading, const std::string& at, const std::string& name,
                     std::vector<Finding>& findings) {
  constexpr double worth_a_word = 1e-3;
  if (reading.crossed >= worth_a_word)
    findings.push_back({Severity::warning, at,
                        fmt::format("parts of {} cross: {} of its volume is in more than one, and "
                                    "counts once",
                                    name, percent_text(reading.crossed)),
                        "unite them in the program that made the mesh if its inner faces matter"});
  if (reading.inside_out >= worth_a_word)
    findings.push_back({Severity::warning, at,
                        fmt::format("{} is partly inside out: a volume of {} of the rest is wound "
                                    "inward and left out",
                                    name, percent_text(reading.inside_out)),
                        "recalculate its normals, or separate parts that share faces"});
}

void check_nesting(const MeshReading& reading, bool is_even_odd, const std::string& at,
                   const std::string& name, std::vector<Finding>& findings) {
  if (reading.nested > 0)
    findings.push_back(
        {Severity::warning, at,
         fmt::format("{} of {} in another one: the inside is filled",
                     counted(reading.nested, "part", "parts"),
                     name + (reading.nested == 1 ? " is" : " are")),
         "fill = \"even_odd\" makes shells in one another solid and empty in turns"});
  if (reading.cavities > 0)
    findings.push_back(
        {Severity::note, at,
         fmt::format("{} has {}", name, counted(reading.cavities, "cavity", "cavities")),
         is_even_odd ? "fill = \"closed\" fills shells that are wound alike"
                     : "a shell that is wound inward in another one is a cavity"});
}

void check_repairs(const MeshReading& reading, const std::string& at, const std::string& name,
                   std::vector<Finding>& findings) {
  // A mesh with all parts wound inward follows another convention, and nothing is in doubt.
  const std::size_t turned = reading.turned_parts;
  if (turned > 0 && turned < reading.parts)
    findings.push_back({Severity::warning, at,
                        fmt::format("{} of the {} parts of {} wound inward and read outward",
                                    turned, reading.parts, name + (turned == 1 ? " is" : " are")),
                        "recalculate its normals in the program that made it"});
  if (reading.turned_faces > 0)
    findings.push_back({Severity::note, at,
                        fmt::format("{} of {} wound against their neighbours and turned",
                                    counted(reading.turned_faces, "face", "faces"),
                                    name + (reading.turned_faces == 1 ? " was" : " were")),
                        "recalculate its normals in the program that made it"});
  if (reading.near_welds > 0)
    findings.push_back(
        {Severity::note, at,
         fmt::format("{} of {} nearly coincided on open edges and became one with others",
                     counted(reading.near_welds, "vertex", "vertices"), name),
         "merge vertices by distance in the program that made it"});
}

void check_openness(const sim::shapes::SolidMesh& mesh, sim::shapes::Fill fill,
                    const std::string& at, const std::string& name,
                    std::vector<Finding>& findings) {
  if (mesh.inside != sim::shapes::Inside::above_half) return;
  const bool is_chosen = fill == sim::shapes::Fill::winding;
  findings.push_back(
      {is_chosen ? Severity::note : Severity::warning, at,
       fmt::format("{} is filled by winding numbers, with {} and {} of its volume in doubt", name,
                   counted(mesh.reading.open_edges, "open edge", "open edges"),
                   percent_text(mesh.reading.in_doubt)),
       is_chosen ? "" : "close its holes, or say fill = \"winding\" if that is meant"});
}

void check_shape(const sim::shapes::Shape& shape, const std::string& address,
                 const std::string& name, std::vector<Finding>& findings) {
  const auto check_closed = [&](const MeshReading& reading, bool is_even_odd,
                                const std::string& at) {
    check_crossings(reading, at, name, findings);
    check_nesting(reading, is_even_odd, at, name, findings);
    check_repairs(reading, at, name, findings);
  };
  if (const auto* sequence = std::get_if<sim::shapes::MeshSequence>(&shape.form))
    check_closed(sim::shapes::deforming_mesh(*sequence)->reading(), false,
                 address + ".shape.mesh_sequence.files");
  const auto* mesh = std::get_if<sim::shapes::Mesh>(&shape.form);
  if (!mesh) return;
  const auto read = sim::shapes::read_solid_mesh(*mesh);
  check_closed(read->reading, read->inside == sim::shapes::Inside::odd,
               address + ".shape.mesh.file");
  check_openness(*read, mesh->fill, address + ".shape.mesh.fill", name, findings);
}

/// Far from the origin, the spacing of numbers in single precision reaches the size of cells. Files
/// hold such numbers. Other snow has them in pictures alone, where less shows.
void check_distance(const scene::Scene& scene, const sim::shapes::Shape& shape,
                    const std::string& address, const std::string& name, bool is_snow,
                    std::vector<Finding>& findings) {
  const bool is_mesh = std::holds_alternative<sim::shapes::Mesh>(shape.form);
  const bool is_points = std::holds_alternative<sim::shapes::Points>(shape.form);
  const bool is_terrain = std::holds_alternative<sim::shapes::Terrain>(shape.form);
  const bool is_of_file = is_mesh || is_points || is_terrain;
  if (!is_of_file && !is_snow) return;
  constexpr double single = 0x1p-23;
  const double worth_a_word = is_of_file ? 0.001 : 0.02;
  const sim::shapes::Bounds b = sim::shapes::Solid(shape).bounds();
  const double far = std::max(b.min.cwiseAbs().maxCoeff(), b.max.cwiseAbs().maxCoeff());
  const double h = scene.solver.cell_size;
  if (single * far < worth_a_word * h) return;
  if (!is_of_file) {
    findings.push_back(
        {Severity::warning, address + ".shape",
         fmt::format("{} reaches {} m from the scene's origin: pictures have numbers "
                     "in single precision, and show its places {} cells apart",
                     name, rough_text(far), rough_text(single * far / h)),
         "move the whole scene to its origin"});
    return;
  }
  findings.push_back(
      {Severity::warning,
       address + ".shape." +
           (is_mesh     ? "mesh"
            : is_points ? "points"
                        : "terrain"),
       fmt::format("{} reaches {} m from the scene's origin, where numbers in single precision are "
                   "{} cells apart",
                   name, rough_text(far), rough_text(single * far / h)),
       "coordinates = \"world\" takes the offset of a map out, and exports put it back"});
}

/// Rounds a height to three digits of the range, or to a decimal place if that is finer.
std::string height_text(double height, double range) {
  const double digit =
      std::pow(10, std::min(-1.0, std::floor(std::log10(std::max(range, 1e-9))) - 2));
  return scene::toml::number_text(std::round(height / digit) * digit + 0.0) + " m";
}

void note_posts(const sim::shapes::Terrain& terrain, const std::string& address,
                const std::string& name, std::vector<Finding>& findings) {
  const auto field = sim::shapes::height_field(terrain);
  const sim::files::HeightGrid& grid = field->grid();
  findings.push_back(
      {Severity::note, address + ".shape.terrain.file",
       fmt::format("{} has {} x {} posts, {} apart, at heights from {} to {}", name, grid.columns,
                   grid.rows, rough_text(grid.spacing) + " m",
                   height_text(grid.datum + grid.lowest, grid.highest - grid.lowest),
                   height_text(grid.datum + grid.highest, grid.highest - grid.lowest)),
       "beyond its posts it continues level"});
}

void check_holes(const sim::shapes::Terrain& terrain, const std::string& address,
                 const std::string& name, std::vector<Finding>& findings) {
  if (sim::shapes::height_field(terrain)->has_holes())
    findings.push_back(
        {Severity::warning, address + ".shape.terrain.file",
         fmt::format("{} has posts without data: holes, through which snow falls", name),
         "fill them: gdal_fillnodata.py"});
}

/// @param mass  kg
void note_cover(const sim::shapes::Shape& shape, double mass, const std::string& address,
                const std::string& name, std::vector<Finding>& findings) {
  const auto* cover = std::get_if<sim::shapes::Cover>(&shape.form);
  if (!cover) return;
  const double volume = sim::shapes::volume(shape);
  findings.push_back(
      {Severity::note, address + ".shape.cover",
       fmt::format("{} lies {} m deep on {} m2 seen from above: {} m3, {} kg", name,
                   rough_text(cover->depth), rough_text(volume / cover->depth), rough_text(volume),
                   rough_text(mass)),
       "depth is vertical; across a slope it is depth times the cosine of its angle"});
}

}  // namespace

void check_meshes(const scene::Scene& scene, std::vector<Finding>& findings) {
  const auto check_all = [&](const auto& objects, const std::string& kind) {
    for (const auto& object : objects) {
      const std::string address = kind + "." + object.name;
      check_shape(object.shape, address, display_name(kind, object.name), findings);
      const bool is_snow = kind == "body" || kind == "emitter";
      check_distance(scene, object.shape, address, display_name(kind, object.name), is_snow,
                     findings);
      if (const auto* terrain = std::get_if<sim::shapes::Terrain>(&object.shape.form))
        check_holes(*terrain, address, display_name(kind, object.name), findings);
    }
  };
  check_all(scene.bodies, "body");
  check_all(scene.emitters, "emitter");
  check_all(scene.sinks, "sink");
  check_all(scene.colliders, "collider");
}

void note_terrain(const scene::Scene& scene, std::vector<Finding>& findings) {
  for (const setup::SnowPiece& piece : setup::snow_pieces(scene)) {
    const std::string name = piece.address.substr(piece.address.find('.') + 1);
    note_cover(*piece.shape, piece.mass, piece.address, display_name("body", name), findings);
  }
  for (const scene::Collider& collider : scene.colliders)
    if (const auto* terrain = std::get_if<sim::shapes::Terrain>(&collider.shape.form))
      note_posts(*terrain, "collider." + collider.name, display_name("collider", collider.name),
                 findings);
}

}  // namespace neve::app::health

#include "app/health/mesh_findings.h"

#include <fmt/core.h>

#include <algorithm>
#include <string>
#include <variant>

#include "app/health/findings.h"
#include "app/support/text.h"
#include "sim/shapes/deforming_mesh.h"
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
  // Where all parts are wound inward, one convention differs from another and nothing is in doubt.
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

/// Far from the origin, the spacing of numbers in single precision reaches the size of cells.
void check_distance(const scene::Scene& scene, const sim::shapes::Shape& shape,
                    const std::string& address, const std::string& name,
                    std::vector<Finding>& findings) {
  const bool is_mesh = std::holds_alternative<sim::shapes::Mesh>(shape.form);
  const bool is_points = std::holds_alternative<sim::shapes::Points>(shape.form);
  if (!is_mesh && !is_points) return;
  constexpr double single = 0x1p-23, worth_a_word = 0.001;
  const sim::shapes::Bounds b = sim::shapes::Solid(shape).bounds();
  const double far = std::max(b.min.cwiseAbs().maxCoeff(), b.max.cwiseAbs().maxCoeff());
  const double h = scene.solver.cell_size;
  if (single * far < worth_a_word * h) return;
  findings.push_back(
      {Severity::warning, address + ".shape." + (is_mesh ? "mesh" : "points"),
       fmt::format("{} reaches {} m from the scene's origin, where numbers in single precision are "
                   "{} cells apart",
                   name, rough_text(far), rough_text(single * far / h)),
       "coordinates = \"world\" takes the offset of a map out, and exports put it back"});
}

}  // namespace

void check_meshes(const scene::Scene& scene, std::vector<Finding>& findings) {
  const auto check_all = [&](const auto& objects, const std::string& kind) {
    for (const auto& object : objects) {
      const std::string address = kind + "." + object.name;
      check_shape(object.shape, address, display_name(kind, object.name), findings);
      check_distance(scene, object.shape, address, display_name(kind, object.name), findings);
    }
  };
  check_all(scene.bodies, "body");
  check_all(scene.emitters, "emitter");
  check_all(scene.sinks, "sink");
  check_all(scene.colliders, "collider");
}

}  // namespace neve::app::health

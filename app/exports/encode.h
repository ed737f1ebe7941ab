#pragma once
/// One moment as the bytes of one file, a function per format.

#include <string>

#include "app/exports/columns.h"
#include "app/exports/series.h"
#include "sim/types/grid_fields.h"

namespace neve::app::exports {

/// All that a file may tell of its moment.
struct ExportMoment {
  const scene::Scene& scene;
  const scene::Export& spec;
  const State& state;
  const Table& table;

  const sim::RasterizedNodes& nodes() const { return state.nodes.at(spec.bodies); }
  /// Time in frames of the scene, with the numbers of its files.
  double frame() const { return time_in_frames(scene, state.time); }
};

/// Binary little endian; a property per number: x y z vx vy vz F_E_xx ... Vertices of a surface
/// have normals and are in faces, but for the spray at the end. Source: Turk, The PLY Polygon File
/// Format.
std::string encode_ply(const ExportMoment& moment);

/// A line of names, then a line per particle; every number reads as the same bits. The last column
/// of a file that is turned or scaled has the units per metre, and its name the axis that is up.
std::string encode_csv(const ExportMoment& moment);

/// A zip archive of arrays, uncompressed: one per attribute, and time, frame, fps, scale, up.
/// Source: numpy.lib.format, version 1.0.
std::string encode_npz(const ExportMoment& moment);

/// VTK XML PolyData: a vertex per particle, or the triangles of a surface and vertices for the
/// spray; raw appended arrays.
std::string encode_vtp(const ExportMoment& moment);
/// The same of a table alone. @param time  its field data
std::string vtp_text(const Table& table, const std::string& time = "");

/// VTK XML ImageData: mass and velocity of all nodes in the box around the snow.
/// @throws LimitError when particles far apart make the box too large
std::string encode_vti(const ExportMoment& moment);

/// OpenVDB: mass, density and velocity of the nodes that carry mass; with the surface, its signed
/// distance as a level set. Numbers are in single precision.
std::string encode_vdb(const ExportMoment& moment);

/// Houdini's classic binary geometry, version 5, which has single precision only.
/// Source: read by partio (Walt Disney Animation Studios), src/lib/io/BGEO.cpp.
std::string encode_bgeo(const ExportMoment& moment);

/// A layer with the particles as Points at one time code, or the surface as a Mesh and the spray as
/// Points; places and velocities are in single precision, as the schemas say.
/// Source: OpenUSD, UsdGeomPoints, UsdGeomMesh.
std::string encode_usda(const ExportMoment& moment);

/// Wavefront text: vertices in single precision with normals, triangles, and a point per particle
/// of the spray. It is for surfaces only.
std::string encode_obj(const ExportMoment& moment);

std::string encode(const ExportMoment& moment);

/// @throws LimitError when so many particles cannot be in a file of the format
void check_capacity(const scene::Export& spec, const Table& columns, double particles);

}  // namespace neve::app::exports

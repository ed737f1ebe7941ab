#pragma once
/// Meshes from files: OBJ, PLY with faces, and STL, told apart by what is in them.

#include <string>
#include <string_view>

#include "sim/files/obj_reader.h"

namespace neve::sim::files {

/// @param name of the file in messages
/// @throws ShapeError as the reader of the format; for formats that are not read, with what to do
PolygonMesh parse_mesh(std::string_view bytes, const std::string& name);

/// Elements vertex (x, y, z) and face (a list vertex_indices, vertex_index or indices), ascii or
/// binary of either byte order; everything else is passed over.
/// A file that neve wrote with z up or in other units is turned and scaled back.
/// Source: Turk, The PLY Polygon File Format.
PolygonMesh parse_ply_mesh(std::string_view bytes, const std::string& name);

/// Triangles of an ascii or binary STL, each with corners of its own; normals are passed over.
PolygonMesh parse_stl(std::string_view bytes, const std::string& name);

/// @throws ShapeError also when the file cannot be read or is larger than 256 MiB
PolygonMesh read_mesh(const std::string& path);

}  // namespace neve::sim::files

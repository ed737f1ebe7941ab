#pragma once
/// A closed, oriented triangle mesh around particles.

#include "render/frame/frame.h"
#include "render/surface/field.h"

namespace neve::render::surface {

struct Settings {
  Kernel kernel;
  int smallest_piece = 1;       ///< particles; smaller pieces are spray
  std::uint64_t max_bytes = 0;  ///< of the lattice; 0: no limit
};

struct Surface {
  TriangleMesh mesh;                 ///< with normals
  std::vector<std::uint32_t> spray;  ///< particles without a mesh around them, ascending
  std::size_t pieces = 0;            ///< bodies of connected snow
};

/// Makes a surface, the same at any number of threads. @param pool may be null @throws MemoryError
/// Check: Surface.*
Surface make_surface(const Grains& grains, const Settings& settings, ThreadPool* pool);

}  // namespace neve::render::surface

#pragma once
/// Closed parts of a mesh: which of them are solid, which are cavities, and the volume that they
/// enclose together.

#include <cstdint>
#include <vector>

#include "sim/shapes/mesh.h"

namespace neve::sim::shapes {

/// m3, signed, of all faces together: parts that overlap count twice, parts wound inward negative.
double enclosed_by_faces(const SolidMesh& mesh);

/// Turns a part outward where no other part encloses it. In another one it keeps its winding
/// relative to that: wound the same way it is filled, wound the other way it is a cavity. With
/// Inside::odd every part is turned outward. Sets the volume, of what is inside, and the reading.
/// Volume and moments, where they are not those of all faces, count each part as often as they
/// should, which is exact for parts in one another. Lines measure where parts cross: 65536, to
/// about 1e-3 of the overlap, and fewer where thousands of parts lie in the way. The reading has
/// the error of that.
/// @param part  of each triangle
void read_parts(SolidMesh& mesh, const std::vector<std::uint32_t>& part, std::size_t part_count);

}  // namespace neve::sim::shapes

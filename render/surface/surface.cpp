#include "render/surface/surface.h"

#include <cmath>

#include "render/surface/pieces.h"
#include "render/surface/triangles.h"

namespace neve::render::surface {

Surface make_surface(const Grains& grains, const Settings& settings, ThreadPool* pool) {
  GrainField made = make_field(grains, settings.kernel, settings.max_bytes, pool);
  // A particle that sticks out of a piece, but is within the kernel's width of it, is no spray.
  const float width = settings.kernel.width / settings.kernel.cell;
  const PieceRules rules{settings.smallest_piece, static_cast<int>(std::ceil(width))};
  Pieces pieces = find_pieces(grains, made.grains, rules, made.field, pool);
  Surface surface;
  surface.mesh = triangles_of(made.field, pieces.inside, pool);
  surface.spray = std::move(pieces.loose);
  surface.pieces = pieces.count;
  return surface;
}

}  // namespace neve::render::surface

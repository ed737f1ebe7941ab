#include "render/surface/surface.h"

#include "render/surface/pieces.h"
#include "render/surface/triangles.h"

namespace neve::render::surface {

Surface make_surface(const Grains& grains, const Settings& settings, ThreadPool* pool) {
  GrainField made = make_field(grains, settings.kernel, settings.max_bytes, pool);
  Pieces pieces = find_pieces(grains, made.grains, settings.smallest_piece, made.field, pool);
  Surface surface;
  surface.mesh = triangles_of(made.field, pieces.inside, pool);
  surface.spray = std::move(pieces.loose);
  surface.pieces = pieces.count;
  return surface;
}

}  // namespace neve::render::surface

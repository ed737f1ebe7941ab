#pragma once
/// Pieces of snow: nodes inside that touch along edges of the lattice, and their particles.

#include "render/surface/field.h"

namespace neve::render::surface {

/// A node is inside where the snow fills at least this share.
inline constexpr float surface_share = 0.5f;

/// The nodes of a block that are inside: bit 8 j + i of slice k.
struct InsideBits {
  std::array<std::uint64_t, block_side> slice{};

  bool operator==(const InsideBits&) const = default;
};

/// Takes pieces of too few particles out of a field, and lists the particles that no piece has.
/// A particle belongs to the piece of the nearest node inside, if that is near.
struct Pieces {
  std::size_t count = 0;             ///< that are left
  std::vector<InsideBits> inside;    ///< of the nodes that are left, for each block
  std::vector<std::uint32_t> loose;  ///< particles without a piece, ascending
};

struct PieceRules {
  int smallest = 1;  ///< particles of the smallest piece that stays
  int reach = 1;     ///< cells from a particle to the piece that it belongs to, at most 6
};

Pieces find_pieces(const Grains& grains, const Bins& blocks, const PieceRules& rules, Field& field,
                   ThreadPool* pool);

}  // namespace neve::render::surface

#include "sim/types/particle_arrays.h"

#include <algorithm>

namespace neve::sim {

std::size_t ParticleArrays::first_from(std::uint64_t wanted) const {
  if (id.empty()) return static_cast<std::size_t>(std::min<std::uint64_t>(wanted, x.size()));
  return static_cast<std::size_t>(std::lower_bound(id.begin(), id.end(), wanted) - id.begin());
}

std::optional<std::size_t> ParticleArrays::index_of(std::uint64_t wanted) const {
  const std::size_t index = first_from(wanted);
  if (index == x.size() || id_of(index) != wanted) return std::nullopt;
  return index;
}

Material ParticleArrays::material_of(std::size_t index,
                                     const std::vector<Material>& materials) const {
  return scaled(materials[static_cast<std::size_t>(material[index])],
                stiffness.empty() ? 1 : stiffness[index], threshold.empty() ? 1 : threshold[index]);
}

}  // namespace neve::sim

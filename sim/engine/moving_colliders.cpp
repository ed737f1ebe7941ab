#include "sim/engine/moving_colliders.h"

#include <stdexcept>
#include <string>

#include "sim/engine/kernel_pose.h"
#include "sim/types/errors.h"

namespace neve::sim::engine {

MovingColliders::MovingColliders(const std::vector<shapes::Collider>& colliders,
                                 const Lattice& lattice, double time, ThreadPool& pool)
    : list_(colliders) {
  if (list_.size() > kernels::max_colliders)
    throw std::invalid_argument("at most " + std::to_string(kernels::max_colliders) + " colliders");
  for (const shapes::Collider& c : list_) {
    const auto* mesh = std::get_if<shapes::Mesh>(&c.shape.form);
    try {
      fields_.push_back(mesh ? shapes::distance_field(*mesh, lattice.cell_size, pool) : nullptr);
    } catch (const ShapeError& error) {
      throw ShapeError("collider " + c.name + ": " + error.what());
    }
  }
  place(lattice, time);
}

void MovingColliders::place(const Lattice& lattice, double time) {
  poses_.clear();
  for (std::size_t k = 0; k < list_.size(); ++k)
    if (const auto pose =
            kernel_pose(list_[k], time, lattice.cell_size, lattice.origin, fields_[k].get()))
      poses_.push_back(*pose);
}

std::uint64_t MovingColliders::memory_bytes() const {
  std::uint64_t bytes = 0;
  for (const auto& field : fields_) bytes += field ? field->bytes() : 0;
  return bytes;
}

}  // namespace neve::sim::engine

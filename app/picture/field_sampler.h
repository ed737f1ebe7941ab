#pragma once
/// Trilinear interpolation of node fields.

#include <array>
#include <optional>
#include <vector>

#include "app/picture/node_fields.h"

namespace neve::app::picture {

/// Index of a node in the arrays of a field; nothing if its block is absent.
std::optional<std::size_t> node_index(const render::NodeLattice& lattice, const Vec3i& node);

/// Trilinear weights of the nodes around a point; those that carry no mass do not count.
class FieldSampler {
 public:
  explicit FieldSampler(const FieldSamples& fields) : fields_(fields) {}

  struct Stencil {
    std::array<std::size_t, 8> node;
    std::array<float, 8> weight{};  ///< sum 1
    int count = 0;
    float cover = 0;  ///< sum of the trilinear weights of nodes with mass: 1 inside of the snow
  };
  /// Returns the stencil of a point; nothing if all eight nodes are empty.
  std::optional<Stencil> at(const sim::Vec3d& point) const;

  template <class Value>
  static Value mean(const Stencil& stencil, const std::vector<Value>& values) {
    Value sum{};
    for (int n = 0; n < stencil.count; ++n) {
      const auto k = static_cast<std::size_t>(n);
      sum = sum + stencil.weight[k] * values[stencil.node[k]];
    }
    return sum;
  }

 private:
  const FieldSamples& fields_;
};

}  // namespace neve::app::picture

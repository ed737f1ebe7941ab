#include "sim/types/threshold_cell.h"

#include <cmath>

namespace neve::sim {

double threshold_factor(const SolverSettings& settings) {
  return settings.threshold_cell > 0 ? std::sqrt(settings.threshold_cell / settings.cell_size) : 1;
}

Material in_cells(const Material& material, const SolverSettings& settings) {
  Material out = material;
  const double factor = threshold_factor(settings);
  if (material.model == Model::snow) {
    out.critical_stretch *= factor;
    out.critical_compression *= std::sqrt(factor);
  }
  if (material.model == Model::cam_clay) out.cohesion *= factor;
  return out;
}

std::vector<Material> in_cells(const std::vector<Material>& materials,
                               const SolverSettings& settings) {
  std::vector<Material> all;
  for (const Material& material : materials) all.push_back(in_cells(material, settings));
  return all;
}

}  // namespace neve::sim

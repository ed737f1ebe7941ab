#include "sim/laws/threshold_cell.h"

#include <cmath>

#include "sim/laws/law.h"

namespace neve::sim::laws {

double threshold_factor(const SolverSettings& settings) {
  return settings.threshold_cell > 0 ? std::sqrt(settings.threshold_cell / settings.cell_size) : 1;
}

Material in_cells(const Material& material, const SolverSettings& settings) {
  Material out = material;
  if (const auto refine = of(material).refine) refine(out, threshold_factor(settings));
  return out;
}

std::vector<Material> in_cells(const std::vector<Material>& materials,
                               const SolverSettings& settings) {
  std::vector<Material> all;
  for (const Material& material : materials) all.push_back(in_cells(material, settings));
  return all;
}

}  // namespace neve::sim::laws

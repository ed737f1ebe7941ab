#include "app/card/first_yield.h"

#include <Eigen/LU>

#include "sim/health/diagnostics.h"

namespace neve::app::card {

sim::Mat3d stretched(double strain) {
  sim::Mat3d F = sim::Mat3d::Identity();
  F(1, 1) += strain;
  return F;
}

sim::Mat3d elastic_stress(const sim::Material& material, const sim::Mat3d& F) {
  return sim::health::first_piola(material, F, 1) * F.transpose() / F.determinant();
}

std::optional<double> first_yield(const sim::Material& material, const Path& path, double largest) {
  const auto yields = [&](double strain) {
    return sim::health::nearness_to_yield(material, path(strain), 1) >= 1;
  };
  if (!yields(largest)) return std::nullopt;
  double low = 0, high = largest;
  for (int k = 0; k < 60; ++k) {
    const double middle = 0.5 * (low + high);
    (yields(middle) ? high : low) = middle;
  }
  return high;
}

}  // namespace neve::app::card

#pragma once
/// Energy and stress in double for reports, sums and tests; the search for culprits.

#include <array>

#include "sim/laws/law.h"
#include "sim/types/particle_arrays.h"
#include "sim/types/reports.h"
#include "sim/types/settings.h"

namespace neve::sim::health {

/// e^(xi (1 - J_P)) between the least and the largest factor: how much stiffer than at rest.
double hardening_factor(const Material& material, double J_P);

/// Elastic energy per initial volume, J/m3: that of the law, as the others here.
/// @param F_E elastic deformation gradient, any determinant that the law bears
/// @param J_P det of the plastic part, dimensionless
/// Check: Energy.StressIsItsDerivative
double energy_density(const Material& material, const Mat3d& F_E, double J_P);

/// Returns those of four particles, for little more than the price of one: the same bits.
std::array<double, 4> energy_densities(const std::array<const Material*, 4>& materials,
                                       const std::array<Mat3d, 4>& F_E,
                                       const std::array<double, 4>& J_P);

/// First Piola-Kirchhoff stress dPsi/dF_E, Pa.
Mat3d first_piola(const Material& material, const Mat3d& F_E, double J_P);

/// Returns energy density and stress at once, where the law has a way at the price of one.
laws::ElasticResponse elastic_response(const Material& material, const Mat3d& F_E, double J_P);

/// Speed of the fastest elastic wave, as the acoustic limit sees it, m/s.
/// @param rho0 mass / initial volume, kg/m3
double wave_speed(const Material& material, const Mat3d& F_E, double J_P, double rho0);

/// Pressure of Kirchhoff stress that packs a material whose law has such a one, Pa; 0 for others.
double consolidation_pressure(const Material& material, double J_P);

/// 1 where the material yields, below inside, 0 at rest in the middle, as its law measures it; 0
/// for elastic laws.
double nearness_to_yield(const Material& material, const Mat3d& F_E, double J_P);

/// Fills in the culprit of the rule that d names, its state, and the sentence for the user.
void find_culprits(const ParticleArrays& particles, const SolverSettings& settings,
                   const std::vector<Material>& materials, Divergence& d);

}  // namespace neve::sim::health

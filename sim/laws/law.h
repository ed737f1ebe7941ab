#pragma once
/// The statements of a law beside its kernels: numbers in double for reports, sums, checks and
/// tests, and plain data from which scenes, sliders, colours, captions and self-tests are made.

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "sim/kernels/particles.h"
#include "sim/types/material.h"
#include "sim/types/math.h"
#include "sim/types/time_step.h"

namespace neve::sim::laws {

enum class Unit { none, pascal, degrees };

struct Bounds {
  double min, max;
  bool is_min_open = false, is_max_open = false;
};

/// A value of a parameter that is one of some names.
struct OneOf {
  std::size_t place;
  std::span<const char* const> names;

  const char* name() const { return names[place]; }
};

/// A number of a law, as scenes, sweeps and sliders have it. One that several laws or reports read
/// is a member of Material; one that its law alone reads has a place in Material::own that no other
/// law's has.
struct Parameter {
  const char* key;
  double Material::*member = nullptr;
  int own = -1;
  double own_default = 0;
  Unit unit = Unit::none;
  Bounds bounds = {};
  std::span<const char* const> names = {};  ///< of its values 0, 1, ...: it has no other then
  const char* help;

  double& of(Material& m) const {
    return member ? m.*member : m.own[static_cast<std::size_t>(own)];
  }
  double of(const Material& m) const {
    return member ? m.*member : m.own[static_cast<std::size_t>(own)];
  }
  OneOf name_of(const Material& m) const { return {static_cast<std::size_t>(of(m)), names}; }
};

/// Energy density and stress at once, for the price of one decomposition.
struct ElasticResponse {
  double energy_density;  ///< J/m3
  Mat3d first_piola;      ///< Pa
};

/// States that a surface of yield holds.
struct Surface {
  double pressure;      ///< Pa, largest
  double tension;       ///< Pa
  double deviator;      ///< Pa, largest q
  double min_J, max_J;  ///< of F_E; min_J is 0 where it holds any pressure
};

/// Ends of the colours of stress and strain: what the material bears at the start. Infinite: as
/// much as occurs.
struct Scale {
  double pressure, shear;  ///< Pa
  double strain;           ///< change of J_E
};

/// A doubt of `neve check` about a material. {} in a text are its numbers.
struct Concern {
  const char* key;  ///< of the parameter
  const char* text;
  std::vector<double> numbers;
  const char* remedy;
  double remedy_number;  ///< may be rounded up
};

/// Tolerance of a self-test, by precision.
struct Tolerance {
  double real64, single;
};
/// Tolerance for rounding. States are of order one in their units (weights, strains, speeds in
/// m/s), sums have at most a few hundred terms, and the errors found are 3e-15 in double and 1e-6
/// in float: so only mistakes fail, also on other machines.
inline constexpr Tolerance rounding{1e-11, 2e-5};
/// Surfaces lie a few per cent of the stiffness away from no stress at all, so a share of them is
/// good to a hundredth of the digits.
inline constexpr Tolerance on_surfaces{1e-8, 5e-3};

/// Something that a step has to leave 0.
struct Claim {
  const char* what;
  double value;
  Tolerance tolerance;
};
/// A particle before and after a step that only makes it yield.
struct YieldStep {
  Mat3d F_E;
  double J_P;
  Mat3d F_E_after;
  double J_P_after;
};
struct SelfTest {
  const char* claim;  ///< after the law's name
  double J_P;         ///< of its particles, about
  void (*run)(const Material&, const YieldStep&, std::vector<Claim>&);
};

/// A state is F_E and J_P = det F_P; of a law that needs another history J_P is that. Functions
/// that may be null say so.
struct Law {
  Model model{};  ///< from the list, as the name is
  const char* name = "";
  const char* kind;      ///< what follows the name in the description of `model`
  bool is_snow = false;  ///< packs, tears, and can be packed again; its density is that of snow
  bool hardens = false;  ///< moduli grow by e^(xi (1 - J_P)) as it packs
  bool is_plastic;       ///< as its kernels say
  bool has_derivative = true;  ///< in lanes; false: Hooke's law takes its place
  bool is_granular = false;  ///< bears no tension; its density and stiffness are not those of snow
  bool is_benched = false;   ///< has rows of its own in `neve bench sim`
  std::span<const Parameter> parameters;
  const Parameter* rate = nullptr;  ///< the one that says how fast it hardens; may be null
  const char* caption;              ///< below pictures: {} are the parameters in their order

  // Functions of a state, for a particle's material; see sim/health/diagnostics.h.
  double (*energy_density)(const Material&, const Mat3d& F_E, double J_P);
  Mat3d (*first_piola)(const Material&, const Mat3d& F_E, double J_P);
  double (*wave_modulus)(const Material&, const Mat3d& F_E, double J_P);  ///< rho0 c^2, Pa
  double (*nearness_to_yield)(const Material&, const Mat3d& F_E, double J_P) = nullptr;
  double (*consolidation_pressure)(const Material&, double J_P) = nullptr;  ///< may be null
  /// Faster ways to the first two, and to the energy of four particles: same bits. May be null.
  ElasticResponse (*response)(const Material&, const Mat3d& F_E, double J_P) = nullptr;
  std::array<double, 4> (*energies)(const std::array<const Material*, 4>&,
                                    const std::array<Mat3d, 4>& F_E,
                                    const std::array<double, 4>& J_P) = nullptr;

  // Functions of a material.
  /// MaterialConstants::own. May be null.
  void (*constants)(const Material&, double (&own)[kernels::own_constants]) = nullptr;
  /// Thresholds in cells of another size, see threshold_cell.h. May be null.
  void (*refine)(Material&, double factor) = nullptr;
  Scale (*scale)(const Material&);
  Surface (*surface)(const Material&, double J_P) = nullptr;  ///< may be null
  double (*largest_pressure)(const Material&) = nullptr;      ///< that F_E can bear; null: any
  void (*concerns)(const Material&, std::vector<Concern>&) = nullptr;
  bool (*counts_volume)(const Material&) = nullptr;  ///< J_P is det F_P; null: it is
  const SelfTest* self_test = nullptr;

  bool reads(double Material::*member) const;
};

/// Returns the laws in the order of their numbers.
std::span<const Law> every();
const Law& of(Model model);
inline const Law& of(const Material& material) {
  return of(material.model);
}

/// True if J_P of a material's particles is their plastic volume.
inline bool counts_volume(const Material& material) {
  const auto counts = of(material).counts_volume;
  return !counts || counts(material);
}

/// Extends the limits to a material, if its law hardens. @param stiffest  factor on its moduli
void include_hardening(const Material& material, StateLimits& limits, double stiffest = 1);

/// Returns the parameters of all laws, each once.
std::span<const Parameter> all_parameters();
/// The description of `model`.
const char* help_of_model();

}  // namespace neve::sim::laws

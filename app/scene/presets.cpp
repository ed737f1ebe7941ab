#include "app/scene/presets.h"

#include <array>

#include "app/scene/reader.h"

namespace neve::app::scene {

namespace {

/// Density (kg/m3), Young's modulus (Pa), Poisson ratio; of the paper's snow hardening, critical
/// compression and stretch; of cam clay friction angle (degrees), cohesion, consolidation pressure
/// (Pa) and its hardening.
///
/// The six of the paper are those of its figure of parameter variations. The other four follow what
/// the paper says of its parameters: small thresholds make dry powder and large ones wet, chunky
/// snow; high hardening and stiffness make it icy and brittle, low ones muddy. Their densities are
/// those of nature: fresh dry snow has 70 to 150 kg/m3 (American Meteorological Society, Glossary
/// of Meteorology, "snow density"), dense snow about 500, as wet snow of late spring, and glacier
/// ice 917; icy snow lies between. Their stiffness goes with the density, but within about ten
/// times of the paper's, like all stiffnesses that it shows: real snow is stiffer, and time steps
/// are as short as sound is fast.
struct Row {
  Preset preset;
  double numbers[10];
};
constexpr std::array rows{
    Row{Preset::paper, {400, 1.4e5, 0.2, 10, 0.025, 0.0075, 39, 0.4, 4500, 1}},
    Row{Preset::lower_hardening, {400, 1.4e5, 0.2, 5, 0.025, 0.0075, 39, 0.4, 4500, 1}},
    Row{Preset::lower_youngs_modulus, {400, 4.8e4, 0.2, 10, 0.025, 0.0075, 39, 0.4, 4500, 1}},
    Row{Preset::lower_critical_compression, {400, 1.4e5, 0.2, 10, 0.019, 0.0075, 39, 0.4, 4500, 1}},
    Row{Preset::lower_critical_stretch, {400, 1.4e5, 0.2, 10, 0.025, 0.005, 39, 0.4, 4500, 1}},
    Row{Preset::lower_compression_and_stretch,
        {400, 1.4e5, 0.2, 10, 0.019, 0.005, 39, 0.4, 4500, 1}},
    Row{Preset::powder, {150, 4e4, 0.2, 7, 0.015, 0.002, 39, 0.2, 500, 1}},
    Row{Preset::wet, {500, 1e5, 0.2, 5, 0.04, 0.015, 45, 0.8, 4000, 1}},
    Row{Preset::packed, {500, 4e5, 0.2, 10, 0.025, 0.0075, 39, 0.5, 8000, 1}},
    Row{Preset::icy, {700, 1.4e6, 0.3, 20, 0.02, 0.004, 39, 0.3, 30000, 3}},
    Row{Preset::quick, {400, 5e4, 0.2, 10, 0.025, 0.0075, 39, 0.4, 4500, 1}},
};

std::array<double*, 10> numbers_of(sim::Material& m) {
  return {&m.density,
          &m.youngs_modulus,
          &m.poisson_ratio,
          &m.hardening,
          &m.critical_compression,
          &m.critical_stretch,
          &m.friction_angle,
          &m.cohesion,
          &m.consolidation_pressure,
          &m.consolidation_hardening};
}

}  // namespace

void use_preset(sim::Material& material, Preset preset) {
  const auto numbers = numbers_of(material);
  for (const Row& row : rows)
    if (row.preset == preset)
      for (std::size_t k = 0; k < numbers.size(); ++k) *numbers[k] = row.numbers[k];
}

sim::Material snow_of(Preset preset) {
  sim::Material material;
  use_preset(material, preset);
  return material;
}

std::optional<Preset> preset_of(const sim::Material& material) {
  // Density and elasticity are of every law; then three numbers of the paper's snow, four of cam
  // clay. Those that a law does not read do not tell its presets apart.
  constexpr std::size_t common = 3, cam_clay = 6, all = 10;
  const bool is_clay = material.model == sim::Model::cam_clay;
  sim::Material copy = material;
  const auto numbers = numbers_of(copy);
  for (const Row& row : rows) {
    bool is_same = true;
    for (std::size_t k = 0; k < all; ++k)
      if (k < common || (k >= cam_clay) == is_clay)
        is_same = is_same && *numbers[k] == row.numbers[k];
    if (is_same) return row.preset;
  }
  return std::nullopt;
}

bool is_preset_address(std::string_view address) {
  const auto first = address.find('.');
  const auto last = address.rfind('.');
  return address.starts_with("material.") && last != first && address.substr(last) == ".preset" &&
         address.find('.', first + 1) == last;
}

std::vector<std::string> addresses_set_by(const std::string& preset_address) {
  const std::string table = preset_address.substr(0, preset_address.rfind('.') + 1);
  Keys keys;
  sim::Material material;
  describe_snow_numbers(keys, material);
  for (std::string& key : keys.keys) key.insert(0, table);
  return std::move(keys.keys);
}

}  // namespace neve::app::scene

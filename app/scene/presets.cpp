#include "app/scene/presets.h"

#include <algorithm>
#include <array>
#include <span>

#include "sim/laws/law.h"

namespace neve::app::scene {

namespace {

/// Parameters that presets set: those of any material, and those of laws that mean snow. A law
/// reads some of them; those that it does not read do not tell its presets apart.
constexpr std::size_t of_any_law = 4;
constexpr const char* keys[] = {
    "density",   "youngs_modulus",         "poisson_ratio",          "dust",
    "hardening", "critical_compression",   "critical_stretch",       "friction_angle",
    "cohesion",  "consolidation_pressure", "consolidation_hardening"};

/// The six of the paper are those of its figure of parameter variations. The other four follow what
/// the paper says of its parameters: small thresholds make dry powder and large ones wet, chunky
/// snow; high hardening and stiffness make it icy and brittle, low ones muddy. Their densities are
/// those of nature: fresh dry snow has 70 to 150 kg/m3 (American Meteorological Society, Glossary
/// of Meteorology, "snow density"), dense snow about 500, as wet snow of late spring, and glacier
/// ice 917; icy snow lies between. Their stiffness goes with the density, but within about ten
/// times of the paper's, like all stiffnesses that it shows: real snow is stiffer, and time steps
/// are as short as sound is fast. Powder alone sheds dust.
struct Row {
  Preset preset;
  double numbers[std::size(keys)];
};
constexpr std::array rows{
    Row{Preset::paper, {400, 1.4e5, 0.2, 0, 10, 0.025, 0.0075, 39, 0.4, 4500, 1}},
    Row{Preset::lower_hardening, {400, 1.4e5, 0.2, 0, 5, 0.025, 0.0075, 39, 0.4, 4500, 1}},
    Row{Preset::lower_youngs_modulus, {400, 4.8e4, 0.2, 0, 10, 0.025, 0.0075, 39, 0.4, 4500, 1}},
    Row{Preset::lower_critical_compression,
        {400, 1.4e5, 0.2, 0, 10, 0.019, 0.0075, 39, 0.4, 4500, 1}},
    Row{Preset::lower_critical_stretch, {400, 1.4e5, 0.2, 0, 10, 0.025, 0.005, 39, 0.4, 4500, 1}},
    Row{Preset::lower_compression_and_stretch,
        {400, 1.4e5, 0.2, 0, 10, 0.019, 0.005, 39, 0.4, 4500, 1}},
    Row{Preset::powder, {150, 4e4, 0.2, 0.02, 7, 0.015, 0.002, 39, 0.2, 500, 1}},
    Row{Preset::wet, {500, 1e5, 0.2, 0, 5, 0.04, 0.015, 45, 0.8, 4000, 1}},
    Row{Preset::packed, {500, 4e5, 0.2, 0, 10, 0.025, 0.0075, 39, 0.5, 8000, 1}},
    Row{Preset::icy, {700, 1.4e6, 0.3, 0, 20, 0.02, 0.004, 39, 0.3, 30000, 3}},
    Row{Preset::quick, {400, 5e4, 0.2, 0, 10, 0.025, 0.0075, 39, 0.4, 4500, 1}},
};

const sim::laws::Parameter* parameter(std::span<const sim::laws::Parameter> all,
                                      std::string_view key) {
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const auto& p) { return key == p.key; });
  return found == all.end() ? nullptr : &*found;
}

double& number_of(sim::Material& m, std::size_t k) {
  if (k >= of_any_law) return parameter(sim::laws::all_parameters(), keys[k])->of(m);
  return k == 0 ? m.density : k == 1 ? m.youngs_modulus : k == 2 ? m.poisson_ratio : m.dust;
}

bool is_read(const sim::Material& material, std::size_t k) {
  return k < of_any_law || parameter(sim::laws::of(material).parameters, keys[k]);
}

/// True if the material has all numbers of the row that its law reads.
bool has_numbers_of(const Row& row, sim::Material material) {
  for (std::size_t k = 0; k < std::size(keys); ++k)
    if (is_read(material, k) && number_of(material, k) != row.numbers[k]) return false;
  return true;
}

std::size_t count_equal(const Row& row, sim::Material material) {
  std::size_t count = 0;
  for (std::size_t k = 0; k < std::size(keys); ++k)
    count += number_of(material, k) == row.numbers[k];
  return count;
}

}  // namespace

void use_preset(sim::Material& material, Preset preset) {
  for (const Row& row : rows)
    if (row.preset == preset)
      for (std::size_t k = 0; k < std::size(keys); ++k) number_of(material, k) = row.numbers[k];
}

sim::Material snow_of(Preset preset) {
  sim::Material material;
  use_preset(material, preset);
  return material;
}

std::optional<Preset> preset_of(const sim::Material& material) {
  for (const Row& row : rows)
    if (has_numbers_of(row, material)) return row.preset;
  return std::nullopt;
}

bool is_number_of_its_preset(const sim::Material& material, std::string_view key) {
  sim::Material usual = snow_of(Preset::paper);
  usual.model = material.model;
  const Row* nearest = nullptr;
  for (const Row& row : rows)
    if (!has_numbers_of(row, usual) &&
        (!nearest || count_equal(row, material) > count_equal(*nearest, material)))
      nearest = &row;
  sim::Material copy = material;
  for (std::size_t k = 0; nearest && k < std::size(keys); ++k)
    if (keys[k] == key) return number_of(copy, k) == nearest->numbers[k];
  return false;
}

bool is_preset_address(std::string_view address) {
  const auto first = address.find('.');
  const auto last = address.rfind('.');
  return address.starts_with("material.") && last != first && address.substr(last) == ".preset" &&
         address.find('.', first + 1) == last;
}

std::vector<std::string> addresses_set_by(const std::string& preset_address) {
  const std::string table = preset_address.substr(0, preset_address.rfind('.') + 1);
  std::vector<std::string> addresses;
  for (const char* key : keys) addresses.push_back(table + key);
  return addresses;
}

}  // namespace neve::app::scene

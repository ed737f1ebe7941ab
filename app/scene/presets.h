#pragma once
/// Kinds of snow by name: [material.snow] preset = "powder".
///
/// A preset is a way to write numbers, not a parameter of its own: what a scene keeps, and what is
/// written with pictures, are the numbers alone.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "sim/types/material.h"

namespace neve::app::scene {

/// The first six are the paper's variations; `paper` is its reference snow, and the default.
/// `quick` is that of cam clay with the fewest steps.
enum class Preset {
  paper,
  lower_hardening,
  lower_youngs_modulus,
  lower_critical_compression,
  lower_critical_stretch,
  lower_compression_and_stretch,
  powder,
  wet,
  packed,
  icy,
  quick
};

/// The snow of a preset; its name and model say nothing.
sim::Material snow_of(Preset preset);

/// Sets every number of the snow, and neither name nor model.
void use_preset(sim::Material& material, Preset preset);

/// The preset whose numbers these are, all that the law of the material reads.
std::optional<Preset> preset_of(const sim::Material& material);

/// True if the preset that the material has most numbers of sets this one as it is, so that nobody
/// typed it. Presets that the law of the material does not tell from the default are none.
bool is_number_of_its_preset(const sim::Material& material, std::string_view key);

/// True for the address of a material's preset: "material.snow.preset".
bool is_preset_address(std::string_view address);

/// The addresses of the numbers that the preset at an address sets: "material.snow.density" and so
/// on for "material.snow.preset".
std::vector<std::string> addresses_set_by(const std::string& preset_address);

}  // namespace neve::app::scene

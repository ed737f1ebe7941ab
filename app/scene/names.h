#pragma once
/// Names of the values of each choice in scenes.

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "app/scene/presets.h"
#include "app/scene/scene.h"
#include "sim/laws/list.h"

namespace neve::app::scene {

template <class E>
struct Name {
  E value;
  const char* text;
};
template <class E>
Name(E, const char*) -> Name<E>;

constexpr auto names(sim::Kernel) {
  using enum sim::Kernel;
  return std::array{Name{cubic, "cubic"}, Name{quadratic, "quadratic"}};
}
constexpr auto names(sim::Transfer) {
  using enum sim::Transfer;
  return std::array{Name{flip, "flip"}, Name{apic, "apic"}, Name{mls, "mls"}, Name{aflip, "aflip"},
                    Name{asflip, "asflip"}};
}
constexpr auto names(sim::Advect) {
  using enum sim::Advect;
  return std::array{Name{particle, "particle"}, Name{pic, "pic"}};
}
constexpr auto names(sim::ContactAt) {
  using enum sim::ContactAt;
  return std::array{Name{particles, "particles"}, Name{nodes, "nodes"}};
}
constexpr auto names(sim::shapes::HeldAxis) {
  using enum sim::shapes::HeldAxis;
  return std::array{Name{x, "x"},           Name{y, "y"},           Name{z, "z"},
                    Name{turn_x, "turn_x"}, Name{turn_y, "turn_y"}, Name{turn_z, "turn_z"}};
}
constexpr auto names(sim::shapes::Joint) {
  using enum sim::shapes::Joint;
  return std::array{Name{none, "none"}, Name{ball, "ball"}, Name{hinge, "hinge"},
                    Name{slider, "slider"}};
}
constexpr auto names(sim::TimeStep) {
  using enum sim::TimeStep;
  return std::array{Name{adaptive, "adaptive"}, Name{fixed, "fixed"}};
}
constexpr auto names(sim::Stage) {
  std::array<Name<sim::Stage>, sim::stage_names.size()> all{};
  for (std::size_t k = 0; k < all.size(); ++k)
    all[k] = {static_cast<sim::Stage>(k), sim::stage_names[k]};
  return all;
}
constexpr auto names(sim::OnDivergence) {
  using enum sim::OnDivergence;
  return std::array{Name{stop, "stop"}, Name{retry, "retry"}, Name{ignore, "ignore"}};
}
constexpr auto names(sim::Precision) {
  using enum sim::Precision;
  return std::array{Name{single, "float"}, Name{real64, "double"}};
}
constexpr auto names(sim::Model) {
#define NEVE_NAME_OF_LAW(name) Name{sim::laws::model::name, #name},
  return std::array<Name<sim::Model>, sim::laws::law_count>{NEVE_LAWS(NEVE_NAME_OF_LAW)};
#undef NEVE_NAME_OF_LAW
}
constexpr auto names(Preset) {
  using enum Preset;
  return std::array{Name{paper, "paper"},
                    Name{lower_hardening, "lower_hardening"},
                    Name{lower_youngs_modulus, "lower_youngs_modulus"},
                    Name{lower_critical_compression, "lower_critical_compression"},
                    Name{lower_critical_stretch, "lower_critical_stretch"},
                    Name{lower_compression_and_stretch, "lower_compression_and_stretch"},
                    Name{powder, "powder"},
                    Name{wet, "wet"},
                    Name{packed, "packed"},
                    Name{icy, "icy"},
                    Name{quick, "quick"}};
}
constexpr auto names(sim::seeding::Sampling) {
  using enum sim::seeding::Sampling;
  return std::array{Name{jittered, "jittered"}, Name{poisson, "poisson"}, Name{lattice, "lattice"}};
}
constexpr auto names(sim::seeding::Volumes) {
  using enum sim::seeding::Volumes;
  return std::array{Name{estimated, "estimated"}, Name{given, "given"}};
}
constexpr auto names(sim::shapes::Fill) {
  using enum sim::shapes::Fill;
  return std::array{Name{automatic, "auto"}, Name{closed, "closed"}, Name{even_odd, "even_odd"},
                    Name{winding, "winding"}};
}
constexpr auto names(sim::shapes::Coordinates) {
  using enum sim::shapes::Coordinates;
  return std::array{Name{own, "own"}, Name{world, "world"}};
}
constexpr auto names(sim::shapes::Contact) {
  using enum sim::shapes::Contact;
  return std::array{Name{separate, "separate"}, Name{slip, "slip"}, Name{sticky, "sticky"}};
}
constexpr auto names(RangeFrom) {
  using enum RangeFrom;
  return std::array{Name{scene, "scene"}, Name{frame, "frame"}};
}
constexpr auto names(Interpolation) {
  using enum Interpolation;
  return std::array{Name{smooth, "smooth"}, Name{linear, "linear"}, Name{step, "step"}};
}
constexpr auto names(Background) {
  using enum Background;
  return std::array{Name{gradient, "gradient"}, Name{transparent, "transparent"}};
}
constexpr auto names(ColliderStyle) {
  using enum ColliderStyle;
  return std::array{Name{solid, "solid"}, Name{wire, "wire"}, Name{ghost, "ghost"},
                    Name{holdout, "holdout"}};
}
constexpr auto names(ColorBy) {
  using enum ColorBy;
  return std::array{Name{snow, "snow"},
                    Name{speed, "speed"},
                    Name{density, "density"},
                    Name{J_E, "J_E"},
                    Name{J_P, "J_P"},
                    Name{pressure, "pressure"},
                    Name{von_mises, "von_mises"},
                    Name{p0, "p0"},
                    Name{yield, "yield"},
                    Name{id, "id"}};
}
constexpr auto names(ScalarField) {
  using enum ScalarField;
  return std::array{Name{mass, "mass"},
                    Name{speed, "speed"},
                    Name{density, "density"},
                    Name{J_E, "J_E"},
                    Name{J_P, "J_P"},
                    Name{pressure, "pressure"},
                    Name{von_mises, "von_mises"},
                    Name{p0, "p0"},
                    Name{yield, "yield"}};
}
constexpr auto names(VectorField) {
  using enum VectorField;
  return std::array{Name{velocity, "velocity"}, Name{momentum, "momentum"}, Name{force, "force"},
                    Name{v_free, "v_free"},     Name{v_star, "v_star"},     Name{v_new, "v_new"}};
}
constexpr auto names(render::ColorMap) {
  using enum render::ColorMap;
  return std::array{Name{viridis, "viridis"}, Name{magma, "magma"}, Name{turbo, "turbo"},
                    Name{coolwarm, "coolwarm"}};
}
constexpr auto names(Layer) {
  using enum Layer;
  return std::array{
      Name{ground, "ground"},   Name{colliders, "colliders"}, Name{particles, "particles"},
      Name{snow, "snow"},       Name{arrows, "arrows"},       Name{heatmap, "heatmap"},
      Name{smoke, "smoke"},     Name{blocks, "blocks"},       Name{bounds, "bounds"},
      Name{legend, "legend"},   Name{caption, "caption"},     Name{plots, "plots"},
      Name{counter, "counter"}, Name{slate, "slate"},         Name{streamlines, "streamlines"},
      Name{scale, "scale"},     Name{dust, "dust"},           Name{extremes, "extremes"}};
}
constexpr auto names(ExportFormat) {
  using enum ExportFormat;
  return std::array{Name{ply, "ply"}, Name{vtp, "vtp"},   Name{vti, "vti"},
                    Name{vdb, "vdb"}, Name{bgeo, "bgeo"}, Name{usda, "usda"},
                    Name{npz, "npz"}, Name{csv, "csv"},   Name{obj, "obj"}};
}
constexpr auto names(ExportAttribute) {
  using enum ExportAttribute;
  return std::array{Name{id, "id"},
                    Name{x, "x"},
                    Name{v, "v"},
                    Name{m, "m"},
                    Name{V0, "V0"},
                    Name{density, "density"},
                    Name{J_E, "J_E"},
                    Name{J_P, "J_P"},
                    Name{F_E, "F_E"},
                    Name{stress, "stress"},
                    Name{kirchhoff, "kirchhoff"},
                    Name{C, "C"},
                    Name{material, "material"},
                    Name{body, "body"},
                    Name{radius, "radius"},
                    Name{age, "age"}};
}
constexpr auto names(UpAxis) {
  using enum UpAxis;
  return std::array{Name{y, "y"}, Name{z, "z"}};
}

template <class E>
concept Choice = requires(E e) {
  names(e);
};

template <Choice E>
constexpr const char* name(E value) {
  for (const auto& name : names(E{})) {
    if (name.value == value) return name.text;
  }
  return "";
}

template <Choice E>
std::vector<std::string> choices() {
  std::vector<std::string> texts;
  for (const auto& name : names(E{})) texts.emplace_back(name.text);
  return texts;
}

template <Choice E>
constexpr std::optional<E> value_named(std::string_view text) {
  for (const auto& name : names(E{})) {
    if (name.text == text) return name.value;
  }
  return std::nullopt;
}

}  // namespace neve::app::scene

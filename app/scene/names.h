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

/// The names of all values of a choice, in the order of its declaration.
/// @tparam last  of the values
template <auto last, class... Text>
constexpr auto in_order(Text... texts) {
  using E = decltype(last);
  static_assert(sizeof...(texts) == static_cast<std::size_t>(last) + 1);
  std::array<Name<E>, sizeof...(texts)> names{};
  std::size_t k = 0;
  ((names[k] = {static_cast<E>(k), texts}, ++k), ...);
  return names;
}

constexpr auto names(sim::Kernel) {
  return in_order<sim::Kernel::quadratic>("cubic", "quadratic");
}
constexpr auto names(sim::Transfer) {
  return in_order<sim::Transfer::asflip>("flip", "apic", "mls", "aflip", "asflip");
}
constexpr auto names(sim::Advect) {
  return in_order<sim::Advect::pic>("particle", "pic");
}
constexpr auto names(sim::ContactAt) {
  return in_order<sim::ContactAt::nodes>("particles", "nodes");
}
constexpr auto names(sim::shapes::HeldAxis) {
  return in_order<sim::shapes::HeldAxis::turn_z>("x", "y", "z", "turn_x", "turn_y", "turn_z");
}
constexpr auto names(sim::shapes::Joint) {
  return in_order<sim::shapes::Joint::slider>("none", "ball", "hinge", "slider");
}
constexpr auto names(sim::TimeStep) {
  return in_order<sim::TimeStep::fixed>("adaptive", "fixed");
}
constexpr auto names(sim::Stage) {
  std::array<Name<sim::Stage>, sim::stage_names.size()> all{};
  for (std::size_t k = 0; k < all.size(); ++k)
    all[k] = {static_cast<sim::Stage>(k), sim::stage_names[k]};
  return all;
}
constexpr auto names(sim::OnDivergence) {
  return in_order<sim::OnDivergence::ignore>("stop", "retry", "ignore");
}
constexpr auto names(sim::Precision) {
  return in_order<sim::Precision::real64>("float", "double");
}
constexpr auto names(sim::Model) {
#define NEVE_NAME_OF_LAW(name) Name{sim::laws::model::name, #name},
  return std::array<Name<sim::Model>, sim::laws::law_count>{NEVE_LAWS(NEVE_NAME_OF_LAW)};
#undef NEVE_NAME_OF_LAW
}
constexpr auto names(Preset) {
  return in_order<Preset::quick>("paper", "lower_hardening", "lower_youngs_modulus",
                                 "lower_critical_compression", "lower_critical_stretch",
                                 "lower_compression_and_stretch", "powder", "wet", "packed", "icy",
                                 "quick");
}
constexpr auto names(sim::seeding::Sampling) {
  return in_order<sim::seeding::Sampling::lattice>("jittered", "poisson", "lattice");
}
constexpr auto names(sim::seeding::Volumes) {
  return in_order<sim::seeding::Volumes::given>("estimated", "given");
}
constexpr auto names(sim::shapes::Fill) {
  return in_order<sim::shapes::Fill::winding>("auto", "closed", "even_odd", "winding");
}
constexpr auto names(sim::shapes::Coordinates) {
  return in_order<sim::shapes::Coordinates::world>("own", "world");
}
constexpr auto names(sim::shapes::Contact) {
  return in_order<sim::shapes::Contact::sticky>("separate", "slip", "sticky");
}
constexpr auto names(FoundCamera) {
  return in_order<FoundCamera::camera>("nothing", "place", "camera");
}
constexpr auto names(RangeFrom) {
  return in_order<RangeFrom::frame>("scene", "frame");
}
constexpr auto names(Interpolation) {
  return in_order<Interpolation::step>("smooth", "linear", "step");
}
constexpr auto names(Background) {
  return in_order<Background::transparent>("gradient", "transparent");
}
constexpr auto names(ColliderStyle) {
  return in_order<ColliderStyle::holdout>("solid", "wire", "ghost", "holdout");
}
constexpr auto names(ColorBy) {
  return in_order<ColorBy::id>("snow", "speed", "density", "J_E", "J_P", "pressure", "von_mises",
                               "p0", "yield", "id");
}
constexpr auto names(ScalarField) {
  return in_order<ScalarField::yield>("mass", "speed", "density", "J_E", "J_P", "pressure",
                                      "von_mises", "p0", "yield");
}
constexpr auto names(VectorField) {
  return in_order<VectorField::v_new>("velocity", "momentum", "force", "v_free", "v_star", "v_new");
}
constexpr auto names(render::ColorMap) {
  return in_order<render::ColorMap::coolwarm>("viridis", "magma", "turbo", "coolwarm");
}
constexpr auto names(Layer) {
  return in_order<Layer::extremes>("ground", "colliders", "particles", "snow", "arrows", "heatmap",
                                   "smoke", "blocks", "bounds", "legend", "caption", "plots",
                                   "counter", "slate", "streamlines", "scale", "dust", "extremes");
}
constexpr auto names(ExportFormat) {
  return in_order<ExportFormat::obj>("ply", "vtp", "vti", "vdb", "bgeo", "usda", "npz", "csv",
                                     "obj");
}
constexpr auto names(ExportAttribute) {
  return in_order<ExportAttribute::age>("id", "x", "v", "m", "V0", "density", "J_E", "J_P", "F_E",
                                        "stress", "kirchhoff", "C", "stiffness", "threshold",
                                        "material", "body", "radius", "age");
}
constexpr auto names(UpAxis) {
  return in_order<UpAxis::z>("y", "z");
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

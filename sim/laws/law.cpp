#include "sim/laws/law.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string>
#include <string_view>
#include <utility>

#include "sim/laws/files.h"

namespace neve::sim::laws {

namespace {

constexpr Law named(Model model, const char* name, Law law) {
  law.model = model;
  law.name = name;
  return law;
}

#define NEVE_NAMED_LAW(name) named(model::name, #name, name::law),
constexpr Law laws[] = {NEVE_LAWS(NEVE_NAMED_LAW)};
#undef NEVE_NAMED_LAW
static_assert(std::size(laws) == law_count);

/// True if no two parameters of different keys are in one place.
constexpr bool own_numbers_are_apart() {
  for (const Law& a : laws)
    for (const Parameter& p : a.parameters) {
      if (!p.member && (p.own < 0 || p.own >= own_numbers)) return false;
      for (const Law& b : laws)
        for (const Parameter& q : b.parameters)
          if (!p.member && p.own == q.own && std::string_view(p.key) != q.key) return false;
    }
  return true;
}
static_assert(own_numbers_are_apart(), "two laws use the same place of Material::own");

std::vector<Parameter> parameters_of_laws() {
  std::vector<Parameter> found;
  for (const Law& law : laws)
    for (const Parameter& p : law.parameters) {
      const auto is_same = [&](const Parameter& q) { return std::string_view(q.key) == p.key; };
      if (std::none_of(found.begin(), found.end(), is_same)) found.push_back(p);
    }
  return found;
}

/// Laws of one kind together, so that the sentence is short.
std::string text_of_model() {
  std::vector<std::pair<std::string, std::string>> kinds;  // names, kind
  for (const Law& law : laws) {
    const auto same = std::find_if(kinds.begin(), kinds.end(),
                                   [&](const auto& kind) { return kind.second == law.kind; });
    if (same == kinds.end())
      kinds.emplace_back(law.name, law.kind);
    else
      same->first += std::string(", ") + law.name;
  }
  std::string text;
  for (const auto& [names, kind] : kinds)
    text += (text.empty() ? "Law: " : "; ") + names + " (" + kind + ")";
  return text + ".";
}

}  // namespace

bool Law::reads(double Material::*member) const {
  return std::any_of(parameters.begin(), parameters.end(),
                     [&](const Parameter& p) { return p.member && p.member == member; });
}

std::span<const Law> every() {
  return laws;
}

const Law& of(Model model) {
  return laws[static_cast<std::size_t>(model)];
}

void include_hardening(const Material& material, StateLimits& limits, double stiffest) {
  if (!of(material).hardens) return;
  limits.max_xi = std::max(limits.max_xi, material.hardening);
  limits.max_hardened_speed =
      std::max(limits.max_hardened_speed,
               sound_speed(material) * std::sqrt(stiffest * material.max_hardening));
}

std::span<const Parameter> all_parameters() {
  static const std::vector<Parameter> all = parameters_of_laws();
  return all;
}

const char* help_of_model() {
  static const std::string text = text_of_model();
  return text.c_str();
}

}  // namespace neve::sim::laws

std::array<double, neve::sim::own_numbers> neve::sim::own_numbers_of_laws() {
  std::array<double, own_numbers> own{};
  for (const laws::Law& law : laws::every())
    for (const laws::Parameter& p : law.parameters)
      if (!p.member) own[static_cast<std::size_t>(p.own)] = p.own_default;
  return own;
}

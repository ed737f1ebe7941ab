#include "app/forecast/fast.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <future>

#include "app/forecast/forecast.h"
#include "app/scene/coarsen.h"
#include "app/scene/override.h"
#include "app/scene/toml/value.h"
#include "app/setup/coarse_run.h"
#include "app/setup/curves.h"
#include "app/support/text.h"
#include "sim/laws/law.h"

namespace neve::app::forecast {

namespace {

/// Studied in docs/time_step.md. FLIP, AFLIP and ASFLIP damp by the second and not by the step, so
/// they drift less with longer steps than APIC and MLS. FLIP with cubic weights is stable in longer
/// ones still: an elastic body with one particle to a cell too, up to a Poisson ratio of 0.3.
constexpr double flip_snow_cfl = 1.2, flip_cfl = 0.85, smoothed_cfl = 0.7;
constexpr double longest_steps_poisson_ratio = 0.3;
constexpr double hardening_ceiling = 20;
/// Semi-implicit steps damp waves and with them fracture, so they must gain much. The longest steps
/// change more than 0.85 does, too, and take a seventh less work at impacts: less gain suffices.
constexpr double fast_beta = 0.5, fast_max_dt = 1e-3, worth_another_step = 0.5,
                 worth_after_longest_steps = 0.57;
/// Relative change above which a copy presses on colliders or packs and tears its snow differently.
constexpr double alike = 0.1;
/// A few hundred particles, so that the forecasts take tenths of a second and not longer than a
/// small scene itself.
constexpr ForecastBudget forecast_budget{1e9, 3e6, 400};

/// Results of the coarse copy of a scene.
struct Copied {
  double work = 0;   ///< in explicit steps of packed snow
  double force = 0;  ///< N, the peak on a collider
  double J_P = 1;    ///< mean

  /// Relative; without a collider there is no force that could change.
  double force_against(const Copied& other) const {
    return other.force > 0 ? force / other.force - 1 : 0;
  }
  bool is_like(const Copied& other) const {
    return std::abs(force_against(other)) <= alike && std::abs(J_P / other.J_P - 1) <= alike;
  }
};

/// None if the copy diverges: a broken state foretells nothing.
/// @param max_work  ends the copy, in explicit steps of packed snow
std::optional<Copied> copy_of(const scene::Scene& scene, int last,
                              double max_work = forecast_budget.work) {
  ForecastBudget budget = forecast_budget;
  budget.work = max_work;
  Forecast forecast = foresee(scene, setup::planned_particles(scene), last, budget);
  if (!forecast.divergence.empty() || forecast.frames.empty()) return std::nullopt;
  forecast.count_in_packed_steps();
  return Copied{forecast.work(0, last).expected, forecast.peak_force, forecast.mean_J_P};
}

/// A scene that becomes a faster one, and its changes.
class Candidate {
 public:
  /// @param coarsening  the N of --coarsen, which has made the scene what it is
  /// @param cfl  of explicit steps
  Candidate(const scene::Scene& scene, const std::vector<std::string>& chosen, double coarsening,
            double cfl)
      : scene_(scene), chosen_(chosen), coarsening_(coarsening), cfl_(cfl) {}

  /// @param grows  with the cells: --coarsen will multiply what is given
  void set(const std::string& address, double& value, double to, bool grows = false) {
    if (value == to || std::find(chosen_.begin(), chosen_.end(), address) != chosen_.end() ||
        setup::curve_of(scene_, address))
      return;
    value = to;
    overrides_.push_back(address + "=" + scene::toml::number_text(grows ? to / coarsening_ : to));
  }

  void limit_hardening() {
    for (sim::Material& m : scene_.materials)
      if (scene::has_snow_of(scene_, m) && m.hardening > 0 && sim::laws::of(m).is_snow &&
          sim::laws::of(m).hardens)
        set("material." + m.name + ".max_hardening", m.max_hardening,
            std::min(m.max_hardening, hardening_ceiling));
  }

  void take_explicit_steps() {
    sim::SolverSettings& s = scene_.solver;
    set("solver.beta", s.beta, 0);
    if (s.time_step == sim::TimeStep::adaptive)
      set("solver.acoustic_cfl", s.acoustic_cfl, std::max(s.acoustic_cfl, cfl_));
  }

  void take_semi_implicit_steps() {
    sim::SolverSettings& s = scene_.solver;
    if (s.beta == 0) {
      set("solver.beta", s.beta, fast_beta);
      set("solver.max_dt", s.max_dt, std::max(s.max_dt, fast_max_dt), true);
    }
  }

  /// Longer steps of the kind that the scene has.
  void take_longer_steps() {
    scene_.solver.is_implicit() ? take_semi_implicit_steps() : take_explicit_steps();
  }

  const scene::Scene& scene() const { return scene_; }
  bool is_implicit() const { return scene_.solver.is_implicit(); }
  const std::vector<std::string>& overrides() const { return overrides_; }

 private:
  scene::Scene scene_;
  const std::vector<std::string>& chosen_;
  double coarsening_, cfl_;
  std::vector<std::string> overrides_;
};

}  // namespace

double fast_cfl(const scene::Scene& scene) {
  const sim::SolverSettings& s = scene.solver;
  if (s.transfer == sim::Transfer::apic || s.transfer == sim::Transfer::mls) return smoothed_cfl;
  if (s.transfer != sim::Transfer::flip) return flip_cfl;
  const bool is_snow =
      std::all_of(scene.materials.begin(), scene.materials.end(), [](const sim::Material& m) {
        return m.model == sim::Model{} && m.poisson_ratio <= longest_steps_poisson_ratio;
      });
  return is_snow && s.kernel == sim::Kernel::cubic ? flip_snow_cfl : flip_cfl;
}

FastLook fast_look(const scene::Scene& scene, int last, const std::vector<std::string>& chosen,
                   double coarsening, double longest_cfl) {
  const double cfl = std::min(fast_cfl(scene), longest_cfl);
  using Copy = std::optional<Copied>;
  const auto start_copy = [&](const Candidate& candidate) {
    return std::async(std::launch::async, [&] { return copy_of(candidate.scene(), last); });
  };
  Candidate same(scene, chosen, coarsening, cfl);
  same.take_longer_steps();
  Candidate capped = same;
  capped.limit_hardening();
  const bool has_cap = capped.overrides().size() > same.overrides().size();
  const Candidate unchanged(scene, chosen, coarsening, cfl);
  std::future<Copy> before_run = start_copy(unchanged), same_run = start_copy(same), capped_run;
  if (has_cap) capped_run = start_copy(capped);
  const Copy before = before_run.get();
  FastLook look;
  look.is_implicit = scene.solver.is_implicit();
  if (before) look.work = look.work_before = before->work;
  const auto take = [&](const Candidate& candidate, const Copied& copy) {
    look.overrides = candidate.overrides();
    look.work = copy.work;
    look.is_implicit = candidate.is_implicit();
    if (before) look.force_change = copy.force_against(*before);
  };
  const auto is_less = [&](const Copy& copy) {
    return copy && (!look.work || copy->work <= *look.work);
  };
  if (const Copy copy = same_run.get(); !same.overrides().empty() && is_less(copy))
    take(same, *copy);
  bool takes_cap = false;
  if (const Copy copy = has_cap ? capped_run.get() : Copy(); copy) {
    takes_cap = !before || copy->is_like(*before);
    if (!takes_cap) look.force_under_cap = copy->force_against(*before);
    if (takes_cap && is_less(copy)) take(capped, *copy);
  }
  if (scene.solver.time_step != sim::TimeStep::adaptive && !scene.solver.is_implicit()) return look;
  Candidate other(scene, chosen, coarsening, cfl);
  scene.solver.is_implicit() ? other.take_explicit_steps() : other.take_semi_implicit_steps();
  if (takes_cap) other.limit_hardening();
  if (other.is_implicit() == scene.solver.is_implicit() || !look.work) return look;
  const bool has_longest_steps = !scene.solver.is_implicit() && cfl == flip_snow_cfl;
  const double worth = has_longest_steps ? worth_after_longest_steps : worth_another_step;
  const Copy copy = copy_of(other.scene(), last, worth * *look.work);
  if (!copy || copy->work >= worth * *look.work) return look;
  // Semi-implicit steps damp: snow that breaks in explicit ones may hold together in them.
  if (!other.is_implicit() || !before || copy->is_like(*before)) take(other, *copy);
  return look;
}

bool is_same_snow(const scene::Scene& before, const scene::Scene& after, int last) {
  const std::optional<Copied> was = copy_of(before, last);
  if (!was) return true;
  const std::optional<Copied> is = copy_of(after, last);
  return is && is->is_like(*was);
}

std::vector<std::string> longer_steps(const scene::Scene& scene,
                                      const std::vector<std::string>& chosen) {
  Candidate candidate(scene, chosen, 1, fast_cfl(scene));
  candidate.take_longer_steps();
  candidate.limit_hardening();
  return candidate.overrides();
}

std::vector<std::string> FastLook::risks() const {
  std::vector<std::string> addresses = scene::addresses_of(scene::parse_overrides(overrides));
  std::erase_if(addresses, [&](const std::string& address) {
    return !address.ends_with(".max_hardening") && !(is_implicit && address == "solver.beta");
  });
  return addresses;
}

std::string FastLook::sentence() const {
  const std::string stays = kept.empty() ? "" : "; " + kept;
  if (overrides.empty()) return "--fast finds no longer steps for this scene" + stays;
  const std::string changes = "--fast sets " + joined(overrides, ", ");
  if (!work || !work_before) return changes + stays;
  std::string text = fmt::format("{}: about {} % of the work", changes,
                                 rough_text(100 * *work / std::max(*work_before, 1.0)));
  constexpr double notable = 0.05;
  if (std::abs(force_change) > notable)
    text += fmt::format(", and {} % of the peak force in a coarse copy",
                        rough_text(100 * (1 + force_change)));
  text += stays;
  if (!force_under_cap) return text;
  text += fmt::format("; max_hardening stays: a ceiling of {} ", rough_text(hardening_ceiling));
  if (std::abs(*force_under_cap) <= alike) return text + "packs and tears the snow in another way";
  text += fmt::format("leaves {} % of that force", rough_text(100 * (1 + *force_under_cap)));
  return text;
}

}  // namespace neve::app::forecast

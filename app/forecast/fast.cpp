#include "app/forecast/fast.h"

#include <fmt/core.h>

#include <algorithm>
#include <future>

#include "app/forecast/forecast.h"
#include "app/scene/toml/value.h"
#include "app/setup/coarse_run.h"
#include "app/support/text.h"

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
/// A few hundred particles, so that the forecasts take tenths of a second and not longer than a
/// small scene itself.
constexpr ForecastBudget forecast_budget{1e9, 3e6, 400};

double fast_cfl(const scene::Scene& scene) {
  const sim::SolverSettings& s = scene.solver;
  if (s.transfer == sim::Transfer::apic || s.transfer == sim::Transfer::mls) return smoothed_cfl;
  if (s.transfer != sim::Transfer::flip) return flip_cfl;
  const bool is_snow =
      std::all_of(scene.materials.begin(), scene.materials.end(), [](const sim::Material& m) {
        return m.model == sim::Model::snow && m.poisson_ratio <= longest_steps_poisson_ratio;
      });
  return is_snow && s.kernel == sim::Kernel::cubic ? flip_snow_cfl : flip_cfl;
}

/// A scene that becomes a faster one, and its changes.
class Candidate {
 public:
  Candidate(const scene::Scene& scene, const std::vector<std::string>& chosen)
      : scene_(scene), chosen_(chosen) {}

  void set(const std::string& address, double& value, double to) {
    if (value == to || std::find(chosen_.begin(), chosen_.end(), address) != chosen_.end()) return;
    value = to;
    overrides_.push_back(address + "=" + scene::toml::number_text(to));
  }

  void limit_hardening() {
    for (sim::Material& m : scene_.materials)
      if (m.hardening > 0 && m.model == sim::Model::snow)
        set("material." + m.name + ".max_hardening", m.max_hardening,
            std::min(m.max_hardening, hardening_ceiling));
  }

  void take_explicit_steps() {
    sim::SolverSettings& s = scene_.solver;
    set("solver.beta", s.beta, 0);
    if (s.time_step == sim::TimeStep::adaptive)
      set("solver.acoustic_cfl", s.acoustic_cfl, std::max(s.acoustic_cfl, fast_cfl(scene_)));
    limit_hardening();
  }

  void take_semi_implicit_steps() {
    sim::SolverSettings& s = scene_.solver;
    if (s.beta == 0) {
      set("solver.beta", s.beta, fast_beta);
      set("solver.max_dt", s.max_dt, std::max(s.max_dt, fast_max_dt));
    }
    limit_hardening();
  }

  /// None if the copy diverges: a broken state foretells nothing.
  std::optional<double> work(int last) const {
    const Forecast forecast =
        foresee(scene_, setup::planned_particles(scene_), last, forecast_budget);
    if (!forecast.divergence.empty() || forecast.frames.empty()) return std::nullopt;
    return forecast.work(0, last).expected;
  }

  bool is_implicit() const { return scene_.solver.is_implicit(); }
  const std::vector<std::string>& overrides() const { return overrides_; }

 private:
  scene::Scene scene_;
  const std::vector<std::string>& chosen_;
  std::vector<std::string> overrides_;
};

}  // namespace

FastLook fast_look(const scene::Scene& scene, int last, const std::vector<std::string>& chosen) {
  FastLook look;
  look.is_implicit = scene.solver.is_implicit();
  const Candidate before(scene, chosen);
  Candidate same(scene, chosen), other(scene, chosen);
  if (look.is_implicit) {
    same.take_semi_implicit_steps();
    other.take_explicit_steps();
  } else {
    same.take_explicit_steps();
    if (scene.solver.time_step == sim::TimeStep::adaptive) other.take_semi_implicit_steps();
  }
  const bool has_other = other.is_implicit() != scene.solver.is_implicit();
  const auto forecast = [&](const Candidate& candidate) {
    return std::async(std::launch::async, [&] { return candidate.work(last); });
  };
  using Work = std::optional<double>;
  std::future<Work> work_before = forecast(before), same_work = forecast(same), other_work;
  if (has_other) other_work = forecast(other);
  look.work = look.work_before = work_before.get();
  const auto take = [&](const Candidate& candidate, const Work& work) {
    look.overrides = candidate.overrides();
    look.work = work;
    look.is_implicit = candidate.is_implicit();
  };
  if (const Work work = same_work.get();
      !same.overrides().empty() && work && (!look.work || *work <= *look.work))
    take(same, work);
  if (!has_other) return look;
  const bool has_longest_steps = !scene.solver.is_implicit() && fast_cfl(scene) == flip_snow_cfl;
  const double worth = has_longest_steps ? worth_after_longest_steps : worth_another_step;
  if (const Work work = other_work.get(); work && look.work && *work < worth * *look.work)
    take(other, work);
  return look;
}

std::vector<std::string> longer_steps(const scene::Scene& scene,
                                      const std::vector<std::string>& chosen) {
  Candidate candidate(scene, chosen);
  if (scene.solver.is_implicit())
    candidate.take_semi_implicit_steps();
  else
    candidate.take_explicit_steps();
  return candidate.overrides();
}

std::string FastLook::sentence() const {
  if (overrides.empty()) return "--fast finds no longer steps for this scene";
  const std::string changes = "--fast sets " + joined(overrides, ", ");
  if (!work || !work_before) return changes;
  return fmt::format("{}: about {} % of the work", changes,
                     rough_text(100 * *work / std::max(*work_before, 1.0)));
}

}  // namespace neve::app::forecast

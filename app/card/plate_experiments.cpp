/// Press, tear and shear: what is measured between the plates.

#include <algorithm>
#include <cmath>
#include <utility>

#include "app/card/first_yield.h"
#include "app/card/plates.h"
#include "app/support/text.h"
#include "sim/laws/law.h"

namespace neve::app::card {

namespace {

/// Strains of the middle half, and what goes with them.
struct Slope {
  std::vector<double> strain, stress;

  void add(double e, double s) { strain.push_back(e), stress.push_back(s); }
  /// Stress per strain over the strains up to the largest, by least squares through the origin; no
  /// number of snow that was not strained so far, or not watched below.
  double value(double largest) const {
    if (strain.empty() || !(*std::ranges::max_element(strain) >= largest)) return NAN;
    double product = 0, square = 0;
    for (std::size_t k = 0; k < strain.size() && strain[k] <= largest; ++k)
      if (strain[k] > 0.1 * largest) {
        product += strain[k] * stress[k];
        square += strain[k] * strain[k];
      }
    return square > 0 ? product / square : NAN;
  }
};

/// Strains up to which a law that does not yield is as good as linear.
constexpr double linear = 0.006;
/// A law that yields at a smaller strain has no elastic part that could be measured.
constexpr double no_elasticity = 1e-3;
constexpr double yields_below = 0.97;  // of the stress that it would have without

bool is_elastic_at_first(const std::optional<double>& yield) {
  return !yield || *yield > no_elasticity;
}

/// Returns the strain up to which the slope is the modulus. Snow that yields at once has a slope,
/// too, over the strains of all others; no formula has it.
double linear_up_to(const std::optional<double>& yield) {
  return yield && is_elastic_at_first(yield) ? std::min(linear, 0.6 * *yield) : linear;
}

std::string percent_text(double share) {
  return rough_text(100 * share) + " %";
}

/// "modulus 154 kPa (law: 156 kPa)"
std::string modulus_words(const Measure& modulus) {
  return "modulus " + pressure_text(modulus.value) +
         (modulus.formula ? " (law: " + pressure_text(*modulus.formula) + ")" : "");
}

/// y where x first exceeds `at`: x may shake.
double interpolated(const std::vector<double>& x, const std::vector<double>& y, double at) {
  const auto next = std::find_if(x.begin(), x.end(), [&](double v) { return v > at; }) - x.begin();
  if (next == 0 || next == static_cast<std::ptrdiff_t>(x.size())) return NAN;
  const auto k = static_cast<std::size_t>(next);
  return y[k - 1] + (y[k] - y[k - 1]) * (at - x[k - 1]) / (x[k] - x[k - 1]);
}

/// Height of the snow that is strained between the plates, m, as measured: plates that meet
/// particles hold a quarter of a cell each, those that meet nodes leave some of the snow in them
/// free.
double free_height(const sim::SolverSettings& solver) {
  return Plates::height + (solver.is_contact_at_particles() ? -0.55 : 1.74) * Plates::cell;
}

/// The largest strain by which a block is pressed before it is sheared.
constexpr double max_pressed = 0.05;

/// Returns the strain at which the plates bear so much; max_pressed where they bear less there. No
/// formula tells it for snow that yields before: a block is pressed to measure it.
double strain_under(const Subject& subject, double pressure, Experiment& e) {
  const sim::Material& m = subject.material;
  double low = 0, high = max_pressed;
  for (int k = 0; k < 40; ++k) {
    const double middle = 0.5 * (low + high);
    (-elastic_stress(m, stretched(-middle))(1, 1) < pressure ? low : high) = middle;
  }
  if (!first_yield(
          m, [](double strain) { return stretched(-strain); }, high))
    return high;
  const double way = max_pressed * free_height(subject.solver);
  Plates plates(subject, {{slow_seconds(m), {0, -way, 0}}}, e);
  std::vector<double> stress, strain;
  PlateSample sample;
  while (plates.next(sample) && (stress.empty() || stress.back() <= pressure)) {
    stress.push_back(-sample.stress.y());
    strain.push_back(-sample.moved.y() / free_height(subject.solver));
  }
  const double found = interpolated(stress, strain, pressure);
  return std::isfinite(found) ? found : max_pressed;
}

}  // namespace

Experiment press(const Subject& subject) {
  constexpr double deepest = 0.3;
  const sim::Material& m = subject.material;
  Experiment e;
  e.kind = Kind::press;
  Plates plates(subject, {{slow_seconds(m), {0, -deepest * Plates::height, 0}}}, e);
  const std::optional<double> yield = first_yield(
      m, [](double strain) { return stretched(-strain); }, deepest);
  Slope slope;
  double yields_at = 0;
  PlateSample sample;
  while (plates.next(sample)) {
    const double strain = -sample.strain.y(), stress = -sample.stress.y();
    // The snow is strained more than the plates move: each holds a layer of particles before it, so
    // what lies between them is half a cell shorter, and bears a fifth more at a strain of 20 %.
    e.x.push_back(strain);
    e.y.push_back(stress);
    slope.add(strain, stress);
    const double elastic = -elastic_stress(m, stretched(-strain))(1, 1);
    if (yields_at == 0 && yield && strain > 0.3 * *yield && stress < yields_below * elastic)
      yields_at = strain;
    if (stress > 0.5 * m.youngs_modulus) break;  // stone
  }
  plates.show();
  const sim::Lame lame = sim::lame(m.youngs_modulus, m.poisson_ratio);
  e.measures.push_back(
      {"modulus", slope.value(linear_up_to(yield)),
       is_elastic_at_first(yield) ? std::optional(lame.lambda + 2 * lame.mu) : std::nullopt});
  if (yield && is_elastic_at_first(yield) && yields_at > 0)
    e.measures.push_back({"yield_strain", yields_at, yield});
  for (const auto& [name, at] :
       {std::pair{"stress_at_10_percent", 0.1}, {"stress_at_20_percent", 0.2}})
    if (const double stress = interpolated(e.x, e.y, at); std::isfinite(stress))
      e.measures.push_back({name, stress});
  if (const auto stress = e.value("stress_at_20_percent"))
    e.words.push_back("bears " + pressure_text(*stress) + " at 20 %");
  else if (!e.y.empty())
    e.words.push_back("bears " + pressure_text(e.y.back()) + " at " + percent_text(e.x.back()));
  if (std::isfinite(e.measures.front().value)) e.words.push_back(modulus_words(e.measures.front()));
  if (e.value("yield_strain")) e.words.push_back("yields at " + percent_text(yields_at));
  if (plates.has_diverged()) withdraw(e);
  return e;
}

Experiment tear(const Subject& subject) {
  constexpr double longest = 0.08;
  const sim::Material& m = subject.material;
  Experiment e;
  e.kind = Kind::tear;
  Plates plates(subject, {{slow_seconds(m), {0, longest * Plates::height, 0}}}, e);
  const std::optional<double> yield = first_yield(m, stretched, longest);
  double strength = 0, strain_there = 0, work = 0, last = 0;
  PlateSample sample;
  while (plates.next(sample)) {
    const double stress = sample.stress.y(), moved = sample.moved.y();
    e.x.push_back(moved / Plates::height);
    e.y.push_back(stress);
    work += stress * (moved - last);
    last = moved;
    if (stress > strength) {
      strength = stress;
      strain_there = sample.strain.y();
    }
  }
  plates.show();
  const auto formula = [&](double value) { return yield ? std::optional(value) : std::nullopt; };
  // Float knows stress to 6e-8 of the modulus. Grains that are pulled apart press a little at
  // first.
  const double nothing = sim::laws::of(m).is_granular ? 1e-5 : 1e-6;
  const bool has_strength = strength > nothing * m.youngs_modulus;
  if (!has_strength) strength = strain_there = work = 0;
  const bool tears = !e.y.empty() && e.y.back() < 0.5 * strength;
  // Snow that does not tear bears more than was pulled: its strength and work are not known.
  const bool has_ended = e.failure.empty(), is_known = tears || (!has_strength && has_ended);
  e.measures = {{"strength", is_known ? strength : NAN,
                 formula(elastic_stress(m, stretched(yield.value_or(0)))(1, 1))},
                {"stretch_at_strength", is_known ? strain_there : NAN, yield},
                {"work", is_known ? work : NAN}};
  if (has_strength)
    e.words.push_back((tears ? "tears at " : "bears at least ") + pressure_text(strength));
  else if (has_ended)
    e.words.push_back("bears no tension");
  if (has_strength && tears) {
    e.words.push_back("stretched by " + percent_text(strain_there));
    e.words.push_back("work " + rough_text(work) + " J/m\u00b2");
  }
  if (plates.has_diverged()) withdraw(e);
  return e;
}

Experiment shear(const Subject& subject) {
  constexpr double furthest = 0.4, normal_stress = 500;
  constexpr int last_samples = Plates::samples / 16;
  const sim::Material& m = subject.material;
  const sim::Lame lame = sim::lame(m.youngs_modulus, m.poisson_ratio);
  const double slow = slow_seconds(m);
  Experiment e;
  e.kind = Kind::shear;
  const double pressed = strain_under(subject, normal_stress, e);
  Plates plates(subject,
                {{0.25 * slow, {0, -pressed * free_height(subject.solver), 0}},
                 {slow, {furthest * Plates::height, 0, 0}}},
                e);
  const auto sheared = [&](double strain) {
    sim::Mat3d F = stretched(-pressed);
    F(0, 1) += strain;
    return F;
  };
  const std::optional<double> yield = first_yield(m, sheared, furthest);
  Slope slope;
  double strength = 0, shear_sum = 0, normal_sum = 0, pressure = 0;
  int at_last = 0;
  PlateSample sample;
  for (int k = 1; plates.next(sample); ++k) {
    // The plate comes to rest at last, and waves run: a mean.
    if (k > Plates::samples - last_samples && k <= Plates::samples)
      pressure -= sample.stress.y() / last_samples;
    if (k <= Plates::samples) continue;
    const double stress = sample.stress.x();
    e.x.push_back(sample.moved.x() / Plates::height);
    e.y.push_back(stress);
    slope.add(sample.strain.x(), stress);
    strength = std::max(strength, stress);
    if (k <= 2 * Plates::samples * 7 / 8) continue;
    shear_sum += stress;
    normal_sum -= sample.stress.y();
    ++at_last;
  }
  plates.show();
  // Snow that never yields bears more the further it is sheared: the stress at the end is no
  // strength, and no friction.
  const bool is_known = yield && e.failure.empty(), is_pressed = !e.x.empty();
  e.measures = {{"strength", is_known ? strength : NAN}, {"pressure", is_pressed ? pressure : NAN}};
  if (is_elastic_at_first(yield))
    e.measures.push_back({"modulus", slope.value(linear_up_to(yield)), lame.mu});
  // Snow that hardly presses any more has no friction: what it bears is cohesion.
  constexpr double hardly = 0.1;
  if (!is_known || (shear_sum > 0 && normal_sum > hardly * pressure * at_last))
    e.measures.push_back({"friction", is_known ? shear_sum / normal_sum : NAN});
  if (is_known || strength > 0)
    e.words.push_back((is_known ? "bears " : "bears at least ") + pressure_text(strength));
  if (is_pressed && pressed >= max_pressed)
    e.words.push_back("under " + pressure_text(pressure) + ", pressed by 5 %");
  if (std::isfinite(e.value("modulus").value_or(NAN)))
    e.words.push_back(modulus_words(e.measures[2]));
  if (const double friction = e.value("friction").value_or(NAN); std::isfinite(friction))
    e.words.push_back("friction " + rough_text(friction) + " at last");
  if (plates.has_diverged()) withdraw(e);
  return e;
}

}  // namespace neve::app::card

#pragma once
/// A screening: the effect of each parameter on each metric (Morris 1991; Campolongo et al. 2007).

#include <cmath>
#include <string>
#include <vector>

#include "app/sweep/store/results.h"

namespace neve::app::sweep::sheet {

/// Elementary effects of an axis on a metric, each the change of the metric for the axis's whole
/// range, by one step between two runs that differ in nothing else. The range of a list of numbers
/// goes from the smaller to the larger of its ends, by equal steps; of choices it is from one to
/// another.
struct Effect {
  int steps = 0;          ///< between runs that both got to their end
  double mean = 0;        ///< mu: with its sign
  double strength = 0;    ///< mu*: the mean of their sizes
  double spread = 0;      ///< sigma: large where it depends on the other axes or is not straight
  bool is_noise = false;  ///< with seeds: no step changes the metric by more than another seed does
  /// True with seeds if nothing tells noise, as no point of its steps has two that ended.
  bool is_unknown = false;

  /// The metric always rises or always falls, more or less.
  bool is_one_way() const { return std::abs(mean) > 0.8 * strength; }
};

/// @return one per axis of the screening; empty if the sweep is none
std::vector<Effect> effects_on(const store::Manifest& manifest,
                               const std::vector<store::RunResult>& results, std::size_t metric);

/// A row per metric and axis. "" if the sweep is no screening.
std::string effects_csv(const store::Manifest& manifest,
                        const std::vector<store::RunResult>& results);

/// A table of bars: a row per axis, the strongest first, a column per metric.
/// "" if the sweep is no screening, or no two runs can be compared.
/// @param is_document with the XML head of a file of its own
std::string effects_svg(const store::Manifest& manifest,
                        const std::vector<store::RunResult>& results, bool is_document);

/// "height (m): friction -0.02, then hardening 0.01" for each metric that anything changes.
std::vector<std::string> effect_lines(const store::Manifest& manifest,
                                      const std::vector<store::RunResult>& results);

}  // namespace neve::app::sweep::sheet

#pragma once
/// Spread of a quantity over all nodes or particles.

#include <optional>
#include <string>
#include <vector>

#include "app/dump/quantities.h"
#include "app/support/json.h"

namespace neve::app::dump {

/// Numbers of magnitudes in bins of equal width, or of equal ratio where they span decades.
struct Histogram {
  std::string name, unit;  ///< |v| of vectors and tensors
  bool is_of_nodes = false;
  bool is_logarithmic = false;
  double low = 0, high = 0;          ///< ends of the first and the last bin; equal: one value
  std::vector<std::size_t> counts;   ///< of the bins; empty: there is no finite value
  double q05 = 0, q50 = 0, q95 = 0;  ///< 5, 50, 95 % of the values are at most this
  std::size_t rows = 0;              ///< in the bins
  std::size_t zeros = 0;             ///< in none, where the bins have equal ratios
  std::size_t not_finite = 0;        ///< in none
  std::size_t outside_expected = 0;  ///< with those that are not finite
  std::optional<scene::Range> expected;

  /// Lower end of a bin; of the one behind the last it is `high`.
  double edge(std::size_t bin) const;
  /// Returns the place of a value between the ends, 0 to 1; beyond them that of the nearer one.
  double share_of(double value) const;
  std::size_t bin_of(double value) const;
  bool is_outside_expected(std::size_t bin) const;  ///< as a whole
};

inline constexpr std::size_t histogram_bins = 24;

/// Light nodes, whose values mean nothing, are left out.
/// @param listing  of the quantity
Histogram histogram_of(const Listing& listing, const Quantity& quantity,
                       std::size_t bins = histogram_bins);

/// Returns the histograms of all quantities but ids and nodes.
std::vector<Histogram> histograms_of(const Listing& listing);

/// "5 % below 0.9, half below 1, 5 % above 1.2; 3 outside 0.6 to 20, no number: 1"
std::string spread_text(const Histogram& histogram);

/// A title, and a bar of '#' for each bin; '!' before those outside the expected range.
std::vector<std::string> histogram_lines(const Histogram& histogram);

/// Writes histograms_of() as JSON: name, unit, ends of bins, counts, quantiles.
Json histograms_json(const Listing& listing);

}  // namespace neve::app::dump

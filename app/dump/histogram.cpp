#include "app/dump/histogram.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "app/support/text.h"

namespace neve::app::dump {

namespace {

/// The ratio of the 95 % and the 5 % quantile from which bins have equal ratios.
constexpr double wide = 100;
/// Smaller ones than this share of the largest are in the first of such bins.
constexpr double min_share = 1e-8;
constexpr std::size_t bar_width = 40;

/// Sorted finite magnitudes.
std::vector<double> magnitudes(const Listing& listing, const Quantity& quantity, Histogram& into) {
  std::vector<double> values;
  for (std::size_t row = 0; row < quantity.rows(); ++row) {
    if (row < listing.is_negligible.size() && listing.is_negligible[row]) continue;
    into.outside_expected += quantity.is_outside_expected(row);
    const double value = quantity.magnitude(row);
    if (std::isfinite(value))
      values.push_back(value);
    else
      ++into.not_finite;
  }
  std::sort(values.begin(), values.end());
  return values;
}

double quantile(const std::vector<double>& sorted, double share) {
  return sorted[static_cast<std::size_t>(share * static_cast<double>(sorted.size() - 1))];
}

}  // namespace

double Histogram::edge(std::size_t bin) const {
  if (bin >= counts.size()) return high;
  const double share = static_cast<double>(bin) / static_cast<double>(counts.size());
  return is_logarithmic ? low * std::pow(high / low, share) : low + share * (high - low);
}

double Histogram::share_of(double value) const {
  if (!(high > low) || !(value > low)) return 0;
  const double share =
      is_logarithmic ? std::log(value / low) / std::log(high / low) : (value - low) / (high - low);
  return std::min(share, 1.0);
}

std::size_t Histogram::bin_of(double value) const {
  if (counts.empty()) return 0;
  const auto bins = static_cast<double>(counts.size());
  return static_cast<std::size_t>(std::min(share_of(value) * bins, bins - 1));
}

bool Histogram::is_outside_expected(std::size_t bin) const {
  return expected && (edge(bin + 1) < expected->min || edge(bin) > expected->max);
}

Histogram histogram_of(const Listing& listing, const Quantity& quantity, std::size_t bins) {
  Histogram h;
  h.name = quantity.components == 1 ? quantity.name : "|" + quantity.name + "|";
  h.unit = quantity.unit;
  h.is_of_nodes = listing.is_of_nodes;
  h.expected = quantity.expected;
  std::vector<double> values = magnitudes(listing, quantity, h);
  if (values.empty()) return h;
  h.q05 = quantile(values, 0.05);
  h.q50 = quantile(values, 0.5);
  h.q95 = quantile(values, 0.95);
  h.low = values.front();
  h.high = values.back();
  const auto first = std::upper_bound(values.begin(), values.end(), 0.0);
  // Zero has no logarithm: it is counted by itself, and does not stretch the bins.
  if (h.low >= 0 && first != values.end()) {
    const std::vector<double> positive(first, values.end());
    h.is_logarithmic = quantile(positive, 0.95) > wide * quantile(positive, 0.05);
    if (h.is_logarithmic) {
      h.zeros = values.size() - positive.size();
      h.low = std::max(positive.front(), min_share * h.high);
      values = positive;
    }
  }
  h.rows = values.size();
  h.counts.resize(h.high > h.low ? bins : 1);
  for (const double value : values) ++h.counts[h.bin_of(value)];
  return h;
}

std::vector<Histogram> histograms_of(const Listing& listing) {
  std::vector<Histogram> list;
  for (const Quantity& quantity : listing.quantities)
    if (!is_index(quantity)) list.push_back(histogram_of(listing, quantity));
  return list;
}

std::string spread_text(const Histogram& h) {
  if (h.counts.empty()) return h.not_finite > 0 ? "no value is finite" : "there is none";
  std::string text = "5 % below " + rough_text(h.q05) + ", half below " + rough_text(h.q50) +
                     ", 5 % above " + rough_text(h.q95);
  if (h.expected && std::isfinite(h.expected->max))
    text += "; " + std::to_string(h.outside_expected) + " outside the expected " +
            rough_text(h.expected->min) + " to " + rough_text(h.expected->max);
  if (h.zeros > 0) text += "; " + std::to_string(h.zeros) + " are 0";
  if (h.not_finite > 0) text += "; " + std::to_string(h.not_finite) + " are not numbers";
  return text;
}

std::vector<std::string> histogram_lines(const Histogram& h) {
  std::vector<std::string> lines{h.name + (h.unit.empty() ? "" : " (" + h.unit + ")") + ": " +
                                 spread_text(h)};
  const std::size_t most = h.counts.empty() ? 0 : *std::ranges::max_element(h.counts);
  for (std::size_t bin = 0; bin < h.counts.size(); ++bin) {
    const std::string ends = h.high > h.low
                                 ? rough_text(h.edge(bin)) + " to " + rough_text(h.edge(bin + 1))
                                 : rough_text(h.low);
    // A bin that is not empty has a bar.
    const std::size_t length = (h.counts[bin] * bar_width + most - 1) / most;
    lines.push_back(fmt::format("{}{:24}{:{}}{}",
                                h.is_outside_expected(bin) && h.counts[bin] > 0 ? "! " : "  ", ends,
                                std::string(length, '#'), bar_width + 2, h.counts[bin]));
  }
  return lines;
}

Json histograms_json(const Listing& listing) {
  Json list = Json::array();
  for (const Histogram& h : histograms_of(listing)) {
    Json edges = Json::array();
    for (std::size_t bin = 0; !h.counts.empty() && bin <= h.counts.size(); ++bin)
      edges.push_back(h.edge(bin));
    Json json = {{"name", h.name},
                 {"unit", h.unit},
                 {"edges", edges},
                 {"counts", h.counts},
                 {"zeros", h.zeros},
                 {"not_finite", h.not_finite},
                 {"is_logarithmic", h.is_logarithmic}};
    if (!h.counts.empty()) json["quantiles"] = {{"5", h.q05}, {"50", h.q50}, {"95", h.q95}};
    list.push_back(json);
  }
  return list;
}

}  // namespace neve::app::dump

#include "app/predict/predict.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "app/record/metrics.h"
#include "app/support/text.h"

namespace neve::app::predict {

namespace {

/// The value expected is that of the fine copy, and half of what it differs from the coarse ones
/// further. Its interval has half of that difference, half of how far seeds lie apart, and a share
/// of the value. docs/prediction/fit.py chose the shares, and counts how many intervals hold.
constexpr double toward = 0.5, per_difference = 0.5, per_noise = 0.5;
constexpr double shares[] = {0.07, 0.09, 0.24, 0.012, 0.14};
static_assert(std::size(shares) == quantity_count);

/// A largest piece between may fall on either side at full resolution. Snow that loosens loses dust
/// that copies are too coarse for: only where it does not, whole copies say that it holds.
constexpr double clearly_broken = 0.985, clearly_whole = 0.996, unpacked = 1.05;

Estimate estimate(Quantity quantity, const std::vector<Copy>& copies) {
  const double fine = copies.front().value(quantity);
  double sum = 0, low = copies[1].value(quantity), high = low;
  for (std::size_t k = 1; k < copies.size(); ++k) {
    const double value = copies[k].value(quantity);
    sum += value;
    low = std::min(low, value);
    high = std::max(high, value);
  }
  const double difference = fine - sum / static_cast<double>(copies.size() - 1);
  Estimate out{quantity};
  out.expected = std::max(0.0, fine + toward * difference);
  const double half = per_difference * std::abs(difference) + per_noise * (high - low) / 2 +
                      share_of(quantity) * out.expected;
  out.low = std::max(0.0, out.expected - half);
  out.high = out.expected + half;
  if (quantity == Quantity::largest_piece) {
    out.expected = std::min(out.expected, 1.0);
    out.high = std::min(out.high, 1.0);
  }
  return out;
}

/// Tells why copies cannot speak; "" if they can.
std::string silence(const std::vector<Copy>& copies) {
  for (const Copy& copy : copies) {
    if (!copy.failure.empty())
      return fmt::format("the copy with --coarsen {} and seed {} has no end: {}",
                         rough_text(copy.coarsening), copy.seed, copy.failure);
    if (!copy.has_broken)
      return "there is no snow at the start or at the end, or a sink takes what the largest piece "
             "lacks";
  }
  return "";
}

std::string count_text(std::size_t count, std::size_t all) {
  return count == all ? fmt::format("all {} copies", all)
                      : fmt::format("{} of {} copies", count, all);
}

void decide(Prediction& prediction) {
  const std::vector<Copy>& copies = prediction.copies;
  const auto count = [&](const auto& is_so) {
    return static_cast<std::size_t>(std::count_if(copies.begin(), copies.end(), is_so));
  };
  const std::size_t all = copies.size(), broken = count([](const Copy&c) { return *c.has_broken; });
  if (broken == all && copies.front().whole < clearly_broken) {
    prediction.verdict = Verdict::breaks;
    prediction.reason = "in " + count_text(all, all);
  } else if (count([](const Copy& c) {
               return c.whole > clearly_whole && c.value(Quantity::mean_J_P) < unpacked;
             }) == all) {
    prediction.verdict = Verdict::holds;
    prediction.reason = "in " + count_text(all, all);
  } else {
    prediction.verdict = Verdict::undecided;
    prediction.reason = broken == 0     ? "all copies hold, but their snow loosens"
                        : broken == all ? "all copies break, the finest of them barely"
                                        : "it breaks in " + count_text(broken, all);
  }
}

/// Writes a value with the digits that the size of the estimate asks for.
std::string number_text(double value, const Estimate& estimate) {
  const double size = std::max(std::abs(estimate.expected), 1e-9);
  const int digits = std::clamp(2 - static_cast<int>(std::floor(std::log10(size))), 0, 4);
  return fixed_text(value, digits);
}

}  // namespace

const char* name(Verdict verdict) {
  constexpr const char* names[] = {"breaks", "holds", "undecided", "cannot say"};
  return names[static_cast<int>(verdict)];
}

bool is_in_doubt(const Prediction& prediction) {
  const Verdict verdict = prediction.verdict;
  return !prediction.reason.empty() && verdict != Verdict::breaks && verdict != Verdict::holds;
}

Prediction silent(std::string reason) {
  Prediction prediction;
  prediction.reason = std::move(reason);
  return prediction;
}

double share_of(Quantity quantity) {
  return shares[static_cast<int>(quantity)];
}

Prediction judge(std::vector<Copy> copies) {
  Prediction prediction = silent(silence(copies));
  prediction.copies = std::move(copies);
  if (!prediction.reason.empty()) return prediction;
  for (int k = 0; k < quantity_count; ++k)
    prediction.estimates.push_back(estimate(static_cast<Quantity>(k), prediction.copies));
  decide(prediction);
  return prediction;
}

Prediction make_prediction(const scene::Scene& scene, int last, double seconds, int threads,
                           Progress& progress) {
  Prediction prediction = silent(why_not(scene));
  if (prediction.reason.empty()) {
    const double share = seconds * share_of_work();
    progress.note(cost_text() + (seconds > 0 ? ", about " + duration_text(share) : ""));
    prediction = judge(run_copies(scene, last, threads, progress));
  }
  prediction.frame = scene::number_of(scene, last);
  return prediction;
}

namespace {

/// "0.408 m (0.353 to 0.463)"
std::string value_text(const Estimate& e) {
  const std::string unit = info_of(e.quantity).unit;
  return fmt::format("{}{} ({} to {})", number_text(e.expected, e), unit.empty() ? "" : " " + unit,
                     number_text(e.low, e), number_text(e.high, e));
}

}  // namespace

std::string text_of(const Estimate& estimate) {
  return info_of(estimate.quantity).title + (" " + value_text(estimate));
}

std::vector<std::string> caption_of(const Prediction& prediction) {
  std::vector<std::string> lines{fmt::format("at full resolution, frame {}: {} ({})",
                                             prediction.frame, name(prediction.verdict),
                                             prediction.reason)};
  for (const Estimate& e : prediction.estimates) lines.push_back("  " + text_of(e));
  return lines;
}

std::string text_of(const Prediction& prediction) {
  std::string text = fmt::format("at full   {}: {}\n", name(prediction.verdict), prediction.reason);
  for (const Estimate& e : prediction.estimates)
    text += fmt::format("           {:14} {}\n", info_of(e.quantity).title, value_text(e));
  return text;
}

Json to_json(const Prediction& prediction) {
  Json json;
  json["frame"] = prediction.frame;
  json["verdict"] = name(prediction.verdict);
  json["reason"] = prediction.reason;
  json["estimates"] = Json::object();
  for (const Estimate& e : prediction.estimates)
    json["estimates"][info_of(e.quantity).name] = {
        {"expected", e.expected}, {"low", e.low}, {"high", e.high}};
  json["copies"] = Json::array();
  for (const Copy& copy : prediction.copies) {
    Json one = {{"coarsen", copy.coarsening}, {"seed", copy.seed}};
    one["failure"] = copy.failure.empty() ? Json() : Json(copy.failure);
    one["broken"] = copy.has_broken ? Json(*copy.has_broken) : Json();
    if (copy.failure.empty())
      for (int k = 0; k < quantity_count; ++k)
        one[info_of(static_cast<Quantity>(k)).name] = copy.values[k];
    json["copies"].push_back(one);
  }
  json["text"] = caption_of(prediction);
  return json;
}

}  // namespace neve::app::predict

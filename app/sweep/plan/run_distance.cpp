#include "app/sweep/plan/run_distance.h"

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <string>

#include "app/support/text.h"

namespace neve::app::sweep::plan {

namespace {

/// A value that a run leaves to the scene comes first, then numbers by their size, then texts.
struct ByValue {
  static int kind(const std::string& value) { return value.empty() ? 0 : number_of(value) ? 1 : 2; }
  bool operator()(const std::string& a, const std::string& b) const {
    if (kind(a) != kind(b)) return kind(a) < kind(b);
    return kind(a) == 1 ? *number_of(a) < *number_of(b) : a < b;
  }
};

}  // namespace

RunPlaces::RunPlaces(const std::vector<PlannedRun>& runs) : places_(runs.size()) {
  std::set<std::string> addresses;
  for (const PlannedRun& item : runs)
    for (const scene::Override& setting : item.run.settings) addresses.insert(setting.address);
  addresses.erase("seed");  // another draw of the same values
  for (const std::string& address : addresses) {
    std::map<std::string, double, ByValue> ranks;
    for (const PlannedRun& item : runs) ranks[item.run.setting(address)] = 0;
    double rank = 0;
    for (auto& [value, place] : ranks)
      place = rank++ / static_cast<double>(std::max<std::size_t>(1, ranks.size() - 1));
    for (std::size_t k = 0; k < runs.size(); ++k)
      places_[k].push_back(ranks.at(runs[k].run.setting(address)));
  }
}

double RunPlaces::distance(std::size_t a, std::size_t b) const {
  double sum = 0;
  for (std::size_t k = 0; k < places_[a].size(); ++k) {
    const double apart = places_[a][k] - places_[b][k];
    sum += apart * apart;
  }
  return sum;
}

std::size_t RunPlaces::nearest(std::size_t run, const std::vector<std::size_t>& others) const {
  return *std::min_element(others.begin(), others.end(), [&](std::size_t a, std::size_t b) {
    return distance(run, a) < distance(run, b);
  });
}

}  // namespace neve::app::sweep::plan

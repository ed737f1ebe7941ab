#include "app/sweep/jobs/start_order.h"

#include <algorithm>
#include <set>
#include <string>

#include "app/sweep/plan/order.h"

namespace neve::app::sweep::jobs {

std::vector<const Run*> start_order(const store::Manifest& manifest,
                                    const std::vector<int>& indices, bool is_side_by_side) {
  std::vector<std::vector<int>> coordinates;
  std::vector<int> sizes, draws;
  std::vector<double> work;
  for (const Run& run : manifest.runs) {
    coordinates.push_back(run.coordinates);
    work.push_back(run.work);
    draws.push_back(run.index % manifest.seeds);
  }
  for (const store::AxisLabels& axis : manifest.axes)
    sizes.push_back(static_cast<int>(axis.values.size()));
  std::vector<std::size_t> order = plan::coarse_first(coordinates, sizes, draws);
  for (const store::Variant& variant : manifest.variants) {
    order.push_back(order.size());
    work.push_back(variant.run.work);
  }
  if (is_side_by_side) order = plan::longest_first(std::move(order), work);
  const std::set<int> wanted(indices.begin(), indices.end());
  std::vector<const Run*> runs;
  std::set<std::string> keys;
  for (const std::size_t k : order) {
    const Run* run = manifest.run_of(static_cast<int>(k));
    if (run && wanted.contains(run->index) && keys.insert(run->key).second) runs.push_back(run);
  }
  return runs;
}

}  // namespace neve::app::sweep::jobs

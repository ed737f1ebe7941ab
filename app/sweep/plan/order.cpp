#include "app/sweep/plan/order.h"

#include <algorithm>
#include <numeric>

namespace neve::app::sweep::plan {

namespace {

/// Rank of a place if the ends come first, then the middles between two earlier places.
int lateness(int index, int count) {
  if (index == 0 || index == count - 1) return 0;
  int low = 0, high = count - 1, level = 1;
  while (high - low > 1) {
    const int middle = (low + high) / 2;
    if (index == middle) break;
    (index < middle ? high : low) = middle;
    ++level;
  }
  return level;
}

}  // namespace

std::vector<std::size_t> coarse_first(const std::vector<std::vector<int>>& coordinates,
                                      const std::vector<int>& sizes,
                                      const std::vector<int>& draws) {
  std::vector<int> late;
  for (std::size_t k = 0; k < coordinates.size(); ++k) {
    const std::vector<int>& at = coordinates[k];
    const bool is_on_axes = !at.empty() && at.size() == sizes.size();
    int latest =
        is_on_axes ? 0 : lateness(static_cast<int>(k), static_cast<int>(coordinates.size()));
    for (std::size_t a = 0; is_on_axes && a < at.size(); ++a)
      latest = std::max(latest, lateness(at[a], sizes[a]));
    late.push_back(latest);
  }
  std::vector<std::size_t> order(coordinates.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return late[a] < late[b]; });
  if (!draws.empty())
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return draws[a] < draws[b]; });
  return order;
}

std::vector<std::size_t> longest_first(std::vector<std::size_t> order,
                                       const std::vector<double>& work) {
  constexpr double alike = 1.25;
  for (auto next = order.begin(); next != order.end();) {
    const double longest = work[*std::max_element(
        next, order.end(), [&](std::size_t a, std::size_t b) { return work[a] < work[b]; })];
    next = std::stable_partition(next, order.end(),
                                 [&](std::size_t k) { return alike * work[k] >= longest; });
  }
  return order;
}

}  // namespace neve::app::sweep::plan

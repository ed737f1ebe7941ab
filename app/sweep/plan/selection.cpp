#include "app/sweep/plan/selection.h"

#include <fmt/core.h>

#include <optional>
#include <set>

#include "app/support/errors.h"
#include "app/support/text.h"

namespace neve::app::sweep::plan {

namespace {

std::optional<int> whole(std::string_view text) {
  const std::optional<int> value = number_of<int>(text);
  return value && *value >= 0 ? value : std::nullopt;
}

}  // namespace

Shard parse_shard(const std::string& text) {
  const auto slash = text.find('/');
  const auto index = whole(text.substr(0, slash));
  const auto count = slash == std::string::npos ? std::nullopt : whole(text.substr(slash + 1));
  if (!index || !count || *index < 1 || *index > *count)
    throw UsageError("--shard", "cannot use \"" + text + "\"",
                     "expected I/N with 1 <= I <= N, as in 2/8");
  return {*index, *count};
}

std::string shard_text(const Shard& shard) {
  return fmt::format("{}/{}", shard.index, shard.count);
}

std::vector<int> parse_selection(const std::string& flag, const std::string& text, int last) {
  std::set<int> numbers;
  std::string_view rest = text;
  while (true) {
    const auto comma = std::min(rest.find(','), rest.size());
    const std::string_view part = rest.substr(0, comma);
    const auto dash = part.find('-');
    const auto first = whole(part.substr(0, dash));
    const auto end = dash == std::string_view::npos ? first : whole(part.substr(dash + 1));
    if (!first || !end || *end < *first)
      throw UsageError(flag, "cannot use \"" + text + "\"",
                       "expected numbers of runs, as in 3,7-12");
    if (*end > last)
      throw UsageError(flag, fmt::format("there is no run {}", *end),
                       fmt::format("expected numbers from 0 to {}", last));
    for (int k = *first; k <= *end; ++k) numbers.insert(k);
    if (comma == rest.size()) break;
    rest.remove_prefix(comma + 1);
  }
  return {numbers.begin(), numbers.end()};
}

std::string selection_text(const std::vector<int>& numbers) {
  std::string text;
  for (std::size_t k = 0; k < numbers.size();) {
    std::size_t end = k;
    while (end + 1 < numbers.size() && numbers[end + 1] == numbers[end] + 1) ++end;
    text += (text.empty() ? "" : ",") + std::to_string(numbers[k]);
    if (end > k) text += "-" + std::to_string(numbers[end]);
    k = end + 1;
  }
  return text;
}

}  // namespace neve::app::sweep::plan

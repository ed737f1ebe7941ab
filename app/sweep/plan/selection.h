#pragma once
/// Selections of the runs of a sweep.

#include <string>
#include <vector>

namespace neve::app::sweep::plan {

/// The i-th of n shares, as "2/8": every n-th run, so that shares cost about the same.
struct Shard {
  int index = 1, count = 1;  ///< from 1
};

/// @throws UsageError
Shard parse_shard(const std::string& text);
std::string shard_text(const Shard& shard);

/// "3,7-12": numbers and ranges, sorted, each once.
/// @param flag  that has the text, for errors  @throws UsageError, also beyond `last`
std::vector<int> parse_selection(const std::string& flag, const std::string& text, int last);

/// The shortest such text: "0-7,9,12-14".
std::string selection_text(const std::vector<int>& numbers);

}  // namespace neve::app::sweep::plan

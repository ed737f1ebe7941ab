#include "app/pick/round_noise.h"

#include <fmt/format.h>

#include "app/support/text.h"
#include "app/sweep/store/points.h"

namespace neve::app::pick {

namespace store = sweep::store;

RoundNoise noise_of_round(const std::filesystem::path& folder) {
  RoundNoise noise;
  const store::Manifest manifest = store::read_manifest(folder);
  if (manifest.seeds == 1) return noise;
  const std::vector<store::Point> points =
      store::points_of(manifest, store::read_results(folder, manifest));
  const std::optional<std::size_t> telling = store::telling_metric(manifest, points);
  const store::MetricInfo& info = store::metric_infos()[telling.value_or(0)];
  const std::vector<store::Summary> summaries = store::summaries_of(points, telling.value_or(0));
  // Runs that fail may leave too few seeds to tell tiles apart.
  const bool is_unknown =
      telling && store::verdict_of(manifest, points, *telling) == store::Verdict::unknown;
  const std::vector<std::vector<int>> groups = store::close_groups(summaries);
  for (std::size_t k = 0; k < points.size(); ++k) {
    std::string text = store::outcome_text(points[k]);
    if (telling && summaries[k].count > 0)
      text += fmt::format("{}{} {}{}{}", text.empty() ? "" : ", ", info.title,
                          rough_text(summaries[k].mean),
                          info.unit[0] ? fmt::format(" {}", info.unit) : "",
                          is_unknown ? "" : " " + store::group_letters(groups[k]));
    noise.tiles.push_back(text);
    const std::string letters = telling && !is_unknown ? store::group_letters(groups[k]) : "";
    noise.letters.push_back(letters.empty() ? "-" : letters);
  }
  noise.key =
      is_unknown ? fmt::format("Tiles have no letters: {}.", store::unknown_words)
      : telling
          ? fmt::format("Tiles that share a letter are {} in {}: another seed changes as much.",
                        store::close_words, info.title)
          : fmt::format("All tiles are {}: another seed changes as much.", store::close_words);
  return noise;
}

}  // namespace neve::app::pick

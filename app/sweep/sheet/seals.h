#pragma once
/// What a tile says of the other runs of its point: how often the snow breaks, and a metric with
/// its noise.

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "app/sweep/store/points.h"
#include "app/sweep/store/predictions.h"
#include "render/frame/frame.h"

namespace neve::app::sweep::sheet {

/// sRGB of groups, of equal lightness, again and again.
inline constexpr std::array<std::array<std::uint8_t, 3>, 6> group_colours{
    {{46, 117, 182}, {178, 92, 32}, {58, 132, 80}, {148, 84, 158}, {128, 116, 40}, {170, 70, 96}}};

/// Places on a scale that all tiles share, 0 to 1.
struct Whisker {
  std::string value;  ///< "0.42 m"; "" where no run tells
  double min = 0, mean = 0, max = 0;
};

struct Seal {
  std::string outcome;        ///< "breaks in 1 of 4: not here"
  bool is_undecided = false;  ///< some runs break
  bool is_run = false;        ///< the tile shows the run at full resolution
  std::string value;          ///< "0.42 m"; "" where no run tells
  std::vector<int> groups;    ///< tiles that share one are too close to call; none where all are
  double min = 0, mean = 0, max = 0;  ///< places on a scale that all tiles share, 0 to 1
  /// Of the coarse runs, beside that of full resolution; only with seeds.
  Whisker coarse{};
};

/// Of a sweep with seeds or predictions; without, there are none.
struct Seals {
  std::vector<std::string> key;  ///< lines that explain them
  bool is_noise = false;         ///< no metric tells points apart: whiskers are grey
  std::vector<Seal> of_points;
};

/// The metric of the whiskers is the first that is not noise, of those that measure the snow. With
/// predictions they show these, of the first quantity that tells points apart, and with seeds the
/// coarse runs beside them.
Seals seals_of(const store::Manifest& manifest, const std::vector<store::RunResult>& results,
               const std::vector<predict::Prediction>& predictions);

/// "expected at full resolution: undecided; coarse: breaks in 1 of 4", "full resolution: breaks",
/// "full: breaks in 2 of 4; coarse: breaks in 1 of 4";
/// "" of a point of which nothing is known.
std::string predicted_outcome(const predict::Prediction& prediction, const store::Point& point);

/// "breaks in 1 of 4: here"; says whether a run is of those where some break and some hold.
std::string outcome_at(const store::Point& point, const store::RunResult& run);

/// The place of a tile, px.
struct SealPlace {
  float x = 0, y = 0, width = 0, height = 0, font_size = 16;
};

/// Puts it along the lower edge of a tile.
void draw_seal(const Seal& seal, bool is_noise, const SealPlace& tile, render::Frame& words);

}  // namespace neve::app::sweep::sheet

#pragma once
/// Marks on a tile for the other runs of its point: how often the snow breaks, and a metric with
/// its noise.

#include <string>
#include <vector>

#include "app/sweep/sheet/key.h"
#include "app/sweep/sheet/marks.h"
#include "app/sweep/store/points.h"
#include "app/sweep/store/predictions.h"
#include "render/frame/frame.h"

namespace neve::app::sweep::sheet {

/// A whisker on a scale that all tiles share.
struct Whisker {
  std::string value;  ///< "0.42 m"; "" where no run tells
  WhiskerSpan span{};
};

struct Seal {
  std::string outcome;        ///< "breaks in 1 of 4: not here"
  bool is_undecided = false;  ///< some runs break
  bool is_run = false;        ///< the tile shows the run at full resolution
  Whisker whisker{};
  std::vector<int> groups{};  ///< tiles that share one are too close to call; none where all are
  /// The whisker of the coarse runs, beside that of full resolution; only with seeds.
  Whisker coarse{};
};

/// The seals of a sweep with seeds or predictions; other sweeps have none.
struct Seals {
  std::vector<KeyLine> key;  ///< explains them
  std::string title;         ///< what the whiskers show: "spread"
  bool is_noise = false;     ///< no metric tells points apart: whiskers are grey
  bool is_unknown = false;   ///< too few runs ended to say what is noise: tiles have no letters
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

/// Rows of words and whiskers that the fullest seal has. @param letters  that fit side by side
int rows_of(const Seals& seals, std::size_t letters);

/// The place of a seal, px.
struct SealPlace {
  float x = 0, y = 0, width = 0, height = 0, font_size = 16;
};

void draw_seal(const Seal& seal, const Seals& all, const SealPlace& place, render::Frame& words);

}  // namespace neve::app::sweep::sheet

#pragma once
/// Predictions of a run at full resolution by coarse copies of its scene, with their uncertainty.

#include <string>
#include <vector>

#include "app/predict/copies.h"
#include "app/support/json.h"

namespace neve::app::predict {

enum class Verdict { breaks, holds, undecided, cannot_say };
const char* name(Verdict verdict);

/// Four of five runs at full resolution lie in the interval: docs/prediction.md counts them.
struct Estimate {
  Quantity quantity;
  double expected = 0, low = 0, high = 0;
  double variance = 0;  ///< of runs that were made; 0 of a prediction
};

struct Prediction {
  std::vector<Copy> copies;
  std::vector<Estimate> estimates;  ///< none where copies cannot say
  int frame = 0;                    ///< number of the one that is predicted
  bool is_run = false;              ///< no prediction: runs at full resolution were made
  int runs = 0, broken = 0;  ///< these, one for each seed; estimates are their mean and range
  Verdict verdict = Verdict::cannot_say;
  std::string reason;  ///< of the verdict, a sentence
};

/// Half of an interval where all copies agree, as a share of the value: so far at least a full run
/// with another seed may lie.
double share_of(Quantity quantity);

/// @param copies  the finest first, as run_copies() makes them; at least two
Prediction judge(std::vector<Copy> copies);
/// True where something is said, and it is neither that the snow breaks nor that it holds.
bool is_in_doubt(const Prediction& prediction);

/// Returns a prediction that says nothing, for a reason.
Prediction silent(std::string reason);

/// Says what the copies of a scene cost, runs them, and judges.
/// @param last     frame, counted from 0
/// @param seconds  of the run itself, by a forecast; 0: not known
Prediction make_prediction(const scene::Scene& scene, int last, double seconds, int threads,
                           Progress& progress);

/// "spread 0.408 m (0.353 to 0.463)"
std::string text_of(const Estimate& estimate);
/// "at full resolution, frame 24: breaks (in all 3 copies)", and a line for each estimate.
std::vector<std::string> caption_of(const Prediction& prediction);
/// Returns the lines that `neve check --predict` prints.
std::string text_of(const Prediction& prediction);
/// @return with the lines of the caption as `text`
Json to_json(const Prediction& prediction);

}  // namespace neve::app::predict

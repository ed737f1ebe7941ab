#pragma once
/// What coarse copies of a scene say of its run at full resolution, with how far it may be off.

#include <optional>
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
};

struct Prediction {
  std::vector<Copy> copies;
  std::vector<Estimate> estimates;  ///< none where copies cannot say
  Verdict verdict = Verdict::cannot_say;
  std::string reason;  ///< of the verdict, a sentence
};

/// @param copies  as run_copies() makes them
Prediction judge(std::vector<Copy> copies, const scene::Scene& scene);

/// Of `neve check --predict`.
std::string text_of(const Prediction& prediction);
Json to_json(const Prediction& prediction);

}  // namespace neve::app::predict

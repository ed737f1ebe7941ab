#pragma once
/// The card of a material: the same six experiments for each.

#include <functional>
#include <vector>

#include "app/card/experiment.h"
#include "app/support/json.h"

namespace neve::app::card {

struct Card {
  Subject subject;
  std::vector<Experiment> experiments;  ///< in the order of kinds
};

/// Experiments run side by side, each on one thread: the numbers do not depend on how many there
/// are.
/// @param done  is called from any thread after each of them
/// @throws Error after an interrupt, sim::ShapeError
std::vector<Card> make_cards(const std::vector<Subject>& subjects, int threads,
                             const std::function<void()>& done = {});

/// Writes the numbers of a card; strains and shares are not percentages, units are those of SI.
Json to_json(const Card& card);

}  // namespace neve::app::card

#include "app/run/validation.h"

#include <algorithm>

#include "app/support/text.h"

namespace neve::app::run {

Validation::Validation(const sim::SolverSettings& settings,
                       const std::vector<sim::Material>& materials,
                       const sim::Simulation& simulation, Progress& progress)
    : simulation_(simulation), progress_(progress), watch_(settings, materials) {}

void Validation::after_step() {
  if (!sim::checks::is_watch_due(simulation_.steps())) return;
  for (const std::string& sentence : watch_.look(simulation_)) progress_.warning(sentence);
}

bool Validation::has_held() const {
  return std::all_of(records().begin(), records().end(),
                     [](const sim::checks::WatchRecord& record) { return record.times == 0; });
}

std::string Validation::summary() const {
  std::string broken;
  for (const sim::checks::WatchRecord& record : records()) {
    if (record.times == 0) continue;
    broken += (broken.empty() ? "" : "; ") + std::string(sim::checks::name(record.check)) +
              " broken at " + std::to_string(record.times) + ", first at step " +
              std::to_string(record.first_step) + ", worst " + rough_text(record.worst) +
              (record.is_below ? " (at least " : " (at most ") + rough_text(record.threshold) + ")";
  }
  return "validation: " + std::to_string(records().size()) + " checks at " +
         std::to_string(watch_.looks()) + (watch_.looks() == 1 ? " step, " : " steps, ") +
         (broken.empty() ? "all held" : broken);
}

}  // namespace neve::app::run

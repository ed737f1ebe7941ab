#pragma once
/// Results of `neve bench`: rows, as a table, as Markdown, as JSON.

#include <array>
#include <optional>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

#include "app/support/json.h"
#include "sim/simulation.h"

namespace neve::app::bench {

/// Statistics over the rounds of one measurement.
struct Statistics {
  double median = 0, min = 0, max = 0;
};
/// @param samples at least one
Statistics statistics_of(std::vector<double> samples);

/// One figure. `name`, `unit` and the output of to_json() are a contract: scripts depend on them.
struct BenchRow {
  std::string name;
  int threads = 0;
  std::size_t particles = 0;
  std::string simd;
  Statistics value;
  std::string unit;
  std::optional<double> ratio_to_naive{};     ///< at one thread each
  std::optional<sim::PhaseSeconds> phases{};  ///< per particle and step
};

/// Rows that get a sample in each round, in the order in which they come up.
class RowSamples {
 public:
  /// @param row  without its value; of one that is known its name counts
  void add(const BenchRow& row, double sample);
  std::vector<BenchRow> rows() const;

 private:
  std::vector<std::pair<BenchRow, std::vector<double>>> rows_;
};

struct Phase {
  const char* name;
  double sim::PhaseSeconds::*seconds;
};
inline constexpr std::array<Phase, 6> phases{
    {{"partition", &sim::PhaseSeconds::partition},
     {"particles_to_grid", &sim::PhaseSeconds::particles_to_grid},
     {"grid_update", &sim::PhaseSeconds::grid_update},
     {"solve", &sim::PhaseSeconds::solve},
     {"grid_to_particles", &sim::PhaseSeconds::grid_to_particles},
     {"checks", &sim::PhaseSeconds::checks}}};

/// "M particle-steps/s"
extern const char* const throughput_unit;

Json to_json(const std::vector<BenchRow>& rows);

/// Aligned columns for a terminal, or Markdown tables with the machine above them.
void print_tables(std::ostream& out, const std::vector<BenchRow>& rows, bool is_markdown);

}  // namespace neve::app::bench

#pragma once
/// Results of `neve bench`: rows, as a table, as Markdown, as JSON.

#include <optional>
#include <ostream>
#include <string>
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
  std::optional<double> ratio_to_naive;     ///< at one thread each
  std::optional<sim::PhaseSeconds> phases;  ///< per particle and step
};

/// "M particle-steps/s"
extern const char* const throughput_unit;

Json to_json(const std::vector<BenchRow>& rows);

/// Aligned columns for a terminal.
void print_table(std::ostream& out, const std::vector<BenchRow>& rows);
/// The same as Markdown tables, with the machine above them.
void print_markdown(std::ostream& out, const std::vector<BenchRow>& rows);

}  // namespace neve::app::bench

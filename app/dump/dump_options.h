#pragma once
/// Command line options of a dump.

#include <cstddef>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "app/run/render_options.h"
#include "sim/types/math.h"
#include "sim/types/stage.h"

namespace neve::app::dump {

enum class DumpFormat { table, vtk };

/// A particle by its id, or the point nearest to a place.
using Probe = std::variant<std::size_t, sim::Vec3d>;

struct DumpOptions {
  run::RenderOptions run;           ///< scene, overrides, coarsening, threads, verbosity, is_json
  std::vector<double> at{0};        ///< s, increasing, at least one
  std::optional<sim::Stage> stage;  ///< without: the state before the step
  std::vector<std::string> fields;  ///< empty: all
  std::vector<Probe> probes;
  DumpFormat format = DumpFormat::table;
  bool is_histogram = false;  ///< spreads of the quantities, no rows
  std::string file;  ///< empty: standard output; of several times each has its number in the name
};

/// Says that a word is a quantity: "J_P is a quantity: --field J_P"; "" if it names none.
/// @param is_histogram  of a word beside --histogram, which is right with every quantity
std::string field_advice(const std::string& word, bool is_histogram = false);

/// A stage of the step by its name. @throws UsageError with the nearest
sim::Stage parse_stage(const std::string& text);

/// "17": a particle; "0.1,0.5,0": a place in metres. @throws UsageError
Probe parse_probe(const std::string& text);
std::string probe_text(const Probe& probe);

/// "table" or "vtk". @throws UsageError
DumpFormat parse_format(const std::string& text);
inline const char* format_name(DumpFormat format) {
  return format == DumpFormat::vtk ? "vtk" : "table";
}

}  // namespace neve::app::dump

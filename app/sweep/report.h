#pragma once
/// report.html: everything about a sweep in one file without links to anywhere else.

#include <string>
#include <vector>

#include "app/sweep/results.h"
#include "app/sweep/sheet_layout.h"

namespace neve::app {

/// @param folder as the commands that repeat runs name it
/// @param sheet_png the sheet of the last frame; empty: none
std::string report_html(const std::string& folder, const Manifest& manifest,
                        const std::vector<RunResult>& results, const SheetLayout& layout,
                        const std::vector<std::uint8_t>& sheet_png);

/// The command that makes a run's pictures again.
std::string repeat_command(const std::string& folder, const ManifestRun& run);

}  // namespace neve::app

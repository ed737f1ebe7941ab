#pragma once
/// report.html: everything about a sweep in one file without links to anywhere else.

#include <string>
#include <vector>

#include "app/sweep/sheet/sheet_layout.h"
#include "app/sweep/store/results.h"

namespace neve::app::sweep::sheet {

/// @param folder as the commands that repeat runs name it
/// @param sheet_png the sheet of the last frame, its first page; empty: none
/// @param pages     that the sheet has
std::string report_html(const std::string& folder, const store::Manifest& manifest,
                        const std::vector<store::RunResult>& results, const SheetLayout& layout,
                        const std::vector<std::uint8_t>& sheet_png, std::size_t pages = 1);

/// The command that makes a run's pictures again.
std::string repeat_command(const std::string& folder, const Run& run);

}  // namespace neve::app::sweep::sheet

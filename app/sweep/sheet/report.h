#pragma once
/// report.html: a page to walk through a sweep in, one file without links to anywhere but the
/// pictures of its runs.

#include <string>
#include <string_view>
#include <vector>

#include "app/predict/predict.h"
#include "app/sweep/sheet/sheet_layout.h"
#include "app/sweep/store/results.h"

namespace neve::app::sweep::sheet {

/// @param folder as the commands that repeat runs name it
/// @param sheet_png the sheet of the last frame, its first page; empty: none
/// @param pages     that the sheet has
/// @param predictions  of the points; none without --predict
std::string report_html(const std::string& folder, const store::Manifest& manifest,
                        const std::vector<store::RunResult>& results, const SheetLayout& layout,
                        const std::vector<std::uint8_t>& sheet_png, std::size_t pages = 1,
                        const std::vector<predict::Prediction>& predictions = {});

/// The same page with other stars.
std::string report_with_marks(std::string page, const store::Manifest& manifest);

/// Files of the folder report, which are compiled in; see cmake/EmbedFiles.cmake.
std::string_view find_embedded_report(std::string_view file_name);

}  // namespace neve::app::sweep::sheet

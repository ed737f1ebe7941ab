#pragma once
/// Style and script of report.html.

namespace neve::app::sweep::sheet {

extern const char* const report_style;
/// Reads the JSON in #data; fills #table and #parallel.
extern const char* const report_script;

}  // namespace neve::app::sweep::sheet

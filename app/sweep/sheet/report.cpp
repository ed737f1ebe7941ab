#include "app/sweep/sheet/report.h"

#include <algorithm>
#include <cstdio>

#include "app/setup/command_text.h"
#include "app/support/text.h"
#include "app/sweep/sheet/effects.h"
#include "app/sweep/sheet/metric_plots.h"
#include "app/sweep/sheet/report_page.h"
#include "app/sweep/sheet/svg_text.h"

namespace neve::app::sweep::sheet {

namespace {

std::string base64(const std::vector<std::uint8_t>& bytes) {
  static const char* const digits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve(4 * (bytes.size() / 3 + 1));
  for (std::size_t k = 0; k < bytes.size(); k += 3) {
    const std::size_t left = bytes.size() - k;
    const unsigned b0 = bytes[k], b1 = left > 1 ? bytes[k + 1] : 0,
                   b2 = left > 2 ? bytes[k + 2] : 0;
    const unsigned group = b0 << 16 | b1 << 8 | b2;
    text += digits[group >> 18 & 63];
    text += digits[group >> 12 & 63];
    text += left > 1 ? digits[group >> 6 & 63] : '=';
    text += left > 2 ? digits[group & 63] : '=';
  }
  return text;
}

/// A number where it is one, so that it sorts as one.
Json cell_of(const std::string& value) {
  if (const std::optional<double> x = number_of(value)) return *x;
  return value.empty() ? Json() : Json(plan::value_text(value));
}

Json column(const std::string& title, bool is_text, bool is_parallel,
            const std::string& help = {}) {
  return {{"title", title}, {"text", is_text}, {"parallel", is_parallel}, {"help", help}};
}

bool has_labels(const store::Manifest& manifest) {
  return std::any_of(manifest.runs.begin(), manifest.runs.end(),
                     [](const Run& run) { return !run.label.empty(); });
}

Json column_names(const store::Manifest& manifest) {
  Json columns = Json::array();
  columns.push_back(column("run", false, false));
  if (has_labels(manifest)) columns.push_back(column("name", true, false));
  for (const Parameter& p : manifest.parameters)
    columns.push_back(column(p.name + (p.unit.empty() ? "" : " (" + p.unit + ")"),
                             p.type != "number" && p.type != "integer", true, p.address));
  columns.push_back(column("state", true, false));
  columns.push_back(column("warnings", false, false, "hover over a cell for the text"));
  columns.back()["is_warning"] = true;
  for (const store::MetricInfo& metric : store::metric_infos())
    columns.push_back(column(
        std::string(metric.title) + (metric.unit[0] ? std::string(" (") + metric.unit + ")" : ""),
        false, true, metric.name));
  columns.push_back(column("reason", true, false));
  return columns;
}

/// Parameters that are numbers as they were written, by column: rounding is for results.
Json written_values(const store::Manifest& manifest, const Run& run) {
  Json texts = Json::object();
  std::size_t c = has_labels(manifest) ? 2 : 1;
  for (const Parameter& p : manifest.parameters) {
    const std::string value = run.value(p.address);
    if (cell_of(value).is_number()) texts[std::to_string(c)] = value;
    ++c;
  }
  return texts;
}

Json row_of(const store::Manifest& manifest, const Run& run, const store::RunResult& result) {
  Json cells = Json::array();
  cells.push_back(run.index);
  if (has_labels(manifest)) cells.push_back(run.label);
  for (const Parameter& p : manifest.parameters) cells.push_back(cell_of(run.value(p.address)));
  cells.push_back(store::name(result.status.state));
  cells.push_back(result.warnings.size());
  for (const std::optional<double>& value : result.metrics)
    cells.push_back(value ? Json(*value) : Json());
  cells.push_back(result.status.reason);
  return {{"run", run.index},
          {"label", run.label},
          {"failed", store::has_failed(result.status.state)},
          {"warnings", result.warnings},
          {"texts", written_values(manifest, run)},
          {"cells", cells}};
}

/// No "</script>" can end it early.
std::string script_json(const Json& json) {
  std::string text = to_text(json, -1), out;
  for (const char c : text) out += c == '<' ? std::string("\\u003c") : std::string(1, c);
  return out;
}

std::string css_percent(double part, double whole) {
  return fixed_text(100 * part / whole, 3) + "%";
}

std::string sheet_section(const store::Manifest& manifest, const SheetLayout& layout,
                          const std::vector<std::uint8_t>& png) {
  if (png.empty()) return "<p class=\"hint\">No picture yet.</p>\n";
  std::string html =
      "<div class=\"sheet\"><img alt=\"contact sheet of all runs\" src=\"data:image/png;base64," +
      base64(png) + "\">\n";
  for (const SheetTile& tile : layout.tiles) {
    const std::string run = std::to_string(manifest.runs[tile.run].index);
    html += "<a href=\"#run-" + run + "\" data-run=\"" + run + "\" title=\"run " + run +
            "\" style=\"left:" + css_percent(tile.x, layout.width) +
            ";top:" + css_percent(tile.y, layout.height) +
            ";width:" + css_percent(layout.tile_width, layout.width) +
            ";height:" + css_percent(layout.tile_height, layout.height) + "\"></a>\n";
  }
  return html + "</div>\n";
}

/// Where the runs are that the picture above does not have.
std::string pages_hint(std::size_t pages) {
  if (pages < 2) return {};
  return "<p class=\"hint\">Page 1 of " + std::to_string(pages) +
         "; the others are sheet_2.png to sheet_" + std::to_string(pages) + ".png.</p>\n";
}

std::string effects_section(const store::Manifest& manifest,
                            const std::vector<store::RunResult>& results) {
  const std::string svg = effects_svg(manifest, results, false);
  if (svg.empty()) return {};
  return "<h2>Effects</h2>\n<div class=\"wide\" id=\"effects\">" + svg + "</div>\n";
}

std::string commands_section(const std::string& folder, const store::Manifest& manifest) {
  std::string html =
      "<div class=\"wide\"><table><thead><tr><th>run</th><th "
      "class=\"text\">command</th></tr></thead><tbody>\n";
  for (const Run& run : manifest.runs) {
    const std::string command = xml_text(repeat_command(folder, run));
    html += "<tr data-run=\"" + std::to_string(run.index) + "\"><td>" + std::to_string(run.index) +
            "</td><td class=\"text\"><code>" + command + "</code><button data-copy=\"" + command +
            "\">copy</button></td></tr>\n";
  }
  return html + "</tbody></table></div>\n";
}

}  // namespace

std::string repeat_command(const std::string& folder, const Run& run) {
  const std::string scene = folder + "/runs/" + run.folder + "/scene.toml";
  return "neve render " + setup::shell_word(scene) + " --frames " +
         std::to_string(run.frames.first) + "-" + std::to_string(run.frames.last) + " --out " +
         setup::shell_word("again/" + run.folder);
}

std::string report_html(const std::string& folder, const store::Manifest& manifest,
                        const std::vector<store::RunResult>& results, const SheetLayout& layout,
                        const std::vector<std::uint8_t>& sheet_png, std::size_t pages) {
  Json data;
  data["columns"] = column_names(manifest);
  data["rows"] = Json::array();
  int failed = 0, ok = 0;
  for (std::size_t k = 0; k < manifest.runs.size(); ++k) {
    data["rows"].push_back(row_of(manifest, manifest.runs[k], results[k]));
    failed += store::has_failed(results[k].status.state);
    ok += results[k].status.state == store::RunState::ok;
  }
  const int open = static_cast<int>(manifest.runs.size()) - ok - failed;
  std::string sub = std::to_string(manifest.runs.size()) + " runs of " + manifest.scene_file +
                    ": " + std::to_string(ok) + " ok";
  if (failed > 0) sub += ", " + std::to_string(failed) + " failed";
  if (open > 0) sub += ", " + std::to_string(open) + " not finished";
  sub += "; neve " + manifest.version;
  return "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n<title>" +
         xml_text(manifest.title) + "</title>\n<style>" + report_style + "</style></head><body>\n" +
         "<h1>" + xml_text(manifest.title) + "</h1>\n<p class=\"sub\">" + xml_text(sub) + "</p>\n" +
         sheet_section(manifest, layout, sheet_png) + pages_hint(pages) +
         effects_section(manifest, results) +
         "<h2>Runs</h2>\n<p class=\"hint\">Metrics are those of the last frame of each run. Click "
         "a column head to sort.</p>\n<div class=\"wide\"><table id=\"table\"></table></div>\n" +
         "<h2>Parallel coordinates</h2>\n<p class=\"hint\">One line per run; hover over a line, a "
         "row or a tile.</p>\n<div class=\"wide\"><svg id=\"parallel\"></svg></div>\n" +
         "<h2>Metrics</h2>\n<div class=\"wide\" id=\"plots\">" +
         metric_plots_svg(manifest, results, false) + "</div>\n" +
         "<h2>Commands</h2>\n<p class=\"hint\">Each command makes the pictures of its run again, "
         "bit for bit.</p>\n" +
         commands_section(folder, manifest) + "<script type=\"application/json\" id=\"data\">" +
         script_json(data) + "</script>\n" + "<script>" + report_script +
         "</script>\n</body></html>\n";
}

}  // namespace neve::app::sweep::sheet

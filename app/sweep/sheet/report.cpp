#include "app/sweep/sheet/report.h"

#include <map>
#include <string_view>

#include "app/support/json.h"
#include "app/support/text.h"
#include "app/sweep/sheet/effects.h"
#include "app/sweep/sheet/metric_plots.h"
#include "app/sweep/sheet/report_data.h"
#include "app/sweep/store/refine.h"
#include "app/sweep/store/stars.h"
#include "render/overlay/svg.h"

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

/// Writes JSON that no "</script>" can end early.
std::string script_json(const Json& json) {
  std::string text = to_text(json, -1), out;
  for (const char c : text) out += c == '<' ? std::string("\\u003c") : std::string(1, c);
  return out;
}

std::string css_percent(double part, double whole) {
  return fixed_text(100 * part / whole, 3) + "%";
}

/// The sheet as one picture, which the page has even where it was moved away from the runs.
std::string paper_section(const store::Manifest& manifest, const SheetLayout& layout,
                          const std::vector<std::uint8_t>& png) {
  if (png.empty()) return "<p class=\"hint\">No picture yet.</p>\n";
  std::string html =
      "<div class=\"paper\"><img alt=\"contact sheet of all runs\" loading=\"lazy\" "
      "src=\"data:image/png;base64," +
      base64(png) + "\">\n";
  for (const SheetTile& tile : layout.tiles) {
    const std::size_t first = tile.run * static_cast<std::size_t>(manifest.seeds);
    const std::string run = std::to_string(manifest.runs[first].index);
    html +=
        "<a href=\"#run-" + run + "\" data-run=\"" + run + "\" title=\"run " + run +
        "\" style=\"left:" + css_percent(tile.x, layout.width) +
        ";top:" + css_percent(tile.y - layout.label_height, layout.height) +
        ";width:" + css_percent(layout.tile_width, layout.width) + ";height:" +
        css_percent(layout.label_height + layout.tile_height + layout.seal_height, layout.height) +
        "\"></a>\n";
  }
  return html + "</div>\n";
}

/// Tells the pages with the runs that the picture above does not have.
std::string pages_hint(std::size_t pages) {
  if (pages < 2) return {};
  return "<p class=\"hint\">Page 1 of " + std::to_string(pages) +
         "; the others are sheet_2.png to sheet_" + std::to_string(pages) + ".png.</p>\n";
}

std::string effects_section(const store::Manifest& manifest,
                            const std::vector<store::RunResult>& results) {
  const std::string svg = effects_svg(manifest, results, false);
  if (svg.empty()) return {};
  return "<section>\n<h2>What each parameter does to each metric</h2>\n<div class=\"wide white\" "
         "id=\"effects\">" +
         svg + "</div>\n</section>\n";
}

/// The page does not hold the drawing with a point for each run and metric: its tens of thousands
/// of elements would make the page of a large sweep slow.
std::string more_section(const store::Manifest& manifest,
                         const std::vector<store::RunResult>& results, const SheetLayout& layout,
                         const std::vector<std::uint8_t>& sheet_png, std::size_t pages) {
  std::string html = "<details class=\"more\"><summary>Contact sheet in one picture</summary>\n" +
                     paper_section(manifest, layout, sheet_png) + pages_hint(pages) +
                     "</details>\n";
  if (!metric_plots_svg(manifest, results).empty())
    html +=
        "<details class=\"more\"><summary>Every metric against every parameter</summary>\n<div "
        "class=\"wide\"><img alt=\"plots.svg, beside this file\" loading=\"lazy\" "
        "src=\"plots.svg\"></div></details>\n";
  return html;
}

std::string summary_of(const store::Manifest& manifest,
                       const std::vector<store::RunResult>& results) {
  int ok = 0;
  const std::string others = store::other_ends(results, ok);
  const std::size_t seeds = static_cast<std::size_t>(manifest.seeds), runs = manifest.runs.size();
  std::string text =
      std::to_string(runs) + " runs of " + manifest.scene_file + ": " + std::to_string(ok) + " ok";
  if (seeds > 1)
    text = std::to_string(runs / seeds) + " points of " + std::to_string(seeds) + " seeds, " + text;
  text += others;
  if (!manifest.coarsened.empty()) text += "; " + manifest.coarsened;
  return text + "; neve " + manifest.version;
}

/// Puts texts in for {{their names}}. Marks in those texts are left alone.
std::string fill_page(std::string_view page, const std::map<std::string, std::string>& texts) {
  std::string out;
  for (;;) {
    const std::size_t begin = page.find("{{"), end = page.find("}}");
    if (begin == std::string_view::npos) return out += page;
    out += page.substr(0, begin);
    out += texts.at(std::string(page.substr(begin + 2, end - begin - 2)));
    page.remove_prefix(end + 2);
  }
}

}  // namespace

std::string report_html(const std::string& folder, const store::Manifest& manifest,
                        const std::vector<store::RunResult>& results, const SheetLayout& layout,
                        const std::vector<std::uint8_t>& sheet_png, std::size_t pages,
                        const std::vector<predict::Prediction>& predictions) {
  std::string hints;
  for (const std::string& line : store::idle_lines(manifest, results))
    hints += "<p class=\"hint\">" + render::overlay::xml_text(line) + "</p>";
  const std::string ranking =
      store::ranking_line(manifest, results, store::full_results(folder, manifest));
  std::string script;
  for (const char* file : {"sweep.js", "noise.js", "page.js", "stars.js", "walk.js", "lists.js",
                           "charts.js", "start.js"})
    script += find_embedded_report(file);
  return fill_page(
      find_embedded_report("page.html"),
      {{"title", render::overlay::xml_text(manifest.title)},
       {"summary", render::overlay::xml_text(summary_of(manifest, results))},
       {"hints", hints + (ranking.empty() ? ""
                                          : "<p class=\"hint\" id=\"ranking\">" +
                                                render::overlay::xml_text(ranking) + "</p>")},
       {"style", std::string(find_embedded_report("style.css"))},
       {"script", script},
       {"data", script_json(report_data(folder, manifest, results, predictions))},
       {"stars", script_json(store::to_json(manifest, manifest.marks))},
       {"effects", effects_section(manifest, results)},
       {"more", more_section(manifest, results, layout, sheet_png, pages)}});
}

std::string report_with_marks(std::string page, const store::Manifest& manifest) {
  const std::string begin = "<script type=\"application/json\" id=\"stars\">";
  const std::size_t at = page.find(begin), end = page.find("</script>", at);
  // A page of before there were stars has none until the next collect.
  if (at == std::string::npos || end == std::string::npos) return page;
  return page.replace(at + begin.size(), end - at - begin.size(),
                      script_json(store::to_json(manifest, manifest.marks)));
}

}  // namespace neve::app::sweep::sheet

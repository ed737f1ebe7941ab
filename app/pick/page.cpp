#include "app/pick/page.h"

#include <fmt/format.h>

#include "app/support/json.h"

namespace neve::app::pick {

namespace {

constexpr const char* page_style = R"(
body { margin: 1rem; background: #16181d; color: #e8eaf0; font: 16px sans-serif; }
main { display: grid; grid-template-columns: repeat(3, 1fr); gap: 6px; max-width: 1500px; }
figure { margin: 0; position: relative; background: #000; min-height: 6rem; }
img { width: 100%; display: block; }
figcaption { position: absolute; left: 8px; top: 4px; font-size: 1.4rem; font-weight: bold;
  text-shadow: 0 0 4px #000, 0 0 4px #000; }
figcaption small { display: block; font-size: .8rem; font-weight: normal; }
svg { max-width: 30rem; height: auto; }
)";

/// All tiles show the same moment; those that ended early show their last picture.
constexpr const char* page_script = R"(
const images = [...document.querySelectorAll("img")];
const loaded = tiles.map(files => files.map(file => { const i = new Image(); i.src = file; return i; }));
const count = Math.max(1, ...tiles.map(files => files.length));
const start = performance.now();
function draw(now) {
  const pause = fps / 2;
  // The time of the first call may lie before the start.
  const k = Math.floor(Math.max(0, now - start) / 1000 * fps) % Math.ceil(count + pause);
  images.forEach((image, t) => {
    const files = loaded[t];
    if (!files.length) return;
    const source = files[Math.min(k, files.length - 1)].src;
    if (image.src !== source) image.src = source;
  });
  requestAnimationFrame(draw);
}
requestAnimationFrame(draw);
)";

}  // namespace

std::string page_html(const RoundPage& page) {
  std::string html = fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">"
      "<title>neve pick: round {0} of {1}</title>\n<style>{2}</style></head><body>\n"
      "<h1>Round {0} of {1}</h1>\n<p>Type the number of the best tile in the terminal; two numbers "
      "for two that are equally good, 0 for none.{3}</p>\n<main>\n",
      page.round, page.rounds, page_style,
      page.has_favourite ? " Tile 1 is the favourite so far." : "");
  for (std::size_t k = 0; k < page.tiles.size(); ++k)
    html += fmt::format(
        "<figure><img alt=\"tile "
        "{0}\"><figcaption>{0}{1}<small>{2}</small></figcaption></figure>\n",
        k + 1, page.tiles[k].empty() ? ": no picture" : "",
        k < page.noise.tiles.size() ? page.noise.tiles[k] : "");
  html += "</main>\n";
  if (!page.noise.key.empty()) html += "<p>" + page.noise.key + "</p>\n";
  if (!page.learned.empty()) html += "<h2>Learned so far</h2>\n<ul>\n";
  for (const std::string& line : page.learned) html += "<li>" + line + "</li>\n";
  if (!page.learned.empty()) html += "</ul>\n" + page.map;
  return html + fmt::format("<script>\nconst fps = {}, tiles = {};\n{}</script></body></html>\n",
                            page.fps, to_text(Json(page.tiles), -1), page_script);
}

}  // namespace neve::app::pick

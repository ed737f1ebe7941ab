#include "app/card/card_options.h"

#include <filesystem>

#include "app/options/common.h"
#include "app/options/languages.h"
#include "app/run/render_options.h"

namespace neve::app::card {

namespace {

void check_picture(const std::string& flag, const std::string& file) {
  if (std::filesystem::path(file).extension() != ".png")
    throw UsageError(flag, "is not the name of a picture", "expected a file that ends in .png");
}

}  // namespace

void describe(options::Command& visit, CardOptions& o) {
  visit.about(
      "card",
      "Press, tear, shear, drop and tilt a material, and let a column of it go: one picture "
      "with curves, and the numbers as JSON");
  visit("SCENE", o.scenes, options::scene_file(),
        "Scene file (TOML), picture made by neve, or folder of a run: a card for each of its "
        "materials; several are shown beside each other. Default: a falling snowball");
  visit("--preset", o.presets, options::choice<scene::Preset>("NAME", "preset"),
        "Card of a preset of snow, as in wet (repeatable)");
  visit("--set", o.overrides, options::text("ADDRESS=VALUE", "material.snow.hardening=5"),
        "Change a parameter, as in material.snow.hardening=5 (repeatable); the snow of a preset is "
        "called snow");
  visit("--material", o.materials, options::text("NAME", "snow"),
        "Only the material of this name (repeatable)");
  visit("--out", o.out, options::text("PNG", "card.png", check_picture),
        "Write to this file instead of out/<title>/card.png; the numbers go beside it, in a file "
        "of its name that ends in .json");
  visit("--replace", o.replaces,
        "Replace an earlier card in out/<title> that is of other scenes or settings; without it "
        "neve says what would go and stops");
  options::describe_threads(visit, o.threads);
  options::describe_backend(visit, o.backend);
  run::describe_agreement(visit, o.is_agreed);
  visit("--json", o.is_json, options::json_help);
  options::describe_verbosity(visit, o.verbosity);
}

}  // namespace neve::app::card

#include "app/timeline/agreement.h"

#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <new>

#include "app/forecast/forecast.h"
#include "app/output/sequence.h"
#include "app/scene/read.h"
#include "app/support/errors.h"
#include "app/support/machine.h"
#include "app/support/progress.h"
#include "app/support/text.h"

namespace neve::app::timeline {

namespace {

namespace fs = std::filesystem;

/// s, from which on a person is asked.
constexpr double longest_unasked = 60;
/// Bytes, in the same way.
constexpr std::uint64_t largest_unasked = 500'000'000;
/// Particle steps a second and core: slow machines, spread snow.
constexpr double slow_steps = 5e6;
/// A change reads the whole scene again: s, and s for each byte of it.
constexpr double seconds_of_change = 1e-3, seconds_of_byte = 1e-6;

/// True for a picture in the folder of a run, or of one of its views: then its run is here too.
bool is_in_run(const fs::path& picture) {
  std::error_code error;
  const fs::path folder = fs::absolute(picture, error).parent_path();
  return fs::exists(output::run_json_path(folder), error) ||
         fs::exists(output::run_json_path(folder.parent_path()), error);
}

/// Bytes of the whole picture while its tiles are laid into it.
double memory_of_strip(const scene::Scene& scene, const record::PictureRecord& record) {
  if (!record.strip || scene.views.empty()) return 0;
  constexpr double bytes_per_pixel = 36;
  const scene::PictureSize tile = setup::size_of(scene, scene.views.front());
  const double columns = std::max(1, record.strip->columns),
               rows = std::ceil(static_cast<double>(record.strip->times.size()) / columns),
               width = record.strip->width;
  return bytes_per_pixel * width * rows * (width / columns) * tile.height / tile.width;
}

bool is_agreed_on_terminal(const std::string& question) {
  if (!::isatty(STDIN_FILENO) || !::isatty(STDERR_FILENO)) return false;
  std::cerr << printable_text(question) << " [y/N] " << std::flush;
  std::string answer;
  std::getline(std::cin, answer);
  return answer == "y" || answer == "Y" || answer == "yes";
}

AgainCost cost_again(const scene::Scene& scene, const setup::Plan& plan,
                     const record::PictureRecord& record) {
  AgainCost cost;
  cost.particle_steps = forecast::work_at_rest(scene, plan);
  cost.memory = plan.memory + static_cast<std::uint64_t>(memory_of_strip(scene, record));
  cost.seconds = cost.particle_steps / slow_steps / core_count(0);
  if (!record.changes.empty())
    cost.seconds += static_cast<double>(record.changes.size()) *
                    (seconds_of_change +
                     seconds_of_byte * static_cast<double>(scene::write_scene(scene).size()));
  return cost;
}

/// The scene with the view of the picture alone: others are not drawn.
scene::Scene drawn_scene(scene::Scene scene, const std::string& view) {
  const auto is_other = [&](const scene::View& v) { return v.name != view; };
  if (std::ranges::all_of(scene.views, is_other)) return scene;  // a mosaic
  std::erase_if(scene.views, is_other);
  scene.mosaics.clear();
  return scene;
}

[[noreturn]] void refuse(const std::string& what, const std::string& file) {
  const std::string hint = "--yes agrees; neve info shows what the picture holds";
  throw LimitError("refused: " + what + "; " + hint, file, hint);
}

void require(const std::string& what, const std::string& file, Agreement agreement) {
  if (agreement == Agreement::refused || !is_agreed_on_terminal(what + ". Continue?"))
    refuse(what, file);
}

}  // namespace

std::string AgainCost::text(int last_frame) const {
  return fmt::format("about {}: {} frames, {} particle steps, {} of memory",
                     duration_text(std::min(seconds, 1e9)), last_frame, rough_text(particle_steps),
                     bytes_text(memory));
}
std::string again_text(const record::PictureRecord& record, const std::string& file) {
  if (!record.files.empty() || !record.plate.empty())
    return "its files are looked for when it is made again, outside of its folder only with --yes; "
           "no other file is read";
  try {
    const scene::Scene scene =
        drawn_scene(scene::read_scene_text(record.scene, file + " (its scene)"), record.view);
    const int last =
        record.strip
            ? static_cast<int>(std::min(1e9, std::ceil(record.strip->times.back() * scene.fps)))
            : scene::frame_of(scene, record.frame);
    const setup::Plan plan =
        setup::make_plan(scene, {last, last}, setup::quality_named(record.quality), 0);
    return cost_again(scene, plan, record).text(last);
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    return std::string("cannot be made again: ") + error.what();
  }
}

void require_agreement(const record::PictureRecord& record, const std::string& file,
                       const scene::Scene& scene, int last, Agreement agreement) {
  if (agreement == Agreement::given || is_in_run(file)) return;
  const scene::Scene drawn = drawn_scene(scene, record.view);
  const setup::Plan plan =
      setup::make_plan(drawn, {last, last}, setup::quality_named(record.quality), 0);
  setup::check_limits(drawn, plan, record.coarsening);
  const AgainCost cost = cost_again(drawn, plan, record);
  if (cost.seconds > longest_unasked || cost.memory > largest_unasked)
    require("making " + file + " again takes " + cost.text(last), file, agreement);
}

void require_agreement(const std::string& file, const std::vector<std::string>& outside,
                       Agreement agreement) {
  if (outside.empty() || agreement == Agreement::given || is_in_run(file)) return;
  constexpr std::size_t max_named = 3;
  const std::vector<std::string> named(
      outside.begin(),
      outside.begin() + static_cast<std::ptrdiff_t>(std::min(max_named, outside.size())));
  require(fmt::format("{} reads {} outside of its folder: {}{}", file,
                      outside.size() == 1 ? "a file" : std::to_string(outside.size()) + " files",
                      joined(named, ", "), outside.size() > max_named ? " and others" : ""),
          file, agreement);
}

}  // namespace neve::app::timeline

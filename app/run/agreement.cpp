#include "app/run/agreement.h"

#include <fmt/core.h>
#include <unistd.h>

#include <filesystem>
#include <iostream>
#include <new>

#include "app/forecast/forecast.h"
#include "app/output/sequence.h"
#include "app/scene/read.h"
#include "app/scene/toml/error.h"
#include "app/support/errors.h"
#include "app/support/machine.h"
#include "app/support/text.h"

namespace neve::app::run {

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

/// In the folder of a run, or in that of one of its views: then its run is here too.
bool is_in_run(const fs::path& picture) {
  std::error_code error;
  const fs::path folder = fs::absolute(picture, error).parent_path();
  return fs::exists(output::run_json_path(folder), error) ||
         fs::exists(output::run_json_path(folder.parent_path()), error);
}

bool is_agreed_on_terminal(const std::string& question) {
  if (!::isatty(STDIN_FILENO) || !::isatty(STDERR_FILENO)) return false;
  std::cerr << printable_text(question) << " [y/N] " << std::flush;
  std::string answer;
  std::getline(std::cin, answer);
  return answer == "y" || answer == "Y" || answer == "yes";
}

}  // namespace

std::string AgainCost::text(int last_frame) const {
  return fmt::format("about {}: {} frames, {} particle steps, {} of memory",
                     duration_text(std::min(seconds, 1e9)), last_frame, rough_text(particle_steps),
                     bytes_text(memory));
}

AgainCost cost_again(const scene::Scene& scene, const setup::Plan& plan, std::size_t changes) {
  AgainCost cost;
  cost.particle_steps = forecast::work_at_rest(scene, plan);
  cost.memory = plan.memory;
  cost.seconds = cost.particle_steps / slow_steps / core_count(0);
  if (changes > 0)
    cost.seconds += static_cast<double>(changes) *
                    (seconds_of_change +
                     seconds_of_byte * static_cast<double>(scene::write_scene(scene).size()));
  return cost;
}

std::string again_text(const record::PictureRecord& record, const std::string& file) {
  if (!record.files.empty() || !record.plate.empty())
    return "its files are looked for when it is made again; no other file is read";
  try {
    const scene::Scene scene = scene::read_scene_text(record.scene, file + " (its scene)");
    const int last = record.strip
                         ? static_cast<int>(std::min(1e9, record.strip->times.back() * scene.fps))
                         : record.frame;
    const setup::Plan plan =
        setup::make_plan(scene, {last, last}, setup::quality_named(record.quality), 0);
    return cost_again(scene, plan, record.changes.size()).text(last);
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    return std::string("cannot be made again: ") + error.what();
  }
}

void require_agreement(const RenderJob& job, const setup::Plan& plan, bool is_agreed,
                       double picture_bytes) {
  if (!job.picture || is_agreed || is_in_run(job.scene_file)) return;
  AgainCost cost = cost_again(job.scene, plan, job.changes.size());
  cost.memory += static_cast<std::uint64_t>(picture_bytes);
  if (cost.seconds <= longest_unasked && cost.memory <= largest_unasked) return;
  const std::string what =
      fmt::format("making {} again takes {}", job.scene_file, cost.text(plan.frames.last));
  if (is_agreed_on_terminal(what + ". Continue?")) return;
  const std::string hint = "--yes makes it; neve info shows what the picture holds";
  throw LimitError("refused: " + what + "; " + hint, job.scene_file, hint);
}

}  // namespace neve::app::run

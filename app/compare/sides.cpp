#include "app/compare/sides.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>

#include "app/scene/burn_in.h"
#include "app/scene/check.h"
#include "app/scene/flat.h"
#include "app/scene/live_change.h"
#include "app/support/film_rate.h"
#include "app/support/text.h"

namespace neve::app::compare {

namespace {

constexpr std::size_t max_values = 4;

Side read_side(const std::string& path, bool is_agreed) {
  run::RenderOptions options;
  options.scene = path;
  options.is_agreed = is_agreed;
  Side side{run::make_job(options)};
  if (side.job.picture && side.job.picture->strip)
    throw UsageError(path,
                     "is a strip of " +
                         count_text(side.job.picture->strip->times.size(), "moment") +
                         ", which may lie between frames",
                     "compare runs, or pictures of one frame");
  if (side.job.run.empty()) return side;
  const std::vector<record::FrameRecord>& frames = side.job.run_frames;
  if (frames.empty())
    throw Error(exit_invalid_scene,
                path + ": error: the run has no frames, so there is nothing to compare", path,
                "run it again, or wait for its first frame");
  side.job.frames = {frames.front().frame, frames.back().frame};
  return side;
}

std::string range_text(const Side& side, const setup::FrameRange& counted) {
  const setup::FrameRange frames = setup::numbers_of(side.job.scene, counted);
  return frames.count() == 1 ? fmt::format("frame {}", frames.first)
                             : fmt::format("frames {} to {}", frames.first, frames.last);
}

/// s, from the start of the run.
double time_of(const Side& side, int frame) {
  return frame / side.job.scene.fps;
}

/// The first values, a line each, and how many more there are.
std::string values_text(const std::vector<std::string>& texts) {
  std::vector<std::string> lines = scene::override_lines(texts);
  const std::size_t count = lines.size();
  if (count > max_values) {
    lines.resize(max_values);
    lines.push_back(fmt::format("and {} more", count - max_values));
  }
  return joined(lines, ", ");
}

std::string value_text_of(const scene::Difference& d, bool is_b) {
  const std::optional<scene::toml::Value>& value = is_b ? d.after : d.before;
  return d.address + "=" + (value ? scene::toml::toml_literal(*value, 40) : "none");
}

/// Changes of one run that the other does not have.
std::vector<std::string> own_changes(const Side& side, const Side& other) {
  std::vector<std::string> texts;
  const std::vector<scene::LiveChange>& theirs = other.job.changes;
  for (const scene::LiveChange& change : side.job.changes)
    if (std::find(theirs.begin(), theirs.end(), change) == theirs.end())
      texts.push_back(
          fmt::format("{}={} since step {}", change.address, change.value, change.step));
  return texts;
}

void find_differences(Pair& pair) {
  std::vector<std::string> a, b;
  for (const scene::Difference& d : scene::differences(pair.a.job.scene, pair.b.job.scene)) {
    if (!scene::concerns_simulation(d.address)) continue;
    pair.differing.push_back(d.address);
    a.push_back(value_text_of(d, false));
    b.push_back(value_text_of(d, true));
  }
  for (std::string& text : own_changes(pair.a, pair.b)) a.push_back(std::move(text));
  for (std::string& text : own_changes(pair.b, pair.a)) b.push_back(std::move(text));
  pair.a.values = values_text(a);
  pair.b.values = values_text(b);
}

setup::FrameRange common_frames(const PairOptions& options, const Pair& pair) {
  const setup::FrameRange a = pair.a.job.frames, b = pair.b.job.frames;
  const setup::FrameRange both{std::max(a.first, b.first), std::min(a.last, b.last)};
  const std::string found =
      fmt::format("{} has {} and {} has {}", pair.a.job.scene_file, range_text(pair.a, a),
                  pair.b.job.scene_file, range_text(pair.b, b));
  if (both.first > both.last)
    throw UsageError(
        "",
        found +
            fmt::format(": they have no frame in common, at {} to {} s and at {} to {} s",
                        rough_text(time_of(pair.a, a.first)), rough_text(time_of(pair.a, a.last)),
                        rough_text(time_of(pair.b, b.first)), rough_text(time_of(pair.b, b.last))),
        "compare runs, or pictures of one moment");
  if (!options.frames) return both;
  const setup::FrameRange wanted = setup::frames_of(pair.a.job.scene, *options.frames);
  if (wanted.first < both.first || wanted.last > both.last)
    throw UsageError("--frames", found,
                     "expected frames that both have: " + range_text(pair.a, both));
  return wanted;
}

std::string count_text(std::size_t a, std::size_t b, const std::string& body) {
  return fmt::format("body {} has {} particles in A and {} in B", body, a, b);
}

UsageError no_same_snow(const std::string& why) {
  return {"--mode displacement", "no particle of A is the same piece of snow as one of B: " + why,
          "compare runs that place their snow alike, with one seed, cell size and sampling, and an "
          "emitter that always has room, or use --mode beside, wipe or metrics"};
}

/// The parameters that place the particles of a body, of those in which the runs differ.
std::string placing(const Pair& pair, const std::string& body) {
  std::vector<std::string> placing;
  for (const std::string& address : pair.differing)
    for (const std::string& start :
         {"body." + body + ".shape", "body." + body + ".particles_per_cell",
          "body." + body + ".sampling", std::string("solver.cell_size")})
      if (address.starts_with(start)) placing.push_back(address);
  return placing.empty()
             ? ""
             : ": " + joined(placing, ", ") + (placing.size() == 1 ? " differs" : " differ");
}

/// Bodies number their particles in the order in which their places were drawn or read.
std::string place_problem(const Pair& pair, const setup::SeededScene& a,
                          const setup::SeededScene& b, std::size_t body) {
  const std::vector<sim::Vec3d> in_a = setup::own_places(pair.a.job.scene, a, body),
                                in_b = setup::own_places(pair.b.job.scene, b, body);
  const double rounding = 1e-6 * a.spacing;
  if (std::ranges::equal(in_a, in_b, [&](const sim::Vec3d& x, const sim::Vec3d& y) {
        return (x - y).norm() <= rounding;
      }))
    return "";
  const std::string& name = pair.a.job.scene.bodies[body].name;
  return fmt::format("body {} begins with particles in other places{}", name, placing(pair, name));
}

/// s, from birth to birth: infinite where the whole shape is filled at once.
double period_of(const scene::Scene& scene) {
  const sim::seeding::Emitter& emitter = scene.emitters.front();
  return sim::seeding::birth_period(emitter,
                                    scene.materials[setup::material_index(scene, emitter.material)],
                                    scene.solver.cell_size);
}

/// Emitters number their particles in the order of their births.
std::string emitter_problem(const scene::Scene& a, const scene::Scene& b) {
  if (a.emitters.size() != b.emitters.size())
    return fmt::format("A has {} emitters and B has {}", a.emitters.size(), b.emitters.size());
  if (a.emitters.empty()) return "";
  if (scene::mixes_emitters(a)) return scene::mixed_emitters;
  if (a.solver.cell_size != b.solver.cell_size)
    return fmt::format("solver.cell_size is {} m in A and {} m in B",
                       rough_text(a.solver.cell_size), rough_text(b.solver.cell_size));
  // The k-th birth is the same snow, whatever moves it.
  constexpr std::array same_snow{"velocity", "angular_velocity", "end", "material"};
  for (const scene::Difference& d : scene::differences(a, b)) {
    const std::string key = d.address.substr(d.address.rfind('.') + 1);
    if (d.address.starts_with("emitter.") && std::ranges::find(same_snow, key) == same_snow.end())
      return d.address + " differs";
  }
  if (period_of(a) != period_of(b)) return "their emitters have materials of other densities";
  return "";
}

}  // namespace

Pair read_pair(const PairOptions& options) {
  Pair pair;
  pair.a = read_side(options.a, options.is_agreed);
  pair.b = read_side(options.b, options.is_agreed);
  const double fps_a = pair.a.job.scene.fps, fps_b = pair.b.job.scene.fps;
  if (fps_a != fps_b)
    throw UsageError(
        "",
        fmt::format("{} has {} frames a second and {} has {}: their frames are at different times",
                    options.a, plain_rate(fps_a), options.b, plain_rate(fps_b)),
        "render one of them again with --set fps=" + plain_rate(fps_a));
  pair.frames = common_frames(options, pair);
  const bool is_shorter = pair.a.job.frames.last != pair.b.job.frames.last && !options.frames;
  if (is_shorter)
    pair.warnings.push_back(fmt::format("{} has {} and {} has {}: {} are compared", options.a,
                                        range_text(pair.a, pair.a.job.frames), options.b,
                                        range_text(pair.b, pair.b.job.frames),
                                        range_text(pair.a, pair.frames)));
  find_differences(pair);
  return pair;
}

std::optional<UsageError> id_problem(const Pair& pair, const setup::SeededScene& a,
                                     const setup::SeededScene& b) {
  const scene::Scene &scene_a = pair.a.job.scene, &scene_b = pair.b.job.scene;
  std::string why;
  if (scene_a.seed != scene_b.seed)
    why = fmt::format("seed is {} in A and {} in B", scene_a.seed, scene_b.seed);
  else if (a.body_end.size() != b.body_end.size())
    why = fmt::format("A has {} bodies and B has {}", a.body_end.size(), b.body_end.size());
  for (std::size_t k = 0; why.empty() && k < a.body_end.size(); ++k) {
    const std::size_t in_a = a.body_end[k] - a.body_begin(k),
                      in_b = b.body_end[k] - b.body_begin(k);
    why = in_a != in_b ? count_text(in_a, in_b, scene_a.bodies[k].name)
                       : place_problem(pair, a, b, k);
  }
  if (why.empty()) why = emitter_problem(scene_a, scene_b);
  if (why.empty()) return std::nullopt;
  return no_same_snow(why);
}

std::optional<UsageError> birth_problem(const Pair& pair, const sim::Simulation& a,
                                        const sim::Simulation& b) {
  for (const auto& [side, simulation] : {std::pair{&pair.a, &a}, std::pair{&pair.b, &b}}) {
    const scene::Scene& scene = side->job.scene;
    if (scene.emitters.size() != 1) continue;
    const sim::seeding::Emitter& emitter = scene.emitters.front();
    const sim::seeding::EmitterStream alone(
        emitter, 0, scene.materials[setup::material_index(scene, emitter.material)], scene.seed,
        scene.solver.cell_size);
    if (!alone.is_undisturbed(simulation->emitter_states().front()))
      return no_same_snow(
          fmt::format("snow was in the way of emitter.{} by {} s of {}, so that its births came "
                      "later or elsewhere",
                      emitter.name, fixed_text(simulation->time(), 3), side->job.scene_file));
  }
  return std::nullopt;
}

std::optional<UsageError> grid_problem(const Pair& pair) {
  const double a = pair.a.job.scene.solver.cell_size, b = pair.b.job.scene.solver.cell_size;
  if (a == b) return std::nullopt;
  return UsageError(
      "--mode mass",
      fmt::format("solver.cell_size is {} m in A and {} m in B: their nodes lie in other places",
                  rough_text(a), rough_text(b)),
      "compare runs of one cell size, or use --mode beside, wipe or metrics");
}

}  // namespace neve::app::compare

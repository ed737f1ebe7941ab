#include "app/setup/plan.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "app/advice/suggest.h"
#include "app/output/picture_writer.h"
#include "app/scene/coarsen.h"
#include "app/scene/read.h"
#include "app/setup/caps.h"
#include "app/setup/mosaic_layout.h"
#include "app/setup/seed_scene.h"
#include "app/setup/snow_pieces.h"
#include "app/support/errors.h"
#include "app/support/machine.h"
#include "app/support/room.h"
#include "app/support/round_number.h"
#include "app/support/text.h"
#include "sim/dust_cost.h"
#include "sim/shapes/deforming_field.h"
#include "sim/shapes/distance_field.h"
#include "sim/shapes/height_field.h"
#include "sim/shapes/mesh_surface.h"
#include "sim/simulation.h"
#include "sim/types/number_text.h"

namespace neve::app::setup {

namespace {

constexpr std::array quality_names{"draft", "preview", "final"};

/// Address space of a software rasteriser; with less some drivers crash without a message.
constexpr std::uint64_t driver_address_space = 1'000'000'000;

/// Memory of a sample while it is drawn: colour, normal, depth and their copies on both sides.
/// Plain particles take 24 to 29, smoke with supersampling 50.
constexpr double bytes_per_sample = 36;
constexpr double bytes_per_pixel = 4;
/// Memory of the program and a software rasteriser before anything is drawn.
constexpr double program_bytes = 8e7;
/// The number of pictures of a frame up to which their texts are small beside their pixels.
constexpr std::size_t few_pictures = 20;

std::size_t picture_count(const scene::Scene& scene) {
  return scene.views.size() + scene.mosaics.size();
}

std::vector<scene::PictureSize> picture_sizes(const scene::Scene& scene) {
  std::vector<scene::PictureSize> sizes;
  for (const scene::View& view : scene.views) sizes.push_back(size_of(scene, view));
  for (const scene::Mosaic& mosaic : scene.mosaics)
    sizes.push_back(size_of(scene, mosaic, max_caption_lines));
  return sizes;
}

/// Pictures while they are drawn, all of a frame, and while they wait for the encoder.
double picture_memory(const scene::Scene& scene, Quality quality) {
  double drawn = 0, together = 0, waiting = 0;
  const double samples = supersampling(quality) * supersampling(quality);
  for (const scene::PictureSize& size : picture_sizes(scene)) {
    const double pixels = static_cast<double>(size.width) * size.height;
    drawn = std::max(drawn, pixels * samples * bytes_per_sample);
    together += pixels * bytes_per_pixel;
    waiting = std::max(waiting, pixels * bytes_per_pixel * (output::picture_queue_capacity + 1));
  }
  // Each picture has the whole scene in it.
  const std::size_t pictures = picture_count(scene);
  if (pictures > few_pictures)
    together +=
        1.2 * static_cast<double>(pictures) * static_cast<double>(scene::write_scene(scene).size());
  return drawn + together + waiting;
}

/// Pictures with passes: single precision while they are made, with every part of the light; then
/// all of a frame, those that wait for the encoder, and the file of one.
double channel_memory(const scene::Scene& scene, Quality quality, double channel_bytes) {
  if (!(channel_bytes > 0)) return 0;
  constexpr double light_bytes = 4 * 28, sample_bytes = 16;
  double drawn = 0, waiting = 0;
  const double samples = supersampling(quality) * supersampling(quality);
  for (const scene::View& view : scene.views) {
    const scene::PictureSize size = size_of(scene, view);
    const double pixels = static_cast<double>(size.width) * size.height;
    drawn = std::max(drawn, pixels * (samples * sample_bytes + light_bytes + 2 * channel_bytes));
    waiting += pixels * channel_bytes;
  }
  return drawn + waiting * (output::picture_queue_capacity + 2);
}

std::uint64_t whole_bytes(double bytes) {
  return bytes < 9e18 ? static_cast<std::uint64_t>(bytes)
                      : std::numeric_limits<std::uint64_t>::max();
}

std::string count_text(double count) {
  return count < 1e15 ? fixed_text(count, 0) : sim::number_text(count);
}

/// Cells so much larger that a limit is kept, as --set takes them.
/// @param excess  of the particles over those that the limit allows
std::string fitting_cells(const scene::Scene& scene, double excess, double coarsening) {
  const double cells = scene.solver.cell_size * std::cbrt(excess);
  return scene::setting_text("solver.cell_size", round_up(cells / coarsening) * coarsening,
                             coarsening) +
         " keeps it";
}

/// Advice on too much snow for a limit. Numbers that look like centimetres come first; a limit that
/// this machine has no memory for is never proposed.
/// @param raised  setting that raises the limit
std::string size_advice(const scene::Scene& scene, const Plan& plan, const std::string& raised,
                        double excess, double coarsening) {
  const std::string fitting = fitting_cells(scene, excess, coarsening);
  const double largest = largest_extent(scene);
  if (is_too_large(scene))
    return "the largest piece of snow is " + rough_text(largest) +
           " m across: lengths are in metres, and in centimetres it would be " +
           rough_text(0.01 * largest) + " m. If metres are right, " + fitting;
  const bool is_possible = plan.memory <= available_memory();
  return (is_possible ? "raise it with --set " + raised + ", or " : std::string()) + fitting;
}

void set_limits(const scene::Scene& scene, Plan& plan) {
  const Caps most = caps();
  const MemoryLimit memory = memory_limit(scene);
  plan.memory_limit = memory.bytes;
  plan.is_memory_capped = memory.is_capped;
  plan.particle_limit = static_cast<double>(scene.limits.particles);
  plan.are_particles_capped = most.particles < plan.particle_limit;
  if (plan.are_particles_capped) plan.particle_limit = most.particles;
}

/// @param excess  of what is needed over what is allowed
std::string cap_advice(const scene::Scene& scene, const char* flag, double excess,
                       double coarsening) {
  return std::string("a scene cannot raise it: give a larger ") + flag + ", or " +
         fitting_cells(scene, excess, coarsening);
}

[[noreturn]] void refuse(const std::string& what, const char* address, const std::string& hint) {
  throw LimitError("refused: " + what + "; " + hint, address, hint);
}

void check_particles(const scene::Scene& scene, const Plan& plan, double coarsening) {
  if (plan.particles <= plan.particle_limit) return;
  const double excess = plan.particles / plan.particle_limit;
  const std::string needed = "about " + count_text(plan.particles) + " particles are more than ";
  if (plan.are_particles_capped)
    refuse(needed + "--max-particles, " + count_text(plan.particle_limit), "--max-particles",
           cap_advice(scene, "--max-particles or NEVE_MAX_PARTICLES", excess, coarsening));
  refuse(needed + "limits.particles = " + std::to_string(scene.limits.particles),
         "limits.particles",
         size_advice(scene, plan, "limits.particles=" + count_text(std::ceil(plan.particles * 1.1)),
                     excess, coarsening));
}

/// Advises on pictures that need too much memory: snow in larger cells would change nothing.
std::string picture_advice(const scene::Scene& scene) {
  const std::size_t pictures = picture_count(scene);
  return (pictures > few_pictures ? "the scene's " + std::to_string(pictures) +
                                        " pictures a frame take most of it: draw some of them with "
                                        "--view, or smaller ones"
                                  : "its pictures take most of it: draw smaller ones") +
         std::string(" with output.size, or --size of neve render");
}

void check_memory(const scene::Scene& scene, const Plan& plan, double coarsening) {
  if (plan.memory <= plan.memory_limit) return;
  const double excess = static_cast<double>(plan.memory) / static_cast<double>(plan.memory_limit);
  const std::string needed = "about " + bytes_text(plan.memory) + " of memory are more than ";
  const bool is_of_pictures = 2 * plan.pictures > static_cast<double>(plan.memory);
  if (plan.is_memory_capped)
    refuse(needed + "--max-memory, " + bytes_text(plan.memory_limit), "--max-memory",
           is_of_pictures
               ? picture_advice(scene)
               : cap_advice(scene, "--max-memory or NEVE_MAX_MEMORY", excess, coarsening));
  refuse(needed + "limits.memory = " + bytes_text(plan.memory_limit) +
             (scene.limits.memory > 0 ? "" : ", 80 % of the available memory"),
         "limits.memory",
         is_of_pictures ? picture_advice(scene)
                        : size_advice(scene, plan, "limits.memory=" + std::to_string(plan.memory),
                                      excess, coarsening));
}

/// Lattice, mesh and attributes of the finest surface; the worker makes one at a time. 150 bytes
/// for each node that the snow fills at rest were measured on a snowball that had burst, at 0.3 and
/// 0.5 spacings from node to node; snow at rest takes a third. make_surface has the last word.
double surface_memory(const scene::Scene& scene, double particles) {
  double nodes = 0;
  for (const scene::Export& e : scene.exports)
    if (e.surface) nodes = std::max(nodes, particles / std::pow(e.surface_cell, 3));
  return 150 * nodes;
}

double field_memory(const sim::shapes::Mesh& mesh, double cell_size) {
  const auto surface = sim::shapes::mesh_surface(mesh);
  const double spacing = sim::shapes::field_spacing(*surface, cell_size);
  return sizeof(float) * std::min(sim::shapes::sample_counts(surface->bounds(), spacing).prod(),
                                  sim::shapes::DistanceField::max_samples);
}

/// Counts the distances around meshes, and heights of terrain. Files that cannot be read are
/// refused before.
double collider_memory(const scene::Scene& scene) {
  double bytes = 0;
  for (const scene::Collider& collider : scene.colliders)
    if (const auto* sequence = std::get_if<sim::shapes::MeshSequence>(&collider.shape.form))
      bytes +=
          sim::shapes::memory_of(*sim::shapes::deforming_mesh(*sequence), scene.solver.cell_size);
    else if (const auto* mesh = std::get_if<sim::shapes::Mesh>(&collider.shape.form))
      bytes += field_memory(*mesh, scene.solver.cell_size);
    else if (const auto* terrain = std::get_if<sim::shapes::Terrain>(&collider.shape.form))
      bytes += static_cast<double>(sim::shapes::height_field(*terrain)->grid().height.size()) *
               sizeof(float);
  return bytes;
}

/// Dust takes memory, and the air around it does; spray that feels the air takes that of air alone.
double dust_memory(const scene::Scene& scene) {
  sim::DustSettings dust = scene.solver.dust;
  if (!scene::dusty_material(scene)) {
    if (!scene::has_spray_drag(scene)) return 0;
    dust.particles = 0;
  }
  return sim::max_dust_memory(dust);
}

}  // namespace

MemoryLimit memory_limit(const scene::Scene& scene) {
  const std::uint64_t own = scene.limits.memory > 0 ? scene.limits.memory : usable_memory();
  const double cap = caps().memory;
  if (cap < static_cast<double>(own)) return {static_cast<std::uint64_t>(cap), true};
  return {own, false};
}

void count_on(std::uint64_t bytes, const scene::Scene& scene, Plan& plan) {
  if (scene.limits.memory > 0 || plan.is_memory_capped) return;
  plan.memory_limit += bytes;
  const double cap = caps().memory;
  if (cap < static_cast<double>(plan.memory_limit))
    plan.memory_limit = static_cast<std::uint64_t>(cap);
}

const char* name(Quality quality) {
  return quality_names[static_cast<std::size_t>(quality)];
}

Quality quality_named(const std::string& name) {
  const auto found = std::find(quality_names.begin(), quality_names.end(), name);
  if (found == quality_names.end()) {
    const std::vector<std::string> names(quality_names.begin(), quality_names.end());
    const std::string question = advice::suggest(name, {"quality", names});
    throw UsageError("--quality", "unknown quality \"" + name + "\"",
                     question + (question.empty() ? "" : " ") + "expected draft, preview or final");
  }
  return static_cast<Quality>(found - quality_names.begin());
}

int supersampling(Quality quality) {
  return quality == Quality::final ? 2 : 1;
}

void check_picture(const std::string& what, const scene::PictureSize& size, int largest,
                   const std::string& place, const std::string& advice) {
  if (std::max(size.width, size.height) > largest)
    refuse(what + " is " + std::to_string(size.width) + "x" + std::to_string(size.height) +
               " pixels, and this backend draws at most " + std::to_string(largest) + " a side",
           place.c_str(), advice);
  require_room(program_bytes + 1.0 * size.width * size.height * bytes_per_sample, what, place,
               advice);
}

scene::PictureSize size_of(const scene::Scene& scene, const scene::View& view) {
  return view.size.value_or(scene.size);
}

FrameRange numbers_of(const scene::Scene& scene, const FrameRange& frames) {
  return {scene::number_of(scene, frames.first), scene::number_of(scene, frames.last)};
}

FrameRange frames_of(const scene::Scene& scene, const FrameRange& numbers) {
  const int start = scene::number_of(scene, 0);
  const int first = numbers.first == FrameRange::from_start ? start : numbers.first;
  if (first < start || numbers.last < first)
    throw UsageError("--frames",
                     "the scene begins with frame " + std::to_string(start) + ", not " +
                         std::to_string(std::min(first, numbers.last)),
                     "expected frames from " + std::to_string(start) + " to " +
                         std::to_string(scene::number_of(scene, scene::last_frame(scene))));
  return {scene::frame_of(scene, first), scene::frame_of(scene, numbers.last)};
}

Plan make_plan(const scene::Scene& scene, const FrameRange& frames, Quality quality, int threads,
               double channel_bytes) {
  Plan plan;
  plan.frames = frames;
  plan.first_number = scene::number_of(scene, 0);
  const double h = scene.solver.cell_size;
  double cells = 0;
  for (const sim::seeding::Body& body : scene.bodies) {
    const sim::seeding::SeedingPlan seeding = sim::seeding::plan_seeding(body, h);
    const double filled = seeding.volume / (h * h * h);
    plan.volume += seeding.volume;
    cells += filled;
    const bool is_listed = std::holds_alternative<sim::shapes::Points>(body.shape.form);
    plan.particles += std::max(static_cast<double>(seeding.particle_count),
                               is_listed ? 0.0 : std::floor(filled * body.particles_per_cell));
  }
  const double time = frames.last / scene.fps;
  for (const sim::seeding::Emitter& emitter : scene.emitters) {
    const sim::Material& material = scene.materials[material_index(scene, emitter.material)];
    const auto count = static_cast<double>(sim::seeding::count_emitted(emitter, material, h, time));
    plan.emitted += count;
    cells += count / emitter.particles_per_cell;
    plan.volume += count / emitter.particles_per_cell * (h * h * h);
  }
  plan.particles += plan.emitted;
  const double per_cell = cells > 0 ? std::max(1.0, plan.particles / cells) : 8.0;
  // Beyond any machine's memory the exact figure does not matter; this keeps it a whole number.
  const double counted = std::min(plan.particles, 1e15);
  const auto simulated = static_cast<double>(
      sim::estimate_memory(static_cast<std::size_t>(counted), per_cell, scene.solver, threads));
  // The plain arrays that go in at the start and come out for every picture.
  const double arrays =
      counted * static_cast<double>(sizeof(sim::Mat3d) * 3 + sizeof(sim::Vec3d) * 3);
  // States of exports wait for the worker as pictures do, and are text or bytes while it writes.
  const double exported = scene.exports.empty() ? 0 : arrays * (output::picture_queue_capacity + 2);
  plan.pictures = picture_memory(scene, quality) + channel_memory(scene, quality, channel_bytes);
  plan.memory = whole_bytes(simulated + arrays + exported + surface_memory(scene, counted) +
                            collider_memory(scene) + dust_memory(scene) + plan.pictures);
  set_limits(scene, plan);
  for (const scene::PictureSize& size : picture_sizes(scene)) {
    const double samples = supersampling(quality) * supersampling(quality);
    plan.largest_picture =
        std::max(plan.largest_picture, static_cast<double>(size.width) * size.height * samples);
  }
  return plan;
}

void check_limits(const scene::Scene& scene, const Plan& plan, double coarsening) {
  check_particles(scene, plan, coarsening);
  if (plan.largest_picture > static_cast<double>(scene.limits.pixels))
    refuse("a picture of " + count_text(plan.largest_picture) +
               " pixels (supersamples included) is more than limits.pixels = " +
               std::to_string(scene.limits.pixels),
           "limits.pixels",
           "raise it with --set limits.pixels=" + count_text(plan.largest_picture) +
               ", or draw smaller pictures with --size");
  check_memory(scene, plan, coarsening);
  if (address_space_limit() < plan.memory + driver_address_space)
    refuse("about " + bytes_text(plan.memory + driver_address_space) +
               " of address space are needed, including drivers; ulimit -v allows " +
               bytes_text(address_space_limit()),
           "", "raise it with ulimit -v unlimited");
}

Json to_json(const Plan& plan) {
  Json json;
  json["particles"] = count_json(plan.particles);
  json["emitted_particles"] = count_json(plan.emitted);
  json["memory_bytes"] = plan.memory;
  json["memory_limit_bytes"] = plan.memory_limit;
  json["particle_limit"] = count_json(plan.particle_limit);
  json["largest_picture_pixels"] = count_json(plan.largest_picture);
  json["first_frame"] = plan.first_number + plan.frames.first;
  json["last_frame"] = plan.first_number + plan.frames.last;
  return json;
}

}  // namespace neve::app::setup

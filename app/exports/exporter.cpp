#include "app/exports/exporter.h"

#include <fmt/core.h>

#include <algorithm>
#include <stdexcept>

#include "app/exports/surface_table.h"
#include "app/output/atomic_file.h"
#include "app/output/report_json.h"
#include "app/output/temporary.h"
#include "app/picture/motion.h"
#include "app/scene/flat.h"
#include "app/scene/names.h"
#include "app/scene/override.h"
#include "app/scene/read.h"
#include "app/scene/toml/value.h"
#include "app/support/text.h"

namespace neve::app::exports {

namespace {

namespace fs = std::filesystem;

/// @param scale  units of the files per metre: lengths and speeds are scaled, all else is in SI
/// units
Json attributes_json(const Table& columns, double scale) {
  const auto unit_of = [&](const Column& column) {
    const std::string unit = column.unit;
    const bool is_scaled = scale != 1 && (unit == "m" || unit == "m/s");
    return is_scaled ? scene::toml::number_text(1 / scale) + " " + unit : unit;
  };
  Json list = Json::array();
  for (const Column& column : columns.columns)
    list.push_back({{"name", column.name},
                    {"type", type_name(column)},
                    {"components", column.components},
                    {"unit", unit_of(column)}});
  return list;
}

/// Lengths in metres of the simulation.
Json surface_json(const scene::Scene& scene, const scene::Export& spec) {
  const double spacing = particle_spacing(scene);
  return {{"cell", spec.surface_cell * spacing},
          {"smoothing", spec.surface_smoothing * spacing},
          {"smallest_piece", spec.smallest_piece}};
}

/// Whether all are where the scene alone says: not where they move by themselves, came later,
/// waited in steps that skip colliders, or were changed while they moved.
bool are_as_in(const scene::Scene& scene, const std::vector<PlacedShape>& colliders, double time) {
  return std::ranges::equal(
      colliders, placed_at(scene.colliders, time), [](const PlacedShape& a, const PlacedShape& b) {
        return a.collider == b.collider && a.shape == b.shape && a.time == b.time &&
               a.pose.point == b.pose.point && a.pose.rotation == b.pose.rotation;
      });
}

/// Writes exact numbers: a run that is resumed writes the same stage.
Json places_json(const Sample& sample) {
  Json list = Json::array();
  for (const PlacedShape& placed : sample.colliders) {
    list.push_back({{"collider", placed.collider},
                    {"time", placed.time},
                    {"position", output::vector_json(placed.pose.point)},
                    {"angular_velocity", output::vector_json(placed.pose.angular_velocity)},
                    {"rotation", output::matrix_json(placed.pose.rotation)}});
    if (placed.shape > 0) list.back()["shape"] = placed.shape;
  }
  return list;
}

/// Reads a shape of places_json(). @throws std::exception
PlacedShape placed_shape(const Json& json) {
  PlacedShape placed{json.at("collider").get<std::string>(), {}, json.at("time").get<double>()};
  placed.pose.point = output::vector_of(json.at("position"));
  for (int row = 0; row < 3; ++row)
    placed.pose.rotation.row(row) =
        output::vector_of(json.at("rotation").at(static_cast<std::size_t>(row)));
  if (json.contains("angular_velocity"))
    placed.pose.angular_velocity = output::vector_of(json.at("angular_velocity"));
  if (json.contains("shape")) placed.shape = whole_number<std::size_t>(json.at("shape"));
  if (!placed.pose.point.allFinite() || !placed.pose.rotation.allFinite())
    throw std::runtime_error("collider " + placed.collider + " of an export has no finite place");
  return placed;
}

/// Adds what a list of files or frames says of a sample, beside its number and its time.
void add_places(const Sample& sample, Json& json) {
  if (sample.is_elsewhere) json["colliders"] = places_json(sample);
  for (const auto& [name, moved] : sample.followed)
    json["followed"][name] = output::vector_json(moved);
  if (sample.snow)
    json["snow"] = {output::vector_json(sample.snow->min), output::vector_json(sample.snow->max)};
}

/// Reads a sample with the places of add_places(). @throws std::exception
Sample sample_of(const Json& json, const scene::Scene& scene) {
  const double time = json.at("time").get<double>();
  Sample sample{whole_number<int>(json.at("number")), time, placed_at(scene.colliders, time)};
  sample.is_elsewhere = json.contains("colliders");
  if (sample.is_elsewhere) {
    sample.colliders.clear();
    for (const Json& placed : json.at("colliders"))
      sample.colliders.push_back(placed_shape(placed));
  }
  const Json followed = json.value("followed", Json::object());
  for (const auto& [name, moved] : followed.items())
    sample.followed[name] = output::vector_of(moved);
  if (json.contains("snow"))
    sample.snow = {output::vector_of(json.at("snow").at(0)),
                   output::vector_of(json.at("snow").at(1))};
  return sample;
}

bool has_shape(const scene::Collider& collider, const sim::shapes::Shape& shape) {
  scene::Scene one, other;
  one.colliders = other.colliders = {collider};
  other.colliders.front().shape = shape;
  return scene::differences(one, other).empty();
}

/// "ADDRESS=VALUE" of all that gives a scene this shape of a collider, or this collider.
Json changes_to(const scene::Scene& scene, const scene::Collider& collider) {
  scene::Scene other = scene;
  const auto place = std::ranges::find(other.colliders, collider.name, &scene::Collider::name);
  if (place == other.colliders.end())
    other.colliders.push_back(collider);
  else
    place->shape = collider.shape;
  Json list = Json::array();
  for (const scene::Difference& part : scene::differences(scene, other))
    list.push_back(part.address + "=" +
                   (part.after ? scene::toml::toml_literal(*part.after) : "none"));
  return list;
}

/// Bodies that snow moves, and colliders that were changed, follow a curve, or wait.
bool may_move_otherwise(const scene::Scene& scene, const std::vector<scene::LiveChange>& changes) {
  const auto is_of_collider = [](const std::string& address) {
    return address.starts_with("collider.");
  };
  return scene::has_moving_bodies(scene) ||
         std::ranges::any_of(changes, is_of_collider, &scene::LiveChange::address) ||
         std::ranges::any_of(scene.curves, is_of_collider, &scene::Curve::parameter) ||
         scene.solver.skips(sim::Stage::colliders);
}

/// Around all places that are finite; nothing where there are none.
std::optional<setup::Box> box_around(const std::vector<sim::Vec3d>& places) {
  setup::Box box;
  for (const sim::Vec3d& x : places)
    if (x.allFinite()) box.add(x);
  return box.max.x() >= box.min.x() ? std::optional(box) : std::nullopt;
}

/// Puts a sample in the order of the numbers, in the place of the one with its number.
void put(std::vector<Sample>& samples, Sample sample) {
  const auto at = std::ranges::lower_bound(samples, sample.number, {}, &Sample::number);
  if (at != samples.end() && at->number == sample.number)
    *at = std::move(sample);
  else
    samples.insert(at, std::move(sample));
}

}  // namespace

Exporter::Exporter(const scene::Scene& scene, fs::path folder, const setup::SeededScene& seeded,
                   const std::vector<scene::LiveChange>& changes)
    : scene_(scene),
      colliders_(scene.colliders),
      folder_(std::move(folder)),
      seeded_(seeded),
      origins_(scene, seeded.body_end),
      carried_(scene, seeded.body_end),
      moves_otherwise_(may_move_otherwise(scene, changes)) {
  for (const StageCamera& camera : stage_cameras(scene))
    if (!camera.settings.follow.empty()) follows_.insert(camera.settings.follow);
  output::remove_abandoned(folder_);
  for (const scene::Export& spec : scene.exports) {
    jobs_.push_back({spec, empty_table(scene, spec, carried_), {}, {}});
    output::remove_abandoned(folder_ / scene::folder_of(spec));
  }
}

std::vector<std::string> Exporter::files_of(int frame) const {
  std::vector<std::string> files;
  for (const Job& job : jobs_)
    if (frame % job.spec.every == 0)
      files.push_back(scene::folder_of(job.spec) + "/" +
                      file_name(job.spec, scene::number_of(scene_, frame)));
  return files;
}

std::vector<Exporter::Work> Exporter::add(const std::vector<scene::Collider>& colliders,
                                          const sim::Simulation& simulation, int number,
                                          bool is_frame) {
  const auto is_due = [&](const Job& job) {
    return !is_frame || scene::frame_of(scene_, number) % job.spec.every == 0;
  };
  std::vector<scene::Export> due;
  for (const Job& job : jobs_)
    if (is_due(job)) due.push_back(job.spec);
  std::vector<Work> works;
  if (due.empty()) return works;
  const std::shared_ptr<const State> state = read_state(due, origins_, colliders, simulation);
  for (Job& job : jobs_)
    if (is_due(job)) {
      works.push_back(work(job, state, colliders, number));
      if (warning_.empty()) warning_ = unknown_ages(job.spec, *state);
    }
  return works;
}

void Exporter::add_between(const std::vector<scene::Collider>& colliders,
                           const sim::Simulation& simulation, int number, bool is_frame) {
  const auto has_no_file = [&](const Job& job) {
    return is_stage(job) && !(is_frame && scene::frame_of(scene_, number) % job.spec.every == 0);
  };
  if (std::ranges::none_of(jobs_, has_no_file)) return;
  const double time = simulation.time();
  Sample sample{number, time, placed_at(colliders, time)};
  note_shapes(colliders, sample);
  sample.followed = followed(simulation.particles(), time, colliders);
  const bool says_nothing = !sample.is_elsewhere && sample.followed.empty() && !moves_otherwise_;
  // Once something was elsewhere, a frame that is not listed would be taken for that, too.
  for (Job& job : jobs_)
    if (has_no_file(job) && !(says_nothing && job.between.empty())) put(job.between, sample);
}

std::string Exporter::take_warning() {
  const bool is_new = !warning_.empty() && !is_told_;
  is_told_ = is_told_ || is_new;
  return is_new ? warning_ : "";
}

bool Exporter::has_stage() const {
  return std::ranges::any_of(jobs_, is_stage);
}

bool Exporter::lacks_places(int frame) const {
  if (follows_.empty() && !moves_otherwise_) return false;
  const auto has = [number = scene::number_of(scene_, frame)](const std::vector<Sample>& samples) {
    return std::ranges::find(samples, number, &Sample::number) != samples.end();
  };
  return std::ranges::any_of(jobs_, [&](const Job& job) {
    return is_stage(job) && !has(job.samples) && !has(job.between);
  });
}

bool Exporter::is_stage(const Job& job) {
  return job.spec.format == scene::ExportFormat::usda;
}

std::map<std::string, sim::Vec3d> Exporter::followed(
    const sim::ParticleArrays& particles, double time,
    const std::vector<scene::Collider>& colliders) const {
  std::map<std::string, sim::Vec3d> moved;
  for (const std::string& name : follows_)
    moved[name] = picture::followed_by(name, scene_, colliders, seeded_, particles, time);
  return moved;
}

/// Some come and go, and some change their shape, while a run is made.
void Exporter::note_shapes(const std::vector<scene::Collider>& colliders, Sample& sample) {
  for (const scene::Collider& collider : colliders)
    for (PlacedShape& placed : sample.colliders)
      if (placed.collider == collider.name) placed.shape = shape_of(collider);
  sample.is_elsewhere = !are_as_in(scene_, sample.colliders, sample.time);
}

std::size_t Exporter::shape_of(const scene::Collider& collider) {
  std::size_t number = 0;
  for (const scene::Collider& known : colliders_) {
    if (known.name != collider.name) continue;
    if (has_shape(known, collider.shape)) return number;
    ++number;
  }
  colliders_.push_back(collider);
  later_shapes_.push_back({{"collider", collider.name}, {"set", changes_to(scene_, collider)}});
  return number;
}

void Exporter::take_later_shapes(const Json& list) {
  for (const Json& later : list) {
    std::vector<scene::Override> changes;
    for (const Json& change : later.at("set"))
      changes.push_back(scene::parse_override(change.get<std::string>()));
    const scene::Scene scene = scene::apply(scene_, changes, "a collider of an export");
    const auto collider = std::ranges::find(
        scene.colliders, later.at("collider").get<std::string>(), &scene::Collider::name);
    if (collider == scene.colliders.end())
      throw std::runtime_error("an export has the shape of a collider that does not exist");
    shape_of(*collider);
  }
}

Exporter::Work Exporter::work(Job& job, std::shared_ptr<const State> state,
                              const std::vector<scene::Collider>& colliders, int number) {
  const scene::Export& spec = job.spec;
  // A frame that is made again keeps its place.
  Sample sample{number, state->time, state->colliders};
  sample.hash = state->hash;
  if (is_stage(job)) {
    note_shapes(colliders, sample);
    sample.followed = followed(state->particles, state->time, colliders);
    sample.snow = box_around(spec.dust ? state->dust.x : state->particles.x);
  }
  put(job.samples, std::move(sample));
  const bool has_pvd = series_name(spec).ends_with(".pvd");
  std::string series = has_pvd ? encode_pvd(spec, job.samples) : std::string();
  return [this, &spec, state = std::move(state), number, series = std::move(series)] {
    const std::shared_ptr<const State> shown = spec.dust ? state_of_dust(*state) : state;
    const Table table = make_table(scene_, spec, origins_, carried_, *shown);
    check_capacity(spec, table, static_cast<double>(table.rows));
    const fs::path folder = folder_ / scene::folder_of(spec);
    output::make_own_folder(folder);
    std::vector<output::WrittenFile> written{output::write_hashed(
        folder / file_name(spec, number), encode({scene_, spec, *shown, table}))};
    if (!series.empty())
      written.push_back(output::write_hashed(folder_ / series_name(spec), series));
    return written;
  };
}

std::vector<output::WrittenFile> Exporter::finish() const {
  std::vector<output::WrittenFile> written;
  for (const Job& job : jobs_) {
    const scene::Export& spec = job.spec;
    const std::string series = series_name(spec);
    if (job.samples.empty()) continue;
    if (series.ends_with(".pvd"))
      written.push_back(output::write_hashed(folder_ / series, encode_pvd(spec, job.samples)));
    if (spec.format != scene::ExportFormat::usda) continue;
    written.push_back(output::write_hashed(folder_ / scene::folder_of(spec) / "manifest.usda",
                                           encode_manifest(scene_, spec, job.columns)));
    written.push_back(output::write_hashed(
        folder_ / series,
        encode_stage(scene_, colliders_, spec, job.columns, job.samples, job.between)));
  }
  return written;
}

void Exporter::resume(const Json& list, int last_number) {
  for (Job& job : jobs_) {
    const std::string folder = scene::folder_of(job.spec);
    for (const Json& e : list) {
      if (e.value("name", "") != folder) continue;
      take_later_shapes(e.value("shapes", Json::array()));
      for (const Json& file : e.at("files"))
        if (whole_number<int>(file.at("number")) <= last_number) {
          Sample sample = sample_of(file, scene_);
          sample.hash = std::stoull(file.at("state_hash").get<std::string>(), nullptr, 16);
          put(job.samples, std::move(sample));
        }
      for (const Json& frame : e.value("frames_between", Json::array()))
        if (whole_number<int>(frame.at("number")) <= last_number)
          put(job.between, sample_of(frame, scene_));
    }
  }
}

Json Exporter::to_json(const std::string& below) const {
  Json list = Json::array();
  for (const Job& job : jobs_) {
    const scene::Export& spec = job.spec;
    const std::string series = series_name(spec), folder = below + scene::folder_of(spec) + "/";
    Json json = {
        {"name", scene::folder_of(spec)},
        {"format", scene::name(spec.format)},
        {"up", scene::name(spec.up)},
        {"scale", spec.scale},
        {"attributes", has_grid(spec) ? Json::array() : attributes_json(job.columns, spec.scale)}};
    if (spec.dust) json["dust"] = true;
    if (!spec.bodies.empty()) json["bodies"] = spec.bodies;
    json["surface"] = spec.surface ? surface_json(scene_, spec) : Json();
    json["series"] = series.empty() ? Json() : Json(below + series);
    json["files"] = Json::array();
    for (const Sample& sample : job.samples) {
      json["files"].push_back({{"file", folder + file_name(spec, sample.number)},
                               {"number", sample.number},
                               {"frame", number_or_null(time_in_frames(scene_, sample.time))},
                               {"time", number_or_null(sample.time)},
                               {"state_hash", fmt::format("{:016x}", sample.hash)}});
      add_places(sample, json["files"].back());
    }
    if (is_stage(job) && !later_shapes_.empty()) json["shapes"] = later_shapes_;
    for (const Sample& sample : job.between) {
      Json frame{{"number", sample.number}, {"time", number_or_null(sample.time)}};
      add_places(sample, frame);
      json["frames_between"].push_back(std::move(frame));
    }
    list.push_back(std::move(json));
  }
  return list;
}

}  // namespace neve::app::exports

#include "app/picture/frame_builder.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <utility>

#include "app/picture/attributes.h"
#include "app/picture/collider_looks.h"
#include "app/picture/cut.h"
#include "app/picture/legends.h"
#include "app/picture/motion.h"
#include "app/picture/scale_bar.h"
#include "app/picture/slice.h"
#include "app/picture/smoke_layer.h"
#include "app/picture/snow_volume.h"
#include "app/picture/stage_look.h"
#include "app/picture/to_float.h"
#include "app/picture/wires.h"
#include "app/scene/burn_in.h"
#include "app/scene/coarsen.h"
#include "app/scene/flat.h"
#include "app/scene/override.h"
#include "app/scene/presets.h"
#include "app/setup/camera_path.h"
#include "app/setup/curves.h"
#include "app/support/film_rate.h"
#include "app/support/round_number.h"
#include "app/support/text.h"
#include "render/smoke_legend.h"
#include "sim/laws/law.h"

namespace neve::app::picture {

namespace {

/// Radius of a drawn particle over the mean distance of packed ones: neighbours overlap, so that
/// snow has a surface.
constexpr double radius_share = 0.6;
/// Particle spacings beyond a cut within which particles shape the surface before it: the reach of
/// its kernel.
constexpr double reach_beyond_cut = 3;
constexpr std::size_t max_override_lines = 6;
/// Rings around more particles than these hide the snow inside.
constexpr std::size_t max_marks = 16;

const scene::CameraSettings& settings_of(const scene::Scene& scene, const scene::View& view) {
  static const scene::CameraSettings usual;
  return view.camera ? *view.camera : scene.camera ? *scene.camera : usual;
}

render::Camera to_camera(const setup::CameraPlace& place, const scene::CameraSettings& settings) {
  return {to_float(place.eye), to_float(place.target), to_float(settings.up),
          static_cast<float>(place.fov)};
}

/// Pixels that a metre on a plane has in the direction in which it is shortest.
double pixels_on(const SlicePlane& plane, const render::Frame& frame) {
  const Vec3f ahead = normalized(frame.camera.target - frame.camera.eye);
  const double slant = std::abs(plane.normal.dot(sim::Vec3d(ahead.x, ahead.y, ahead.z)));
  return pixels_per_metre(frame, to_float(plane.point)) * std::max(slant, 0.1);
}

std::string grouped(std::size_t count) {
  std::string digits = std::to_string(count);
  for (auto place = static_cast<std::ptrdiff_t>(digits.size()) - 3; place > 0; place -= 3)
    digits.insert(static_cast<std::size_t>(place), 1, ' ');
  return digits;
}

/// "347 steps, dt 0.00012 s (acoustic)": the smallest dt and the limit that ruled most; and how far
/// semi-implicit steps were solved at worst.
std::string steps_text(const sim::AdvanceReport& advance) {
  std::string text = grouped(advance.steps) + (advance.steps == 1 ? " step" : " steps") + ", dt " +
                     rough_text(advance.dt_min) + " s (" + sim::name(advance.limit()) + ")";
  if (!advance.solve) return text;
  if (std::isfinite(advance.solve->residual))
    text += ", solved in " + std::to_string(advance.solve->iterations) + " to " +
            rough_text(advance.solve->residual);
  if (advance.solve->given_up > 0)
    text += ", " + grouped(advance.solve->given_up) + " solves given up";
  return text;
}

/// Returns the words of a caption on what the material bears.
std::string strength_line(const sim::Material& m) {
  const sim::laws::Law& law = sim::laws::of(m);
  std::vector<double> numbers;
  std::string names;  // those that are not the usual ones
  for (const sim::laws::Parameter& p : law.parameters)
    if (p.names.empty())
      numbers.push_back(p.of(m));
    else if (p.of(m) != p.own_default)
      names += std::string(", ") + p.name_of(m).name() + " " + p.key;
  return filled(law.caption, numbers) + names;
}

}  // namespace

FrameBuilder::FrameBuilder(const scene::Scene& scene, const setup::SeededScene& seeded,
                           PictureOptions options)
    : scene_(scene), seeded_(seeded), options_(std::move(options)) {}

render::Frame FrameBuilder::build(const scene::View& wanted, const Snapshot& snapshot,
                                  std::optional<render::Points> points) const {
  const scene::View view = with_ranges_of_frame(wanted, snapshot.fields);
  render::Frame frame;
  const scene::PictureSize size = setup::size_of(scene_, view);
  frame.width = size.width;
  frame.height = size.height;
  frame.supersampling = setup::supersampling(options_.quality);
  frame.has_smooth_edges = frame.supersampling == 1;
  frame.has_snow_surface = scene::has_layer(view, scene::Layer::snow) && !snapshot.stage_change;
  frame.is_transparent = scene::background_of(scene_, view) == scene::Background::transparent;
  const scene::CameraSettings& camera = settings_of(scene_, view);
  frame.camera = camera_of(scene_, view, seeded_, snapshot);
  frame.light = {to_float(scene_.light.direction), static_cast<float>(scene_.light.intensity),
                 static_cast<float>(scene_.light.ambient)};
  // The camera at the start: grid lines do not change while the camera moves.
  const setup::CameraPlace first = setup::camera_at(camera, 0, scene::duration(scene_));
  const double spacing = round_down(0.1 * (first.eye - first.target).norm());
  add_colliders(scene_, view, snapshot.time, static_cast<float>(spacing), frame);
  const std::optional<StageLook> look = stage_look(view, snapshot);
  const bool is_of_stage = look && shows_particles_of(view, *snapshot.stage_change);
  if (points)
    frame.points = std::move(*points);
  else if (is_of_stage || scene::shows_particles(view))
    add_points(view, snapshot, look, frame);
  if (frame.has_snow_surface) find_solids_below(scene_, view, snapshot.time, frame.points);
  add_grid(view, snapshot, frame);
  if (scene::has_layer(view, scene::Layer::scale))
    add_scale_bar(view, snapshot, plane_of(scene_, view, seeded_, snapshot), frame);
  if (scene::has_layer(view, scene::Layer::legend))
    frame.legends = legends_of(scene_, is_of_stage ? without_snow(view) : view, frame);
  if (is_of_stage) add_stage_change(snapshot, *look, frame);
  if (scene::has_layer(view, scene::Layer::bounds)) add_bounds(snapshot, frame);
  if (scene::has_layer(view, scene::Layer::plots))
    frame.plots = make_plots(view.plots, !scene_.colliders.empty(), snapshot.history, snapshot.time,
                             1 / scene_.fps, std::max(scene::duration(scene_), snapshot.time));
  frame.caption = words(view, snapshot);
  if (scene::has_burn_in(scene_.burn_in))
    frame.edge_words = scene::burnt_in(
        scene_, {snapshot.frame, snapshot.time, view.name,
                 joined(scene::change_lines(options_.overrides, snapshot.changes), ", ")});
  return frame;
}

std::vector<std::string> FrameBuilder::incident_lines(const sim::Divergence& divergence,
                                                      const health::Diagnosis& diagnosis) {
  return {"diverged at step " + std::to_string(divergence.step) + ", rule " + divergence.rule,
          "cause: " + std::string(scene::name(diagnosis.cause)), diagnosis.evidence,
          "try: " + diagnosis.remedy};
}

render::Frame FrameBuilder::build_incident(const scene::View& view, const Snapshot& snapshot,
                                           const sim::Divergence& divergence,
                                           const health::Diagnosis& diagnosis,
                                           std::optional<render::Points> points) const {
  render::Frame frame = build(view, snapshot, std::move(points));
  // If only a plane is drawn, rings around particles before or behind it point at nothing.
  const bool is_plane = scene::shows_slice(view) && !scene::shows_particles(view) &&
                        !scene::has_layer(view, scene::Layer::smoke);
  const SlicePlane plane = plane_of(scene_, view, seeded_, snapshot);
  const auto is_shown = [&](const sim::Vec3d& x) {
    return !is_plane || std::abs((x - plane.point).dot(plane.normal)) <= scene_.solver.cell_size;
  };
  for (const std::uint32_t p : divergence.culprits) {
    if (frame.marks.size() == max_marks) break;
    const auto index = snapshot.particles.index_of(p);
    if (!index) continue;
    const sim::Vec3d& x = snapshot.particles.x[*index];
    if (x.allFinite() && is_shown(x)) frame.marks.push_back(to_float(x));
  }
  if (!frame.caption.empty())
    for (std::string& line : incident_lines(divergence, diagnosis))
      frame.caption.push_back(std::move(line));
  return frame;
}

void FrameBuilder::add_points(const scene::View& view, const Snapshot& snapshot,
                              const std::optional<StageLook>& look, render::Frame& frame) const {
  const scene::ParticleStyle& style = view.particles;
  const scene::Range range = look ? scene::Range{0, look->largest > 0 ? look->largest : 1}
                                  : style.range.value_or(scene::Range{});
  const std::vector<double> values =
      look ? snapshot.stage_change->magnitude : attribute_values(scene_, style.color_by, snapshot);
  render::Points& points = frame.points;
  points.spacing = static_cast<float>(seeded_.spacing);
  points.radius = static_cast<float>(radius_share * seeded_.spacing);
  points.colormap = look ? render::ColorMap::viridis : style.colormap;
  points.range_min = static_cast<float>(range.min);
  points.range_max = static_cast<float>(range.max);
  // Hidden particles cast no shadow either: the cut is lit like a surface, so its colours are
  // readable.
  const Cut cut(view.clip, snapshot.particles.x);
  const bool is_surface = scene::has_layer(view, scene::Layer::snow);
  points.position.edit().reserve(snapshot.particles.x.size());
  points.id.edit().reserve(snapshot.particles.x.size());
  points.value.edit().reserve(values.size());
  const auto take = [&](std::size_t p, auto& list) {
    list.position.edit().push_back(to_float(snapshot.particles.x[p]));
    list.id.edit().push_back(snapshot.particles.id_of(p));
    if (is_surface) {
      list.volume.edit().push_back(static_cast<float>(snow_volume(scene_, snapshot.particles, p)));
      list.turn.edit().push_back(turn_of(snapshot.particles.F_E[p]));
    }
    if (!values.empty())
      list.value.edit().push_back(
          static_cast<float>(std::isfinite(values[p]) ? values[p] : range.max));
  };
  if (is_surface && view.clip)
    points.cut = {to_float(cut.point()),
                  to_float(sim::Vec3d(cut.normal().normalized())),
                  {},
                  {},
                  {},
                  {},
                  {},
                  {}};
  for (std::size_t p = 0; p < snapshot.particles.x.size(); ++p) {
    // A diverged state is drawn too, as far as it can be.
    const sim::Vec3d& x = snapshot.particles.x[p];
    if (!x.allFinite()) continue;
    if (cut.removes(x)) {
      if (points.cut && cut.distance(x) < reach_beyond_cut * seeded_.spacing) take(p, *points.cut);
    } else if (!look || !look->cut.removes(x)) {
      take(p, points);
    }
  }
  // Snow beyond the plane only shapes the surface of the snow before it.
  if (points.position.empty()) points.cut.reset();
}

void FrameBuilder::add_grid(const scene::View& view, const Snapshot& snapshot,
                            render::Frame& frame) const {
  const FieldSamples& fields = snapshot.fields;
  if (fields.lattice && scene::has_layer(view, scene::Layer::blocks))
    frame.lines.push_back(block_lines(*fields.lattice, fields.density));
  if (scene::has_layer(view, scene::Layer::smoke) && !snapshot.stage_change)
    add_smoke(scene_, view, fields, frame);
  if (scene::has_layer(view, scene::Layer::dust) && snapshot.dust && !snapshot.stage_change)
    add_dust(view, *snapshot.dust, frame);
  const SlicePlane plane = plane_of(scene_, view, seeded_, snapshot);
  add_slice(scene_, view, snapshot, plane, {pixels_on(plane, frame), seeded_.spacing}, frame);
  if (!frame.footnote.empty() && !view.slice.follow.empty() &&
      !centre_of(view.slice.follow, scene_, scene_.colliders, seeded_, snapshot.particles,
                 snapshot.time))
    frame.footnote += ", " + view.slice.follow + " is gone" +
                      (std::ranges::any_of(scene_.bodies,
                                           [&](const sim::seeding::Body& body) {
                                             return body.name == view.slice.follow;
                                           })
                           ? ": the plane is where it began"
                           : "");
  const bool has_words =
      scene::has_layer(view, scene::Layer::legend) || scene::has_layer(view, scene::Layer::caption);
  const std::size_t strays = has_words ? render::smoke_left_out(frame.smoke) : 0;
  if (strays > 0)
    frame.footnote += fmt::format("{}{} of {} {} far from the rest is not drawn",
                                  frame.footnote.empty() ? "" : ", ",
                                  scene::has_layer(view, scene::Layer::dust) ? "dust" : "smoke",
                                  strays, strays == 1 ? "block" : "blocks");
  if (scene::has_layer(view, scene::Layer::extremes))
    mark_extremes(view, fields, snapshot.advance.dt_max, frame);
}

SlicePlane plane_of(const scene::Scene& scene, const scene::View& view,
                    const setup::SeededScene& seeded, const Snapshot& snapshot) {
  return slice_plane(view.slice, snapshot.time,
                     followed_by(view.slice.follow, scene, scene.colliders, seeded,
                                 snapshot.particles, snapshot.time));
}

/// The scene's camera decides on the side, not one that somebody turns: it must not change.
std::optional<StageLook> FrameBuilder::stage_look(const scene::View& view,
                                                  const Snapshot& snapshot) const {
  if (!snapshot.stage_change) return std::nullopt;
  const scene::CameraSettings& camera =
      scene_.camera && scene_.camera->eye ? *scene_.camera : settings_of(scene_, view);
  const sim::Vec3d eye = setup::camera_at(camera, 0, scene::duration(scene_)).eye;
  SlicePlane plane = plane_of(scene_, view, seeded_, snapshot);
  // A view without a slice may have no place of one, and its snow may be anywhere.
  if (!view.slice.point && view.slice.follow.empty()) plane.point = middle_of(snapshot.particles.x);
  return StageLook{StageCut(view, plane, eye, scene_.solver.cell_size),
                   snapshot.stage_change->largest()};
}

/// A box around each body, with its name where there are several.
void FrameBuilder::add_bounds(const Snapshot& snapshot, render::Frame& frame) const {
  render::Lines lines;
  lines.opacity = 0.6f;
  for (std::size_t body = 0; body < seeded_.body_end.size(); ++body) {
    const auto [first, end] = particles_of(body, snapshot);
    sim::shapes::Bounds box{sim::Vec3d::Constant(1e300), sim::Vec3d::Constant(-1e300)};
    for (std::size_t p = first; p < end; ++p) {
      if (!snapshot.particles.x[p].allFinite()) continue;
      box.min = box.min.cwiseMin(snapshot.particles.x[p]);
      box.max = box.max.cwiseMax(snapshot.particles.x[p]);
    }
    if (!(box.min.x() <= box.max.x())) continue;
    append_box(box.min, box.max, lines);
    if (seeded_.body_end.size() > 1)
      frame.labels.push_back(
          {to_float(sim::Vec3d(box.min.x(), box.max.y(), box.max.z())), scene_.bodies[body].name});
  }
  frame.lines.push_back(std::move(lines));
}

std::pair<std::size_t, std::size_t> FrameBuilder::particles_of(std::size_t body,
                                                               const Snapshot& snapshot) const {
  const sim::ParticleArrays& p = snapshot.particles;
  return {p.first_from(seeded_.body_begin(body)), p.first_from(seeded_.body_end[body])};
}

setup::CameraPlace camera_place(const scene::Scene& scene, const scene::View& view,
                                const setup::SeededScene& seeded, const Snapshot& snapshot) {
  const scene::CameraSettings& settings = settings_of(scene, view);
  setup::CameraPlace place = setup::camera_at(settings, snapshot.time, scene::duration(scene));
  const sim::Vec3d moved = followed_by(settings.follow, scene, scene.colliders, seeded,
                                       snapshot.particles, snapshot.time);
  place.eye += moved;
  place.target += moved;
  return place;
}

render::Camera camera_of(const scene::Scene& scene, const scene::View& view,
                         const setup::SeededScene& seeded, const Snapshot& snapshot) {
  return to_camera(camera_place(scene, view, seeded, snapshot), settings_of(scene, view));
}

std::vector<std::string> FrameBuilder::words(const scene::View& view,
                                             const Snapshot& snapshot) const {
  std::vector<std::string> lines;
  if (scene::has_layer(view, scene::Layer::caption)) lines = caption(snapshot);
  if (scene::has_layer(view, scene::Layer::counter)) {
    const int last = scene::number_of(scene_, scene::last_frame(scene_));
    const int now = scene::number_of(scene_, snapshot.frame);
    const std::size_t digits = std::to_string(std::abs(last)).size();
    // A film that became longer than its scene has no end that all of its pictures know.
    lines.push_back(fmt::format("{}{:0{}}", now < 0 ? "-" : "", std::abs(now), digits) +
                    (now > last ? "" : fmt::format(" / {}", last)));
  }
  if (scene::has_layer(view, scene::Layer::slate) && snapshot.frame == 0)
    for (std::string& line : slate()) lines.push_back(std::move(line));
  return lines;
}

std::vector<std::string> FrameBuilder::slate() const {
  std::vector<std::string> lines;
  if (!scene_.title.empty()) lines.push_back(scene_.title);
  lines.push_back("frames " + std::to_string(scene::number_of(scene_, 0)) + " to " +
                  std::to_string(scene::number_of(scene_, scene::last_frame(scene_))) + ", " +
                  plain_rate(scene_.fps) + " a second; cells of " +
                  rough_text(scene_.solver.cell_size) + " m; seed " + std::to_string(scene_.seed));
  for (const sim::Material& m : scene_.materials)
    lines.push_back(m.name + ": " + rough_text(m.density) + " kg/m3, E " +
                    rough_text(m.youngs_modulus) + " Pa, " + strength_line(m));
  for (std::string& line : scene::override_lines(options_.overrides))
    lines.push_back(std::move(line));
  return lines;
}

std::vector<std::string> FrameBuilder::caption(const Snapshot& snapshot) const {
  std::vector<std::string> lines;
  if (!scene_.title.empty()) lines.push_back(scene_.title);
  lines.push_back("frame " + std::to_string(scene::number_of(scene_, snapshot.frame)) +
                  "   t = " + time_text(snapshot.time, scene_.fps));
  const std::size_t count = snapshot.particles.x.size();
  lines.push_back(grouped(count) + (count == 1 ? " particle" : " particles") +
                  (options_.coarsening > 1
                       ? ", coarsened " + scene::coarsening_text(options_.coarsening)
                       : "") +
                  (snapshot.advance.steps > 0 ? "   " + steps_text(snapshot.advance) : ""));
  if (const std::string curves = setup::curves_text(scene_, snapshot.frame); !curves.empty())
    lines.push_back(curves);
  if (snapshot.warnings.rules_ignored > 0) lines.push_back(ignored_rule_text(snapshot.warnings));
  lines.insert(lines.end(), options_.prediction.begin(), options_.prediction.end());
  const std::vector<std::string> different =
      scene::change_lines(options_.overrides, snapshot.changes);
  const std::size_t shown = std::min(different.size(), max_override_lines);
  lines.insert(lines.end(), different.begin(),
               different.begin() + static_cast<std::ptrdiff_t>(shown));
  if (shown < different.size())
    lines.push_back("and " + std::to_string(different.size() - shown) + " more changes");
  return lines;
}

}  // namespace neve::app::picture

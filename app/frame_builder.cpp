#include "app/frame_builder.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "app/attributes.h"
#include "app/round_number.h"
#include "app/scene/coarsen.h"
#include "app/text.h"
#include "render/mesh_shapes.h"

namespace neve::app {

namespace {

/// Radius of a drawn particle over the mean distance of packed ones: neighbours overlap, so that
/// snow has a surface.
constexpr double radius_share = 0.6;
constexpr std::size_t max_override_lines = 6;
/// Rings around more particles than these hide what they point out.
constexpr std::size_t max_marks = 16;

Vec3f to_float(const sim::Vec3d& v) {
  return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z())};
}

bool has_layer(const View& view, Layer layer) {
  return std::find(view.layers.begin(), view.layers.end(), layer) != view.layers.end();
}

render::Rotation to_rotation(const sim::Mat3d& matrix) {
  render::Rotation rotation;
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column)
      rotation[static_cast<std::size_t>(3 * row + column)] =
          static_cast<float>(matrix(row, column));
  return rotation;
}

/// The view's camera or the scene's; resolved, so that eye and target are there.
render::Camera to_camera(const CameraSettings& settings) {
  return {to_float(settings.eye.value_or(sim::Vec3d(2, 1, 2))),
          to_float(settings.target.value_or(sim::Vec3d::Zero())), to_float(settings.up),
          static_cast<float>(settings.fov)};
}

void add_colliders(const Scene& scene, const View& view, double time, render::Frame& frame) {
  const float distance = length(frame.camera.eye - frame.camera.target);
  for (const sim::Collider& collider : scene.colliders) {
    const sim::Pose pose = sim::pose_at(collider, time);
    if (const auto* plane = std::get_if<sim::Plane>(&collider.shape.form)) {
      if (!has_layer(view, Layer::ground)) continue;
      render::GroundPlane ground;
      ground.point = to_float(pose.point);
      ground.normal = to_float((pose.rotation * plane->normal).normalized());
      ground.line_spacing = static_cast<float>(round_down(0.1 * distance));
      frame.grounds.push_back(ground);
    } else if (has_layer(view, Layer::colliders)) {
      if (const auto* sphere = std::get_if<sim::Sphere>(&collider.shape.form))
        frame.meshes.push_back(
            render::sphere_mesh(to_float(pose.point), static_cast<float>(sphere->radius)));
      else if (const auto* box = std::get_if<sim::Box>(&collider.shape.form))
        frame.meshes.push_back(render::box_mesh(to_float(pose.point), to_float(box->size),
                                                to_rotation(pose.rotation)));
    }
  }
}

std::string grouped(std::size_t count) {
  std::string digits = std::to_string(count);
  for (auto place = static_cast<std::ptrdiff_t>(digits.size()) - 3; place > 0; place -= 3)
    digits.insert(static_cast<std::size_t>(place), 1, ' ');
  return digits;
}

}  // namespace

Snapshot take_snapshot(const sim::Simulation& simulation, int frame, bool with_stress) {
  Snapshot snapshot;
  snapshot.frame = frame;
  snapshot.time = simulation.time();
  snapshot.particles = simulation.particles();
  if (with_stress) snapshot.kirchhoff = simulation.kirchhoff();
  return snapshot;
}

bool needs_stress(const Scene& scene) {
  return std::any_of(scene.views.begin(), scene.views.end(), [](const View& view) {
    return view.particles.color_by == ColorBy::pressure ||
           view.particles.color_by == ColorBy::von_mises;
  });
}

FrameBuilder::FrameBuilder(const Scene& scene, double spacing, Quality quality,
                           const std::vector<std::string>& overrides, double coarsening)
    : scene_(scene),
      spacing_(spacing),
      quality_(quality),
      override_lines_(app::override_lines(overrides)),
      coarsening_(coarsening) {}

render::Frame FrameBuilder::build(const View& view, const Snapshot& snapshot) const {
  render::Frame frame;
  const PictureSize size = size_of(scene_, view);
  frame.width = size.width;
  frame.height = size.height;
  frame.supersampling = supersampling(quality_);
  frame.camera = to_camera(view.camera ? *view.camera : scene_.camera.value_or(CameraSettings{}));
  frame.light = {to_float(scene_.light.direction), static_cast<float>(scene_.light.intensity),
                 static_cast<float>(scene_.light.ambient)};
  add_colliders(scene_, view, snapshot.time, frame);
  if (has_layer(view, Layer::particles)) add_points(view, snapshot, frame);
  if (has_layer(view, Layer::caption)) frame.caption = caption(snapshot);
  return frame;
}

render::Frame FrameBuilder::build_incident(const View& view, const Snapshot& snapshot,
                                           const sim::Divergence& divergence) const {
  render::Frame frame = build(view, snapshot);
  for (const std::uint32_t p : divergence.culprits) {
    if (frame.marks.size() == max_marks) break;
    if (p < snapshot.particles.x.size() && snapshot.particles.x[p].allFinite())
      frame.marks.push_back(to_float(snapshot.particles.x[p]));
  }
  if (!frame.caption.empty())
    frame.caption.push_back("diverged at step " + std::to_string(divergence.step) + ": " +
                            divergence.rule);
  return frame;
}

void FrameBuilder::add_points(const View& view, const Snapshot& snapshot,
                              render::Frame& frame) const {
  const ParticleStyle& style = view.particles;
  const Range range = style.range.value_or(Range{});
  const std::vector<double> values = attribute_values(scene_, style.color_by, snapshot);
  render::Points& points = frame.points;
  points.spacing = static_cast<float>(spacing_);
  points.radius = static_cast<float>(radius_share * spacing_);
  points.colormap = style.colormap;
  points.range_min = static_cast<float>(range.min);
  points.range_max = static_cast<float>(range.max);
  points.position.reserve(snapshot.particles.x.size());
  points.id.reserve(snapshot.particles.x.size());
  points.value.reserve(values.size());
  for (std::size_t p = 0; p < snapshot.particles.x.size(); ++p) {
    // A diverged state is drawn too, as far as it can be.
    if (!snapshot.particles.x[p].allFinite()) continue;
    points.position.push_back(to_float(snapshot.particles.x[p]));
    points.id.push_back(static_cast<std::uint32_t>(p));
    if (!values.empty())
      points.value.push_back(static_cast<float>(std::isfinite(values[p]) ? values[p] : range.max));
  }
  if (style.color_by == ColorBy::snow || !has_layer(view, Layer::legend)) return;
  const AttributeName name = attribute_name(style.color_by);
  frame.legends.push_back(
      {name.title, name.unit, style.colormap, points.range_min, points.range_max});
}

std::vector<std::string> FrameBuilder::caption(const Snapshot& snapshot) const {
  std::vector<std::string> lines;
  if (!scene_.title.empty()) lines.push_back(scene_.title);
  lines.push_back("frame " + std::to_string(snapshot.frame) +
                  "   t = " + fixed_text(snapshot.time, 3) + " s");
  const std::size_t count = snapshot.particles.x.size();
  lines.push_back(grouped(count) + (count == 1 ? " particle" : " particles") +
                  (coarsening_ > 1 ? ", coarsened " + coarsening_text(coarsening_) : ""));
  const std::size_t shown = std::min(override_lines_.size(), max_override_lines);
  lines.insert(lines.end(), override_lines_.begin(),
               override_lines_.begin() + static_cast<std::ptrdiff_t>(shown));
  if (shown < override_lines_.size())
    lines.push_back("and " + std::to_string(override_lines_.size() - shown) + " more changes");
  return lines;
}

std::vector<std::string> override_lines(const std::vector<std::string>& overrides) {
  const auto last_word = [](const std::string& address) {
    const std::size_t dot = address.rfind('.');
    return dot == std::string::npos ? address : address.substr(dot + 1);
  };
  std::map<std::string, std::string> by_address;  // the last value of an address counts
  std::map<std::string, int> ending_alike;
  std::vector<std::string> order;
  for (const std::string& text : overrides) {
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos) continue;
    const std::string address = text.substr(0, equals);
    if (!by_address.contains(address)) {
      order.push_back(address);
      ++ending_alike[last_word(address)];
    }
    by_address[address] = text.substr(equals + 1);
  }
  std::vector<std::string> lines;
  for (const std::string& address : order) {
    const std::string word = last_word(address);
    lines.push_back((ending_alike[word] > 1 ? address : word) + " = " + by_address[address]);
  }
  return lines;
}

}  // namespace neve::app

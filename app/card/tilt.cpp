/// An endless layer on a rough slope that becomes steeper.
///
/// At rest the slope bears the weight of the layer: shear over pressure is the tangent of its
/// angle. Once the layer slides, it bears less. So the angle of sliding is read from forces, and it
/// matters little how fast the slope turns.

#include <algorithm>
#include <cmath>
#include <numbers>

#include "app/card/falls.h"
#include "app/support/text.h"

namespace neve::app::card {

namespace {

using sim::Vec3d;

constexpr int cells_across = 4, cells_deep = 8;
constexpr double depth = 0.5, tilt_cell = depth / cells_deep;  // m
constexpr double rest = 0.5;                                   // s, before it is tilted
constexpr double turn = 0.3;                                   // degrees, of a sample
constexpr double sample_time = 0.02;                           // s
constexpr double steepest = 90;                                // degrees
/// Forces are means over so many samples: waves run up and down the layer.
constexpr std::size_t window = 10;
/// The layer slides when its slope is so much steeper than what it bears, degrees.
constexpr double out_of_balance = 1.5;
constexpr double seen_to_slide = 0.3;  // of the depth

double degrees(double radians) {
  return radians * 180 / std::numbers::pi;
}

Vec3d gravity_at(double angle) {
  const double a = angle * std::numbers::pi / 180;
  return 9.81 * Vec3d(std::sin(a), -std::cos(a), 0);
}

/// Mean way of the upper half down the slope, m.
double way_of(const std::vector<Vec3d>& now, const std::vector<Vec3d>& first) {
  double sum = 0, count = 0;
  for (std::size_t p = 0; p < now.size(); ++p)
    if (first[p].y() > depth / 2) sum += now[p].x() - first[p].x(), ++count;
  return sum / count;
}

/// Returns the way_of() an elastic layer under its own weight, m: shear that grows linearly with
/// depth, over the modulus, in the mean of the upper half. It swings about that way.
double elastic_way(const sim::Material& m, double angle) {
  const double shear = m.density * gravity_at(angle).x() * depth;
  return 11.0 / 24 * depth * shear / sim::lame(m.youngs_modulus, m.poisson_ratio).mu;
}
constexpr double swing = 1.5;  // times the elastic way, at most, of a load that grows

/// Share of its height that the lowest snow of the layer loses under the rest.
double squeezed_by_weight(const sim::Material& m) {
  const sim::Lame lame = sim::lame(m.youngs_modulus, m.poisson_ratio);
  return m.density * gravity_at(0).norm() * depth / (lame.lambda + 2 * lame.mu);
}

/// The balance of the slope: its angle, and the angle at which its forces act.
class Balance {
 public:
  void add(double angle, const Vec3d& impulse) {
    angle_.push_back(angle);
    impulse_.push_back(impulse);
  }
  bool is_known() const { return angle_.size() >= window; }
  /// Angle whose tangent is shear over pressure, degrees.
  double borne() const {
    Vec3d sum = Vec3d::Zero();
    for (std::size_t k = impulse_.size() - window; k < impulse_.size(); ++k) sum += impulse_[k];
    return degrees(std::atan2(sum.x(), -sum.y()));
  }
  /// Mean angle of the slope over the same time, degrees.
  double angle() const { return 0.5 * (angle_[angle_.size() - window] + angle_.back()) - turn / 2; }

 private:
  std::vector<double> angle_;
  std::vector<Vec3d> impulse_;
};

scene::Scene layer(const Subject& subject) {
  scene::Scene stage = empty_stage(subject, tilt_cell);
  stage.solver.period = {cells_across / 4, 0, cells_across / 4};
  stage.solver.gravity = gravity_at(0);
  stage.solver.max_dt = 1e-2;
  const double side = cells_across * tilt_cell, grip = 1.5 * tilt_cell;
  add_body(stage,
           {sim::shapes::Box{{side / 2, (depth - grip) / 2, side / 2}, {side, depth + grip, side}}},
           sim::seeding::Sampling::lattice);
  add_plane(stage, "slope", {0, 0, 0}, {0, 1, 0}, sim::shapes::Contact::sticky);
  return stage;
}

/// More of the endless layer, seen from its side with gravity down.
void show_layer(const sim::Simulation& simulation, scene::Scene stage, double angle,
                Experiment& e) {
  const double side = cells_across * tilt_cell;
  const Vec3d middle{side / 2, depth / 2, side / 2};
  const double a = angle * std::numbers::pi / 180;
  look(stage, middle + Vec3d(0, 0, 4.2), middle, {-std::sin(a), std::cos(a), 0});
  show(simulation, std::move(stage), e);
  sim::ParticleArrays& seen = e.shown.particles;
  const std::vector<Vec3d> x = seen.x;
  seen = {};
  for (int copy = -5; copy <= 5; ++copy)
    for (const Vec3d& x_p : x) {
      const double along = x_p.x() - side * std::floor(x_p.x() / side);
      seen.x.emplace_back(along + copy * side, x_p.y(), x_p.z());
    }
}

}  // namespace

Experiment tilt(const Subject& subject) {
  Experiment e;
  e.kind = Kind::tilt;
  scene::Scene stage = layer(subject);
  sim::Simulation simulation = simulation_of(stage);
  const std::vector<Vec3d> first = simulation.particles().x;
  double angle = 0, slides_at = 0, slid = 0;
  Balance balance;
  advance(simulation, rest, e);
  while (e.failure.empty() && angle < steepest) {
    angle = std::min(steepest, angle + turn);
    stage.solver.gravity = gravity_at(angle);
    simulation.apply(stage.solver, stage.materials, scene::sim_colliders(stage));
    sim::AdvanceReport report;
    if (!advance(simulation, simulation.time() + sample_time, e, &report)) break;
    balance.add(angle, report.loads.front().impulse);
    e.x.push_back(angle);
    e.y.push_back(way_of(simulation.particles().x, first));
    slid = e.y.back() - swing * elastic_way(subject.material, angle);
    const bool is_out = balance.is_known() && balance.angle() - balance.borne() > out_of_balance;
    if (slides_at == 0 && is_out) slides_at = balance.borne();
    // Soft layers lag behind their slope, and catch up with it.
    if (!is_out && slid < seen_to_slide * depth / 3) slides_at = 0;
    if (slides_at > 0 && slid > seen_to_slide * depth) break;
  }
  show_layer(simulation, stage, angle, e);
  // An elastic layer swings, and leaves its balance without sliding away.
  const bool slides = slides_at > 0 && slid > seen_to_slide * depth / 3;
  e.measures = {{"angle", slides ? slides_at : NAN}};
  // One that did not end says how far it got, if it was tilted at all.
  const bool has_ended = e.failure.empty();
  constexpr double too_soft = 0.05;
  if (slides)
    e.words.push_back("slides at " + rough_text(slides_at) + "\u00b0");
  else if (has_ended || !e.x.empty())
    e.words.push_back((has_ended ? "holds at " : "held up to ") +
                      rough_text(has_ended ? angle : e.x.back()) + "\u00b0");
  if (slides && squeezed_by_weight(subject.material) > too_soft)
    e.words.push_back("too soft to bear its weight: slides early");
  return e;
}

}  // namespace neve::app::card

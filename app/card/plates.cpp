#include "app/card/plates.h"

#include <algorithm>
#include <cmath>

namespace neve::app::card {

namespace {

using sim::Vec3d;

/// Cells of snow in each plate, which holds them.
constexpr double grip = 1.5;
/// Way of sound while a plate moves, from plate to plate.
constexpr double transits = 60;

/// Keyframes of a motion. A curve through keyframes rests at the last one: the last motion goes on
/// a little beyond its end, so that it does not slow down before.
void add_keyframes(const PlateMotion& motion, double start, const Vec3d& from, bool is_last,
                   std::vector<sim::shapes::PoseKeyframe>& keyframes) {
  constexpr int parts = 40, beyond = 4;
  for (int k = keyframes.empty() ? 0 : 1; k <= (is_last ? parts + beyond : parts); ++k) {
    const double part = static_cast<double>(k) / parts;
    const double share = is_last ? part * part : part * part * (3 - 2 * part);
    keyframes.push_back(
        {start + part * motion.seconds, Vec3d(from + share * motion.by), std::nullopt});
  }
}

}  // namespace

double slow_seconds(const sim::Material& material) {
  return transits * Plates::height / sim::sound_speed(material);
}

Plates::Plates(const Subject& subject, const std::vector<PlateMotion>& motions,
               Experiment& experiment)
    : experiment_(experiment), stage_(empty_stage(subject, cell)) {
  stage_.solver.gravity.setZero();
  stage_.solver.max_dt = 1;  // sound rules
  stage_.solver.period = {cells_wide / 4, 0, cells_wide / 4};
  const Vec3d middle{side / 2, height / 2, side / 2}, up{0, 1, 0}, half = 0.5 * height * up;
  const Vec3d size{side, height + 2 * grip * cell, side};
  add_body(stage_, {sim::shapes::Box{middle, size}}, sim::seeding::Sampling::lattice);
  add_plane(stage_, "lower plate", middle - half, up, sim::shapes::Contact::sticky);
  add_plane(stage_, "upper plate", middle + half, -up, sim::shapes::Contact::sticky);
  add_motions(motions, middle + half);
  simulation_.emplace(simulation_of(stage_));
  const std::vector<Vec3d> x = simulation_->particles().x;
  for (std::size_t p = 0; p < x.size(); ++p) {
    const double y = x[p].y() / height;
    if (std::abs(y - 0.25) < 0.05) lower_end_.push_back(p);
    if (std::abs(y - 0.75) < 0.05) upper_end_.push_back(p);
    if (y < 0.5) lower_half_.push_back(p);
  }
  first_ = last_ = read();
}

void Plates::add_motions(const std::vector<PlateMotion>& motions, const Vec3d& from) {
  double start = 0;
  Vec3d place = from;
  for (const PlateMotion& motion : motions) {
    add_keyframes(motion, start, place, &motion == &motions.back(),
                  stage_.colliders.back().keyframes);
    for (int k = 1; k <= samples; ++k) times_.push_back(start + motion.seconds * k / samples);
    start += motion.seconds;
    place += motion.by;
  }
}

Plates::Reading Plates::read() const {
  const sim::ParticleArrays now = simulation_->particles();
  const auto mean = [&](const std::vector<std::size_t>& list) {
    Vec3d sum = Vec3d::Zero();
    for (const std::size_t p : list) sum += now.x[p];
    return Vec3d(sum / static_cast<double>(list.size()));
  };
  Reading reading{mean(upper_end_) - mean(lower_end_)};
  for (const std::size_t p : lower_half_) reading.momentum += now.m[p] * now.v[p];
  return reading;
}

bool Plates::next(PlateSample& sample) {
  if (next_ == times_.size()) return false;
  const double before = simulation_->time(), time = times_[next_++];
  sim::AdvanceReport report;
  if (!advance(*simulation_, time, experiment_, &report)) return false;
  const scene::Collider& plate = stage_.colliders.back();
  const auto place = [&](double t) { return sim::shapes::pose_at(plate, t).point; };
  sample.moved = 0.5 * (place(before) + place(time)) - place(0);
  const Reading reading = read();
  // The lower half gets from the upper one what it keeps, and what it gives to the plate.
  const Vec3d impulse = reading.momentum - last_.momentum + report.loads.front().impulse;
  sample.stress = impulse / ((time - before) * side * side);
  sample.strain = (0.5 * (last_.ends + reading.ends) - first_.ends) / first_.ends.y();
  last_ = reading;
  return true;
}

void Plates::show() {
  scene::Scene seen = stage_;
  const double thickness = 0.6 * cell;
  for (scene::Collider& plate : seen.colliders) {
    const double outward = &plate == &seen.colliders.front() ? -1 : 1;
    const Vec3d at =
        sim::shapes::pose_at(plate, simulation_->time()).point + Vec3d(0, outward * 2 * cell, 0);
    plate.keyframes.clear();
    plate.shape.form = sim::shapes::Box{at, {1.7 * side, thickness, 1.7 * side}};
  }
  const Vec3d middle{side / 2, height / 2, side / 2};
  look(seen, middle + Vec3d(0.3, 0.125, 0.58), middle);
  card::show(*simulation_, std::move(seen), experiment_);
}

}  // namespace neve::app::card

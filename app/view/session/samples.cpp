#include "app/view/session/samples.h"

#include <algorithm>
#include <limits>

namespace neve::app::view::session {

namespace {

constexpr std::size_t max_samples = 4000;
/// Sampling takes at most one part in so many of the time.
constexpr int sampling_share = 20;

double largest(const std::vector<double>& pressures) {
  return pressures.empty() ? 0 : *std::max_element(pressures.begin(), pressures.end());
}

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

RunSample sample_of(const record::FrameRecord& frame) {
  const sim::Summary& s = frame.summary;
  const sim::AdvanceReport& steps = frame.advance;
  RunSample sample{
      frame.time,    s.kinetic_energy, s.elastic_energy, s.momentum,
      s.max_speed,   s.min_J_P,        s.max_J_P,        steps.steps > 0 ? steps.dt_max : unknown,
      steps.limit(), s.max_depth};
  for (const record::ColliderForce& force : frame.forces) {
    sample.max_pressure = std::max(sample.max_pressure, force.max_pressure);
    sample.max_force = std::max(sample.max_force, force.force.norm());
  }
  for (const record::BodyRecord& body : frame.bodies)
    sample.bodies.push_back({body.collider, body.centre_of_mass.y(), body.velocity.norm()});
  return sample;
}

}  // namespace

double seconds_left(const timeline::Timeline& timeline) {
  const double left = timeline.frame_end() - timeline.simulation().time();
  return left > 0 ? left : 1 / timeline.fps();
}

void Samples::begin(const std::vector<record::FrameRecord>& frames) {
  *this = {};
  for (const record::FrameRecord& frame : frames) list_->push_back(sample_of(frame));
}

/// Readers hold the list they were given; a new one is made only when it is shared.
std::vector<RunSample>& Samples::own_list() {
  if (list_.use_count() > 1) list_ = std::make_shared<std::vector<RunSample>>(*list_);
  return *list_;
}

void Samples::note(const timeline::Timeline& timeline, const sim::Summary& s, double max_force) {
  noted_at_ = Clock::now();
  const sim::DtChoice choice = timeline.simulation().choose_dt(seconds_left(timeline));
  std::vector<RunSample>& list = own_list();
  while (!list.empty() && list.back().time >= s.time) list.pop_back();
  list.push_back({s.time, s.kinetic_energy, s.elastic_energy, s.momentum, s.max_speed, s.min_J_P,
                  s.max_J_P, choice.dt, choice.limit, s.max_depth, largest(s.max_pressure),
                  max_force, picture::body_samples(timeline.simulation().colliders(), s.time)});
  if (list.size() <= max_samples) return;
  std::size_t kept = 0;  // every other one: the plot covers the whole run with half the detail
  for (std::size_t k = 0; k < list.size(); k += 2) list[kept++] = list[k];
  list.resize(kept);
}

void Samples::note_if_cheap(const timeline::Timeline& timeline) {
  const Clock::time_point start = Clock::now();
  if (start - noted_at_ <= sampling_share * noting_took_) return;
  const sim::Summary summary = timeline.simulation().summary();
  noting_took_ = Clock::now() - start;
  note(timeline, summary, unknown);
}

void Samples::forget_after(double time) {
  std::erase_if(own_list(), [&](const RunSample& sample) { return sample.time > time; });
}

}  // namespace neve::app::view::session

/// The state of an engine as bytes, and back: exact, in the order of storage, with the counters
/// that later steps depend on.

#include <cstring>
#include <type_traits>

#include "sim/engine/engine.h"

namespace neve::sim::engine {

namespace {

constexpr char magic[8] = {'N', 'E', 'V', 'E', 'S', 'I', 'M', '7'};

/// What there is once; followed by the records, the travels of the colliders and the emitters.
struct SavedHead {
  char magic[8];
  std::uint32_t bytes_per_number, bytes_per_record;
  std::uint64_t count, steps;
  double time, rest_dt, last_dt;
  double frame_start, frame_done, frame_end;
  double max_speed, max_sound_speed, max_strain_rate, max_hardening;
  double energy_start, contact_work, energy_largest;
  double moment[3];
  double worst_acoustic_cfl, dt_scale;
  std::uint64_t inverted_trials, solves_cut_short, solves_given_up;
  std::int32_t lattice_origin[3], unused;
  std::uint64_t colliders;
  double colliders_time;
  std::uint64_t next_id, emitters, emitted, removed;
  double emitted_mass, removed_mass;
  std::uint64_t steps_since_look;
  double way_since_look;
};
static_assert(std::is_trivially_copyable_v<SavedHead> && sizeof(SavedHead) % 8 == 0);

struct SavedTravel {
  double since, moved[3], turned[9], waited;
};

SavedTravel saved(const shapes::Travel& travel) {
  SavedTravel out{};
  out.since = travel.since;
  out.waited = travel.waited;
  for (int a = 0; a < 3; ++a) out.moved[a] = travel.moved[a];
  for (int q = 0; q < 9; ++q) out.turned[q] = travel.turned(q / 3, q % 3);
  return out;
}

template <class T>
std::size_t saved_bytes(const std::vector<T>& list) {
  return sizeof(T) * list.size();
}

shapes::Travel travel(const SavedTravel& in) {
  shapes::Travel out;
  out.since = in.since;
  out.waited = in.waited;
  for (int a = 0; a < 3; ++a) out.moved[a] = in.moved[a];
  for (int q = 0; q < 9; ++q) out.turned(q / 3, q % 3) = in.turned[q];
  return out;
}

}  // namespace

template <class Real>
std::vector<std::uint8_t> Engine<Real>::save() const {
  static_assert(std::is_trivially_copyable_v<kernels::Particle<Real>>);
  SavedHead head{};
  std::memcpy(head.magic, magic, sizeof magic);
  head.bytes_per_number = sizeof(Real);
  head.bytes_per_record = sizeof(kernels::Particle<Real>);
  head.count = particles_.size();
  head.steps = steps_;
  head.time = time_;
  head.rest_dt = rest_dt_;
  head.last_dt = last_dt_;
  head.frame_start = frame_start_;
  head.frame_done = frame_done_;
  head.frame_end = frame_end_;
  head.max_speed = limits_.max_speed;
  head.max_sound_speed = limits_.max_sound_speed;
  head.max_strain_rate = limits_.max_strain_rate;
  head.max_hardening = limits_.max_hardening;
  head.energy_start = energy_.start;
  head.contact_work = energy_.contact_work;
  head.energy_largest = energy_.largest;
  head.worst_acoustic_cfl = warnings_.worst_acoustic_cfl;
  head.dt_scale = dt_scale_;
  head.inverted_trials = warnings_.inverted_trials;
  head.solves_cut_short = warnings_.solves_cut_short;
  head.solves_given_up = warnings_.solves_given_up;
  for (int a = 0; a < 3; ++a) {
    head.moment[a] = energy_.moment[a];
    head.lattice_origin[a] = lattice_origin_[a];
  }
  head.colliders = colliders_.size();
  head.colliders_time = colliders_time_;
  std::vector<SavedTravel> travels;
  for (const shapes::Collider& collider : colliders_) travels.push_back(saved(collider.travel));
  head.next_id = next_id_;
  head.emitters = streams_.size();
  head.emitted = totals_.emitted;
  head.removed = totals_.removed;
  head.emitted_mass = totals_.emitted_mass;
  head.removed_mass = totals_.removed_mass;
  head.steps_since_look = steps_since_look_;
  head.way_since_look = way_since_look_;
  std::vector<seeding::EmitterStream::State> streams;
  for (const Stream& stream : streams_) streams.push_back(stream.births.state());
  std::vector<std::uint8_t> bytes;
  bytes.reserve(sizeof head + saved_bytes(particles_) + saved_bytes(travels) +
                saved_bytes(streams));
  const auto append = [&](const void* data, std::size_t size) {
    const auto* first = static_cast<const std::uint8_t*>(data);
    bytes.insert(bytes.end(), first, first + size);
  };
  append(&head, sizeof head);
  append(particles_.data(), saved_bytes(particles_));
  append(travels.data(), saved_bytes(travels));
  append(streams.data(), saved_bytes(streams));
  return bytes;
}

template <class Real>
void Engine<Real>::restore(std::span<const std::uint8_t> bytes) {
  SavedHead head{};
  const auto refuse = [](const std::string& why) {
    throw SavedStateError("the saved state " + why);
  };
  if (bytes.size() < sizeof head) refuse("is truncated");
  std::memcpy(&head, bytes.data(), sizeof head);
  if (std::memcmp(head.magic, magic, sizeof magic) != 0) refuse("is from another version");
  if (head.bytes_per_number != sizeof(Real)) refuse("has a different precision");
  if (head.bytes_per_record != sizeof(kernels::Particle<Real>)) refuse("has different particles");
  if (head.colliders != colliders_.size()) refuse("has a different number of colliders");
  if (head.emitters != streams_.size()) refuse("has a different number of emitters");
  std::vector<SavedTravel> travels(colliders_.size());
  std::vector<seeding::EmitterStream::State> streams(streams_.size());
  if (head.count > bytes.size() / sizeof(kernels::Particle<Real>) ||
      bytes.size() != sizeof head + head.count * sizeof(kernels::Particle<Real>) +
                          saved_bytes(travels) + saved_bytes(streams))
    refuse("has a different length than it says");
  if (head.next_id < head.count || head.next_id > max_ids) refuse("has impossible ids");
  for (int a = 0; a < 3; ++a)
    if (head.lattice_origin[a] != lattice_origin_[a]) refuse("has a different lattice");

  std::vector<kernels::Particle<Real>> records(head.count);
  const std::uint8_t* next = bytes.data() + sizeof head;
  const auto take = [&](void* data, std::size_t size) {
    if (size > 0) std::memcpy(data, next, size);
    next += size;
  };
  take(records.data(), saved_bytes(records));
  take(travels.data(), saved_bytes(travels));
  take(streams.data(), saved_bytes(streams));
  for (const kernels::Particle<Real>& p : records) {
    for (const Integer<Real> cell : p.cell)
      if (cell <= -4 * kernels::block_limit || cell >= 4 * kernels::block_limit)
        refuse("has particles outside of the lattice");
    if (static_cast<std::size_t>(p.material()) >= material_list_.size() ||
        static_cast<std::uint64_t>(p.id) >= head.next_id)
      refuse("names a material or a particle that is not there");
  }

  for (std::size_t k = 0; k < travels.size(); ++k) colliders_[k].travel = travel(travels[k]);
  for (std::size_t k = 0; k < streams.size(); ++k) streams_[k].births.restore(streams[k]);
  next_id_ = head.next_id;
  totals_ = {head.emitted, head.removed, head.emitted_mass, head.removed_mass};
  steps_since_look_ = head.steps_since_look;
  way_since_look_ = head.way_since_look;
  colliders_time_ = head.colliders_time;
  particles_ = records;
  keys_.assign(head.count, 0);
  locals_.assign(head.count, 0);
  time_ = head.time;
  steps_ = head.steps;
  rest_dt_ = head.rest_dt;
  last_dt_ = head.last_dt;
  frame_start_ = head.frame_start;
  frame_done_ = head.frame_done;
  frame_end_ = head.frame_end;
  limits_ = {head.max_speed, head.max_sound_speed, head.max_strain_rate, head.max_hardening};
  energy_.start = head.energy_start;
  energy_.contact_work = head.contact_work;
  energy_.largest = head.energy_largest;
  for (int a = 0; a < 3; ++a) energy_.moment[a] = head.moment[a];
  warnings_ = {head.inverted_trials, head.worst_acoustic_cfl, head.solves_cut_short,
               head.solves_given_up};
  dt_scale_ = head.dt_scale;
  divergence_.reset();
  last_steps_.clear();
  partition_ = Partition();
  partition_.set_period(settings_.period);
  place_colliders();
  if (records.empty()) return;
  // Keys come from a sweep that also works out the stress anew, perhaps with another last bit: the
  // records go back as they were.
  kernels::SweepArgs<Real> a = args(0, kernels::all_channels);
  kernels::BlockReport<Real> report;
  sweeps_->refresh(a, 0, static_cast<std::uint32_t>(head.count), false, report);
  particles_ = std::move(records);
}

template std::vector<std::uint8_t> Engine<float>::save() const;
template std::vector<std::uint8_t> Engine<double>::save() const;
template void Engine<float>::restore(std::span<const std::uint8_t>);
template void Engine<double>::restore(std::span<const std::uint8_t>);

}  // namespace neve::sim::engine

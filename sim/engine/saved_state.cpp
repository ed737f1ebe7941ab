#include "sim/engine/saved_state.h"

#include <cstring>
#include <string>
#include <type_traits>

#include "sim/engine/saved_numbers.h"
#include "sim/types/errors.h"

namespace neve::sim::engine {

namespace {

/// The last sign is the version of the layout.
constexpr char magic[8] = {'N', 'E', 'V', 'E', 'S', 'I', 'M', 'H'};

/// Head of a saved state: it says what follows. Then come Progress, the records, the offsets of the
/// colliders, the emitters, the contacts, the velocities of bodies that move by themselves and the
/// shock pressure that a change at this moment found.
struct SavedHead {
  char magic[8];
  std::uint32_t bytes_per_number, bytes_per_record;
  std::uint64_t particles, colliders, emitters;
  std::int32_t lattice_origin[3];
  std::uint32_t contacts;
  std::uint32_t has_shock_pressure, has_new_affine;  ///< 0 or 1
};
static_assert(std::has_unique_object_representations_v<SavedHead>);

struct SavedOffset {
  double since, moved[3], turned[9], delay, joint_angle;
};

/// Speeds of a body that moves by itself.
struct SavedMotion {
  double velocity[3], spin[3];
};

/// KeptContact, without the order that they are read in.
struct SavedContact {
  double impulse, sliding[3], touches;
  std::uint32_t particle;
  std::int32_t collider;
};

template <class Real>
SavedContact saved(const kernels::KeptContact<Real>& contact) {
  SavedContact out{};
  out.impulse = static_cast<double>(contact.impulse);
  for (int a = 0; a < 3; ++a) out.sliding[a] = static_cast<double>(contact.sliding[a]);
  out.touches = static_cast<double>(contact.touches);
  out.particle = contact.particle;
  out.collider = contact.collider;
  return out;
}

template <class Real>
kernels::KeptContact<Real> restored(const SavedContact& in) {
  kernels::KeptContact<Real> out{};
  out.impulse = static_cast<Real>(in.impulse);
  for (int a = 0; a < 3; ++a) out.sliding[a] = static_cast<Real>(in.sliding[a]);
  out.touches = static_cast<Real>(in.touches);
  out.particle = in.particle;
  out.collider = in.collider;
  return out;
}

SavedOffset saved(const shapes::PoseOffset& offset) {
  SavedOffset out{};
  out.since = offset.since;
  out.delay = offset.delay;
  out.joint_angle = offset.joint_angle;
  for (int a = 0; a < 3; ++a) out.moved[a] = offset.moved[a];
  for (int q = 0; q < 9; ++q) out.turned[q] = offset.turned(q / 3, q % 3);
  return out;
}

shapes::PoseOffset restored(const SavedOffset& in) {
  shapes::PoseOffset out;
  out.since = in.since;
  out.delay = in.delay;
  out.joint_angle = in.joint_angle;
  for (int a = 0; a < 3; ++a) out.moved[a] = in.moved[a];
  for (int q = 0; q < 9; ++q) out.turned(q / 3, q % 3) = in.turned[q];
  return out;
}

template <class T>
std::size_t bytes_in(const std::vector<T>& list) {
  return sizeof(T) * list.size();
}

[[noreturn]] void refuse_saved(const std::string& why) {
  throw SavedStateError("the saved state " + why);
}

/// True if a change at this very moment left a shock pressure for the next one.
template <class Real>
bool has_shock_pressure(const State<Real>& state) {
  const ParticleStorage<Real>& particles = state.particles;
  return particles.size() > 0 && particles.shock_pressure.size() == particles.size() &&
         particles.shock_step == state.progress.steps;
}

template <class Real>
SavedHead head_of(const State<Real>& state, std::size_t emitters, std::size_t contacts) {
  SavedHead head{};
  std::memcpy(head.magic, magic, sizeof magic);
  head.bytes_per_number = sizeof(Real);
  head.bytes_per_record = sizeof(kernels::Particle<Real>);
  head.particles = state.particles.size();
  head.colliders = state.colliders.list().size();
  head.emitters = emitters;
  head.contacts = static_cast<std::uint32_t>(contacts);
  head.has_shock_pressure = has_shock_pressure(state) ? 1 : 0;
  head.has_new_affine = state.particles.affine_step == state.progress.steps ? 1 : 0;
  for (int a = 0; a < 3; ++a) head.lattice_origin[a] = state.method.lattice.origin[a];
  return head;
}

/// Compares everything but the numbers of particles and contacts.
void require_same(const SavedHead& found, const SavedHead& expected) {
  if (found.bytes_per_number != expected.bytes_per_number)
    refuse_saved("has a different precision");
  if (found.bytes_per_record != expected.bytes_per_record) refuse_saved("has different particles");
  if (found.colliders != expected.colliders) refuse_saved("has a different number of colliders");
  if (found.emitters != expected.emitters) refuse_saved("has a different number of emitters");
  if (std::memcmp(found.lattice_origin, expected.lattice_origin, sizeof found.lattice_origin) != 0)
    refuse_saved("has a different lattice");
}

/// Reads all but the head.
template <class Real>
SavedNumbers<Real> read_saved(std::span<const std::uint8_t> bytes, const State<Real>& state,
                              const SnowFlow<Real>& flow) {
  const std::uint8_t* next = bytes.data();
  const auto take = [&](void* data, std::size_t size) {
    if (size > 0) std::memcpy(data, next, size);
    next += size;
  };
  SavedHead head{};
  if (bytes.size() < sizeof head) refuse_saved("is truncated");
  take(&head, sizeof head);
  if (!has_this_layout(bytes)) refuse_saved("is from another version");
  SavedNumbers<Real> saved;
  saved.emitters = flow.emitter_states();
  require_same(head, head_of(state, saved.emitters.size(), head.contacts));
  std::vector<SavedOffset> offsets(state.colliders.list().size());
  saved.motions.resize(state.colliders.bodies().size());
  const std::uint64_t shocks = head.has_shock_pressure != 0 ? head.particles : 0;
  if (head.particles > bytes.size() / sizeof(kernels::Particle<Real>) ||
      bytes.size() != sizeof head + sizeof saved.progress +
                          head.particles * sizeof(kernels::Particle<Real>) + bytes_in(offsets) +
                          bytes_in(saved.emitters) + head.contacts * sizeof(SavedContact) +
                          saved.motions.size() * sizeof(SavedMotion) + shocks * sizeof(Real))
    refuse_saved("has a different length than it says");
  take(&saved.progress, sizeof saved.progress);
  saved.records.resize(head.particles);
  take(saved.records.data(), bytes_in(saved.records));
  take(offsets.data(), bytes_in(offsets));
  take(saved.emitters.data(), bytes_in(saved.emitters));
  std::vector<SavedContact> contacts(head.contacts);
  take(contacts.data(), bytes_in(contacts));
  for (auto& [velocity, spin] : saved.motions) {
    SavedMotion motion{};
    take(&motion, sizeof motion);
    velocity = Vec3d::Map(motion.velocity);
    spin = Vec3d::Map(motion.spin);
  }
  saved.shock_pressure.resize(shocks);
  take(saved.shock_pressure.data(), bytes_in(saved.shock_pressure));
  saved.has_new_affine = head.has_new_affine != 0;
  for (const SavedOffset& offset : offsets) saved.offsets.push_back(restored(offset));
  for (const SavedContact& contact : contacts) saved.contacts.push_back(restored<Real>(contact));
  return saved;
}

}  // namespace

bool has_this_layout(std::span<const std::uint8_t> bytes) {
  return bytes.size() >= sizeof magic && std::memcmp(bytes.data(), magic, sizeof magic) == 0;
}

/// The length of the dust comes last.
std::vector<std::uint8_t> joined(std::vector<std::uint8_t> snow,
                                 const std::vector<std::uint8_t>& dust) {
  snow.insert(snow.end(), dust.begin(), dust.end());
  const std::uint64_t length = dust.size();
  const auto* digits = reinterpret_cast<const std::uint8_t*>(&length);
  snow.insert(snow.end(), digits, digits + sizeof length);
  return snow;
}

SplitState split(std::span<const std::uint8_t> bytes) {
  std::uint64_t length = 0;
  if (bytes.size() < sizeof(SavedHead) + sizeof length) refuse_saved("is truncated");
  const std::size_t rest = bytes.size() - sizeof length;
  std::memcpy(&length, bytes.data() + rest, sizeof length);
  if (length > rest - sizeof(SavedHead)) refuse_saved("has a different length than it says");
  return {bytes.first(rest - length), bytes.subspan(rest - length, length)};
}

template <class Real>
std::vector<std::uint8_t> save(const State<Real>& state, const SnowFlow<Real>& flow) {
  static_assert(std::is_trivially_copyable_v<kernels::Particle<Real>>);
  const std::vector<kernels::Particle<Real>>& records = state.particles.records;
  std::vector<SavedOffset> offsets;
  for (const shapes::Collider& collider : state.colliders.list())
    offsets.push_back(saved(collider.pose_offset));
  const std::vector<seeding::EmitterStream::State> emitters = flow.emitter_states();
  std::vector<SavedContact> contacts;
  for (const kernels::KeptContact<Real>& contact : state.particles.contacts.list())
    contacts.push_back(saved(contact));
  std::vector<SavedMotion> motions;
  const rigid::RigidBodies& bodies = state.colliders.bodies();
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    const shapes::Pose pose = shapes::pose_at(state.colliders.list()[bodies.collider(b)], 0);
    SavedMotion& motion = motions.emplace_back();
    Vec3d::Map(motion.velocity) = pose.velocity;
    Vec3d::Map(motion.spin) = pose.angular_velocity;
  }
  const SavedHead head = head_of(state, emitters.size(), contacts.size());
  const std::vector<Real> shocks =
      head.has_shock_pressure != 0 ? state.particles.shock_pressure : std::vector<Real>{};
  std::vector<std::uint8_t> bytes(sizeof head + sizeof state.progress + bytes_in(records) +
                                  bytes_in(offsets) + bytes_in(emitters) + bytes_in(contacts) +
                                  bytes_in(motions) + bytes_in(shocks));
  std::uint8_t* next = bytes.data();
  const auto put = [&](const void* data, std::size_t size) {
    if (size > 0) std::memcpy(next, data, size);
    next += size;
  };
  put(&head, sizeof head);
  put(&state.progress, sizeof state.progress);
  put(records.data(), bytes_in(records));
  put(offsets.data(), bytes_in(offsets));
  put(emitters.data(), bytes_in(emitters));
  put(contacts.data(), bytes_in(contacts));
  put(motions.data(), bytes_in(motions));
  put(shocks.data(), bytes_in(shocks));
  return bytes;
}

template <class Real>
void restore(std::span<const std::uint8_t> bytes, State<Real>& state, SnowFlow<Real>& flow) {
  SavedNumbers<Real> saved = read_saved(bytes, state, flow);
  require_consistent(saved, state.method);
  state.progress = saved.progress;
  for (std::size_t b = 0; b < saved.motions.size(); ++b)
    saved.offsets[state.colliders.bodies().collider(b)].motion = saved.motions[b];
  for (std::size_t k = 0; k < saved.offsets.size(); ++k)
    state.colliders.set_offset(k, saved.offsets[k]);
  state.colliders.place(state.method.lattice, saved.progress.colliders_time, *state.pool);
  flow.restore(saved.emitters);
  state.particles.replace(saved.records);
  state.particles.contacts.replace(saved.contacts, saved.records.size());
  state.particles.shock_pressure = std::move(saved.shock_pressure);
  state.particles.shock_step = saved.progress.steps;
  state.particles.affine_step =
      saved.has_new_affine ? saved.progress.steps : ParticleStorage<Real>::no_step;
  if (saved.records.empty()) return;
  // Keys come from a sweep that also computes the stress, perhaps with another last bit: the
  // records go back as they were.
  state.refresh(0, saved.records.size());
  state.particles.records = std::move(saved.records);
}

template <class Real>
void require_healthy(std::span<const std::uint8_t> bytes, const State<Real>& state,
                     const SnowFlow<Real>& flow) {
  require_healthy(read_saved(bytes, state, flow), state.method);
}

template std::vector<std::uint8_t> save(const State<float>&, const SnowFlow<float>&);
template std::vector<std::uint8_t> save(const State<double>&, const SnowFlow<double>&);
template void restore(std::span<const std::uint8_t>, State<float>&, SnowFlow<float>&);
template void restore(std::span<const std::uint8_t>, State<double>&, SnowFlow<double>&);
template void require_healthy(std::span<const std::uint8_t>, const State<float>&,
                              const SnowFlow<float>&);
template void require_healthy(std::span<const std::uint8_t>, const State<double>&,
                              const SnowFlow<double>&);

}  // namespace neve::sim::engine

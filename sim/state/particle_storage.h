#pragma once
/// Particle records, the block of nodes that each belongs to, and the contacts that it remembers.

#include <cstdint>
#include <vector>

#include "sim/kernels/particle_contact.h"
#include "sim/kernels/particles.h"
#include "sim/state/partition.h"
#include "sim/state/reorder.h"

namespace neve::sim::engine {

/// Contacts of the last step, for the next one to begin with; see kernels/particle_contact.h.
template <class Real>
class KeptContacts {
 public:
  using Contact = kernels::KeptContact<Real>;

  /// Returns the contacts of a run, without those that a step has left of its list and that belong
  /// to no particle.
  std::vector<Contact> list() const;
  /// Forgets all others. @param contacts  of particles below `particles`; any `next`
  void replace(const std::vector<Contact>& contacts, std::size_t particles);
  void forget() { replace({}, 0); }

  void add(const Contact& contact);
  /// The storage has so many particles now; the last ones are new.
  void resize(std::size_t particles);
  /// Particle q is gone, and the last one has its place.
  void remove(std::uint32_t q, std::uint32_t last);
  /// The storage is sorted: particle q becomes the one that order[q] was.
  void reorder(const std::vector<std::uint32_t>& order);

  const Contact* data() const { return contacts_.data(); }
  std::uint32_t size() const { return static_cast<std::uint32_t>(contacts_.size()); }
  std::uint32_t* heads() { return heads_.data(); }
  /// Makes room for later steps.
  void reserve(std::size_t contacts) {
    contacts_.reserve(contacts);
    moved_.reserve(contacts_.capacity());
  }
  /// Makes room for the contacts of a step, instead of the others: nothing is in it yet.
  Contact* room_for(std::size_t contacts);
  /// Forgets the contacts after a step without any.
  void keep_none() { contacts_.clear(); }

  std::size_t memory_bytes() const {
    return sizeof(Contact) * contacts_.capacity() + sizeof(Moved) * moved_.capacity() +
           4 * heads_.capacity();
  }

 private:
  struct Moved {
    std::uint32_t to, first;
  };
  /// no_contact: it has none.
  std::uint32_t first_of(std::uint32_t particle) const;
  void rename(std::uint32_t first, std::uint32_t particle);

  std::vector<Contact> contacts_;
  std::vector<Moved> moved_;
  std::vector<std::uint32_t> heads_;  ///< per storage index, see kernels::is_contact_of
};

template <class Real>
struct ParticleStorage {
  std::vector<kernels::Particle<Real>> records;
  std::vector<std::uint64_t> keys;    ///< of blocks, per record; the sweeps keep them up to date
  std::vector<std::uint16_t> locals;  ///< model and cell in the block, per record
  Real largest_mass = 0;              ///< kg: none that was ever there has more, see refresh
  KeptContacts<Real> contacts;
  /// Pa, per record, that the shock viscosity of the last step added: found by the first change
  /// after that step, so that later ones at that moment leave the bits that they would leave
  /// together.
  std::vector<Real> shock_pressure;
  std::size_t shock_step = 0;  ///< steps that were done then
  static constexpr auto no_step = static_cast<std::size_t>(-1);
  /// Steps that were done when a change took C away or gave it: later changes at that moment give
  /// it by what holds then.
  std::size_t affine_step = no_step;
  Partition partition;
  Reordering<kernels::Particle<Real>> reordering;

  std::size_t size() const { return records.size(); }

  void resize(std::size_t count) {
    records.resize(count);
    keys.resize(count);
    locals.resize(count);
  }

  /// The last record takes its place. The partition is to be told afterwards: invalidate().
  void remove(std::size_t q) {
    contacts.remove(static_cast<std::uint32_t>(q), static_cast<std::uint32_t>(size() - 1));
    records[q] = records.back();
    keys[q] = keys.back();
    locals[q] = locals.back();
    resize(size() - 1);
    shock_pressure.clear();
  }

  /// Replaces the records: keys and locals are not known yet, and nothing is in contact.
  void replace(const std::vector<kernels::Particle<Real>>& others) {
    contacts.forget();
    shock_pressure.clear();
    affine_step = no_step;
    records = others;
    keys.assign(others.size(), 0);
    locals.assign(others.size(), 0);
    partition.invalidate();
  }

  std::uint64_t memory_bytes() const {
    return sizeof(kernels::Particle<Real>) * records.capacity() + reordering.memory_bytes() +
           8 * keys.capacity() + 2 * locals.capacity() + sizeof(Real) * shock_pressure.capacity() +
           partition.memory_bytes() + contacts.memory_bytes();
  }
};

}  // namespace neve::sim::engine

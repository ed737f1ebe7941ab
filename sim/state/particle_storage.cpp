#include "sim/state/particle_storage.h"

#include <algorithm>
#include <iterator>

namespace neve::sim::engine {

template <class Real>
std::vector<kernels::KeptContact<Real>> KeptContacts<Real>::list() const {
  std::vector<Contact> list;
  std::copy_if(contacts_.begin(), contacts_.end(), std::back_inserter(list),
               [](const Contact& c) { return c.particle != kernels::no_contact; });
  return list;
}

template <class Real>
void KeptContacts<Real>::replace(const std::vector<Contact>& contacts, std::size_t particles) {
  contacts_.clear();
  heads_.assign(contacts.empty() ? 0 : particles, kernels::no_contact);
  for (const Contact& contact : contacts) add(contact);
}

template <class Real>
void KeptContacts<Real>::add(const Contact& contact) {
  const std::uint32_t before = first_of(contact.particle);
  heads_[contact.particle] = size();
  contacts_.push_back(contact);
  contacts_.back().next = before;
}

template <class Real>
void KeptContacts<Real>::resize(std::size_t particles) {
  heads_.resize(particles, kernels::no_contact);
}

template <class Real>
std::uint32_t KeptContacts<Real>::first_of(std::uint32_t particle) const {
  if (particle >= heads_.size()) return kernels::no_contact;
  const std::uint32_t head = heads_[particle];
  const bool is_its_own = kernels::is_contact_of(contacts_.data(), size(), head, particle);
  return is_its_own ? head : kernels::no_contact;
}

/// The contact and those that follow it belong to another particle now.
template <class Real>
void KeptContacts<Real>::rename(std::uint32_t first, std::uint32_t particle) {
  for (std::uint32_t at = first; at != kernels::no_contact; at = contacts_[at].next)
    contacts_[at].particle = particle;
}

template <class Real>
void KeptContacts<Real>::remove(std::uint32_t q, std::uint32_t last) {
  rename(first_of(q), kernels::no_contact);
  const std::uint32_t moved = first_of(last);
  if (moved != kernels::no_contact) {
    rename(moved, q);
    heads_[q] = moved;
  }
  if (last < heads_.size()) heads_.resize(last);
}

template <class Real>
void KeptContacts<Real>::reorder(const std::vector<std::uint32_t>& order) {
  if (contacts_.empty()) return;
  moved_.clear();
  for (std::uint32_t q = 0; q < order.size(); ++q) {
    const std::uint32_t first = first_of(order[q]);
    if (first != kernels::no_contact) moved_.push_back({q, first});
  }
  resize(order.size());
  std::fill(heads_.begin(), heads_.end(), kernels::no_contact);
  for (const Moved& moved : moved_) {
    heads_[moved.to] = moved.first;
    rename(moved.first, moved.to);
  }
}

/// More than there ever were leave room for as many again.
template <class Real>
kernels::KeptContact<Real>* KeptContacts<Real>::room_for(std::size_t contacts) {
  if (contacts > contacts_.capacity()) {
    contacts_.clear();
    reserve(2 * contacts);
  }
  contacts_.resize(contacts);
  return contacts_.data();
}

template class KeptContacts<float>;
template class KeptContacts<double>;

}  // namespace neve::sim::engine

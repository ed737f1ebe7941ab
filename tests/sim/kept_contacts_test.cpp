/// Contacts that particles remember while their storage changes, and in saved states.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <utility>

#include "sim/simulation.h"
#include "sim/state/particle_storage.h"
#include "tests/support/snow.h"

namespace neve::sim {
namespace {

using Contacts = engine::KeptContacts<float>;
using Contact = Contacts::Contact;

Contact contact(std::uint32_t particle, int collider, float impulse) {
  return {impulse, {0, 0, 0}, 0.1f, particle, collider, kernels::no_contact};
}

/// Impulses by particle and collider, each of which a kernel finds from the particle's head.
std::map<std::pair<std::uint32_t, int>, float> found_in(Contacts& contacts, std::size_t particles) {
  std::map<std::pair<std::uint32_t, int>, float> found;
  contacts.resize(particles);
  for (std::uint32_t q = 0; q < particles; ++q) {
    std::uint32_t at = contacts.heads()[q];
    if (!kernels::is_contact_of(contacts.data(), contacts.size(), at, q)) continue;
    for (; at != kernels::no_contact; at = contacts.data()[at].next)
      found[{q, contacts.data()[at].collider}] = contacts.data()[at].impulse;
  }
  EXPECT_EQ(found.size(), contacts.list().size());
  return found;
}

TEST(KeptContacts, GoWithTheirParticles) {
  Contacts contacts;
  contacts.replace({contact(1, 0, 1), contact(4, 0, 2), contact(4, 2, 3), contact(2, 1, 4)}, 5);
  // The last particle takes the place of one without contacts, then of one with.
  contacts.remove(0, 4);
  EXPECT_EQ(found_in(contacts, 4),
            (std::map<std::pair<std::uint32_t, int>, float>{
                {{0, 0}, 2.f}, {{0, 2}, 3.f}, {{1, 0}, 1.f}, {{2, 1}, 4.f}}));
  contacts.remove(1, 3);
  contacts.remove(2, 2);
  EXPECT_EQ(found_in(contacts, 2),
            (std::map<std::pair<std::uint32_t, int>, float>{{{0, 0}, 2.f}, {{0, 2}, 3.f}}));
  contacts.resize(4);
  contacts.add(contact(3, 1, 5));
  contacts.reorder({3, 2, 0, 1});
  EXPECT_EQ(found_in(contacts, 4), (std::map<std::pair<std::uint32_t, int>, float>{
                                       {{0, 1}, 5.f}, {{2, 0}, 2.f}, {{2, 2}, 3.f}}));
  contacts.keep_none();
  EXPECT_TRUE(found_in(contacts, 4).empty());
}

/// Snow at rest on a floor, with a sink that takes some of it and an emitter above: the run is the
/// same from a saved state, wherever particles are stored.
TEST(KeptContacts, AreTheSameInARunThatWasSaved) {
  SolverSettings s;
  const std::vector<shapes::Collider> floor{test::plane({0, 0.013, 0}, {0, 1, 0}, 0.5)};
  const ParticleArrays snow = test::box_of_snow({0, 0.013, 0}, {0.12, 0.1, 0.12}, 0.01);
  seeding::Flow flow;
  seeding::Sink sink;
  sink.shape.form = shapes::Box{{0, 0.03, 0}, {0.05, 0.1, 0.3}};
  flow.sinks = {sink};
  const auto simulate = [&](const ParticleArrays& particles, int threads) {
    return Simulation(s, {Material{}}, floor, particles, threads, Vec3i::Zero(), flow);
  };
  Simulation whole = simulate(snow, 2);
  whole.advance_to(0.02);
  EXPECT_GT(whole.flow_totals().removed, 100u);
  Simulation again = simulate({}, 1);
  again.restore(whole.save());
  whole.advance_to(0.05);
  again.advance_to(0.05);
  EXPECT_EQ(whole.save(), again.save());
}

TEST(KeptContacts, OfNoParticleOrColliderAreRefused) {
  SolverSettings s;
  const ParticleArrays snow = test::box_of_snow({0, 0.013, 0}, {0.04, 0.05, 0.04}, 0.01);
  Simulation simulation(s, {Material{}}, {test::plane({0, 0.013, 0}, {0, 1, 0}, 0.5)}, snow, 1);
  for (int k = 0; k < 3; ++k) simulation.step(1e-4);
  const std::vector<std::uint8_t> good = simulation.save();
  simulation.restore_healthy(good);
  // The last contact is at the end: impulse, three of friction, distance, particle, collider.
  const auto refused = [&](std::size_t from_end, const auto& value) {
    std::vector<std::uint8_t> bytes = good;
    std::memcpy(bytes.data() + bytes.size() - from_end, &value, sizeof value);
    EXPECT_THROW(simulation.restore_healthy(bytes), SavedStateError) << from_end;
    EXPECT_EQ(simulation.save(), good);
  };
  refused(4, std::int32_t(1));
  refused(4, std::int32_t(-1));
  refused(8, static_cast<std::uint32_t>(snow.x.size()));
  refused(8, ~std::uint32_t(0));
  refused(48, std::nan(""));
  refused(16, -1.0);
}

}  // namespace
}  // namespace neve::sim

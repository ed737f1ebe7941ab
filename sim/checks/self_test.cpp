#include "sim/checks/self_test.h"

#include <exception>

#include "sim/checks/self_test_tests.h"
#include "sim/laws/law.h"

namespace neve::sim::checks {

namespace {

using self_test::Measure;

struct Test {
  const char* name;
  const char* what;
  void (*run)(const SelfTestCase&, Measure&);
};
constexpr Test tests_of_steps[] = {
    {"weights", "the sums of w, its moments and its gradient are exact", self_test::weights},
    {"affine_field", "a linear velocity field deforms by exactly I + dt A and returns",
     self_test::affine_field},
    {"stress", "is zero in a rotation, turns with the body, is symmetric", self_test::stress},
    {"force", "is minus the derivative of the elastic energy", self_test::force},
    {"solve", "semi-implicit velocities satisfy their equation", self_test::solve},
    {"projection", "keeps the identity and det F, clamps the stretches", self_test::projection},
    {"hardening", "is 1 at J_P = 1 and grows by the law", self_test::hardening}};
/// Tests that follow those of the laws.
constexpr Test tests_of_bodies[] = {
    {"initial_state", "has F_E = I, J_P = 1, no stress", self_test::initial_state},
    {"free_fall", "three steps are exact and deform nothing", self_test::free_fall},
    {"volumes", "estimated volumes are right inside and bounded everywhere", self_test::volumes},
    {"places", "snow that is not pulled apart moves by the velocity that strains it",
     self_test::places},
    {"drivers", "the fused and the staged driver give the same step", self_test::drivers},
    {"contact", "nodes, particles and the solve keep the law of contact, impulses close and last",
     self_test::contact},
    {"bodies", "get what snow loses, follow it and carry it", self_test::bodies},
    {"time_step", "the limits of dt see hardening, density, shear and colliders",
     self_test::time_step},
    {"sums", "mass, momenta and energies are those of the particles", self_test::sums},
    {"births", "births find room or wait", self_test::births}};

}  // namespace

std::vector<SelfTestCase> all_self_test_cases() {
  std::vector<SelfTestCase> cases;
  for (const Precision precision : {Precision::single, Precision::real64})
    for (const Kernel kernel : {Kernel::cubic, Kernel::quadratic})
      for (const Transfer transfer :
           {Transfer::flip, Transfer::apic, Transfer::mls, Transfer::aflip, Transfer::asflip})
        cases.push_back({kernel, transfer, precision});
  return cases;
}

namespace {

/// One test over all cases. @param run  run(case, measure)
template <class Run>
SelfTestResult result_of(const char* name, const char* what, std::span<const SelfTestCase> cases,
                         const Run& run) {
  SelfTestResult result{name, what, true, ""};
  double worst = -1;
  for (const SelfTestCase& one : cases) {
    Measure measure(one);
    try {
      run(one, measure);
      if (measure.worst() < 0) measure.failure("nothing was measured");
    } catch (const std::exception& error) {
      measure.failure(error.what());
    }
    if (!(measure.worst() > worst)) continue;
    worst = measure.worst();
    result.detail = measure.detail();
  }
  result.passed = worst >= 0 && worst <= 1;
  return result;
}

}  // namespace

std::vector<SelfTestResult> self_tests(std::span<const SelfTestCase> cases) {
  std::vector<SelfTestResult> results;
  const auto add = [&](std::span<const Test> tests) {
    for (const Test& test : tests)
      results.push_back(result_of(test.name, test.what, cases, test.run));
  };
  add(tests_of_steps);
  for (const laws::Law& law : laws::every())
    if (law.self_test)
      results.push_back(result_of(
          law.name, law.self_test->claim, cases,
          [&](const SelfTestCase& one, Measure& measure) { self_test::yield(law, one, measure); }));
  add(tests_of_bodies);
  return results;
}

}  // namespace neve::sim::checks
#pragma once
/// The self-tests one by one; self_test.cpp has the list.

#include "sim/checks/self_test_measure.h"
#include "sim/laws/law.h"

namespace neve::sim::checks::self_test {

// Laws of the step, on states made for them: self_test_laws.cpp.
void weights(const SelfTestCase& test, Measure& measure);
void affine_field(const SelfTestCase& test, Measure& measure);
void stress(const SelfTestCase& test, Measure& measure);
void force(const SelfTestCase& test, Measure& measure);
void projection(const SelfTestCase& test, Measure& measure);
void hardening(const SelfTestCase& test, Measure& measure);

// A law's own claims of a step that makes it yield: self_test_materials.cpp.
void yield(const laws::Law& law, const SelfTestCase& test, Measure& measure);

// Colliders: self_test_contact.cpp.
void contact(const SelfTestCase& test, Measure& measure);

// Colliders that snow moves: self_test_rigid.cpp.
void bodies(const SelfTestCase& test, Measure& measure);

// The semi-implicit step: self_test_implicit.cpp.
void solve(const SelfTestCase& test, Measure& measure);

// Bodies as a run has them: self_test_states.cpp.
void initial_state(const SelfTestCase& test, Measure& measure);
void free_fall(const SelfTestCase& test, Measure& measure);
void volumes(const SelfTestCase& test, Measure& measure);
void places(const SelfTestCase& test, Measure& measure);
void drivers(const SelfTestCase& test, Measure& measure);

// Around the steps: self_test_run.cpp.
void time_step(const SelfTestCase& test, Measure& measure);
void sums(const SelfTestCase& test, Measure& measure);
void births(const SelfTestCase& test, Measure& measure);

}  // namespace neve::sim::checks::self_test

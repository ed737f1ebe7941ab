#pragma once
/// The self-tests one by one; self_test.cpp has the list.

#include "sim/self_test_measure.h"

namespace neve::sim::self_test {

// Laws of the step, on states made for them: self_test_laws.cpp.
void weights(const SelfTestCase& test, Measure& measure);
void affine_field(const SelfTestCase& test, Measure& measure);
void stress(const SelfTestCase& test, Measure& measure);
void force(const SelfTestCase& test, Measure& measure);
void projection(const SelfTestCase& test, Measure& measure);
void hardening(const SelfTestCase& test, Measure& measure);

// The semi-implicit step: self_test_implicit.cpp.
void solve(const SelfTestCase& test, Measure& measure);

// Bodies as a run has them: self_test_states.cpp.
void initial_state(const SelfTestCase& test, Measure& measure);
void free_fall(const SelfTestCase& test, Measure& measure);
void volumes(const SelfTestCase& test, Measure& measure);
void drivers(const SelfTestCase& test, Measure& measure);

}  // namespace neve::sim::self_test

/// lanes.h as AVX2 runs it, for lanes_test.cpp.

#ifdef __x86_64__

#include "tests/support/lanes_probe.h"

namespace neve::test {

NEVE_DEFINE_LANES_PROBES(sim::kernels::Avx2Set)

}  // namespace neve::test

#endif

/// lanes.h as every machine of the architecture runs it, for lanes_test.cpp.

#include "tests/support/lanes_probe.h"

namespace neve::test {

NEVE_DEFINE_LANES_PROBES(sim::kernels::BaselineSet)

}  // namespace neve::test

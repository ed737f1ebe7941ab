#pragma once
/// Which instruction set the kernels use.

#include <stdexcept>
#include <string>

#include "sim/kernels/kernels.h"

namespace neve::sim::kernels {

/// NEVE_SIMD asks for something that does not exist or that this machine cannot run.
struct SimdError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

const char* name(SimdLevel level);

/// Can this build on this machine run it?
bool is_available(SimdLevel level);

/// The widest available one, or what the environment variable NEVE_SIMD (baseline, avx2, avx512)
/// asks for.
/// @throws SimdError
SimdLevel chosen_simd_level();

}  // namespace neve::sim::kernels

#pragma once
/// Instruction sets of the processor that runs this program.

namespace neve {

#if defined(__x86_64__)
/// True if code compiled for x86-64-v3 runs here. Every processor with these four has the rest of
/// v3; compilers name the level itself differently.
inline bool runs_x86_64_v3() {
  return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") &&
         __builtin_cpu_supports("bmi") && __builtin_cpu_supports("bmi2");
}
/// True if code compiled for x86-64-v4 runs here.
inline bool runs_x86_64_v4() {
  return runs_x86_64_v3() && __builtin_cpu_supports("avx512f") &&
         __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512cd") &&
         __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl");
}
#endif

}  // namespace neve

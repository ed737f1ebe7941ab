#pragma once
/// Properties of this machine: memory, the folder of the program, the installed scenes.

#include <cstdint>
#include <filesystem>
#include <string>

namespace neve::app {

/// Bytes that can be had without swapping: the least of the system's estimate and what the control
/// group still allows.
std::uint64_t available_memory();

/// Bytes that work may take where nothing else is said: 80 % of the available memory.
std::uint64_t usable_memory();

/// Bytes of address space that this process may use (ulimit -v); the largest number when unlimited.
std::uint64_t address_space_limit();

/// The name of this machine; "" if it has none.
std::string host_name();

/// "AMD EPYC, 2 cores; GCC 12.2.0": the circumstances of a measurement.
std::string machine_text();

/// The threads that --threads means: as given, or for 0 one per core.
int core_count(int threads);

/// The file of the running program. @throws IoError
std::filesystem::path this_program();

/// The scene that is drawn when none is named. @throws IoError when it is not there
std::filesystem::path default_scene();

}  // namespace neve::app

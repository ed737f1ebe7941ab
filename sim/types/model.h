#pragma once
/// The law that a material follows.

#include <cstdint>

namespace neve::sim {

/// The number of a law in sim/laws/list.h, which has their names; 0 is the paper's snow.
enum class Model : std::uint8_t {};

}  // namespace neve::sim

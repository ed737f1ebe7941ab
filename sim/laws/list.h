/// The laws of materials, in the order of their numbers, which saved states have: a new one comes
/// last. Law NAME is the file sim/laws/NAME.h; nothing but that file and this list knows its name.
///
/// As it is, a file of names alone. sim/laws/files.h reads it once more for the laws themselves, so
/// it may be included twice.

#ifndef NEVE_LAWS
#define NEVE_LAWS(LAW) LAW(snow) LAW(corotated) LAW(neo_hookean) LAW(cam_clay) LAW(sand)

#include "sim/types/model.h"

namespace neve::sim::laws::model {

#define NEVE_NUMBER_OF_LAW(name) number_of_##name,
enum Number : std::uint8_t { NEVE_LAWS(NEVE_NUMBER_OF_LAW) law_count };
#undef NEVE_NUMBER_OF_LAW

#define NEVE_MODEL_OF_LAW(name) inline constexpr Model name{number_of_##name};
NEVE_LAWS(NEVE_MODEL_OF_LAW)
#undef NEVE_MODEL_OF_LAW

}  // namespace neve::sim::laws::model

namespace neve::sim::laws {

inline constexpr int law_count = model::law_count;

}  // namespace neve::sim::laws
#endif

#ifdef NEVE_LAW_FILES
#include "sim/laws/cam_clay.h"
#include "sim/laws/corotated.h"
#include "sim/laws/neo_hookean.h"
#include "sim/laws/sand.h"
#include "sim/laws/snow.h"
#endif

#pragma once
/// JSON Schema of sweep files, with the parameters of scenes at their addresses.

#include "app/support/json.h"

namespace neve::app::sweep::read {

Json sweep_schema();

}  // namespace neve::app::sweep::read

#pragma once
/// All laws with all that they have; only what is compiled with every law includes it.

#define NEVE_LAW_FILES
#include "sim/laws/list.h"

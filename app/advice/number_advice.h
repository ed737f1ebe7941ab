#pragma once
/// Advice on texts where numbers are expected: units, quotes, commas, brackets.

#include <string>
#include <string_view>

#include "app/scene/toml/value.h"

namespace neve::app::advice {

/// "numbers have no unit: in Pa it is 1.4e+08" of "140 MPa"; "" if nothing is known about it.
/// @param unit  of the parameter, as in describe.h
std::string number_advice(std::string_view text, std::string_view unit);

/// "write [0, -9.81, 0]" of "0,-9.81,0" or -9.81 where a vector is expected; "": none.
std::string vector_advice(const scene::toml::Value& value, const std::string& address);

}  // namespace neve::app::advice

#pragma once
/// Advice on texts where a number is expected: units, quotes, commas.

#include <string>
#include <string_view>

namespace neve::app::scene {

/// "numbers have no unit: in Pa it is 1.4e+08" of "140 MPa"; "" where nothing is known about it.
/// @param unit  of the parameter, as in describe.h
std::string number_advice(std::string_view text, std::string_view unit);

}  // namespace neve::app::scene

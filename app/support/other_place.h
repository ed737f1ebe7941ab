#pragma once
/// Advice where a file cannot be written: the way to another place that the command has.

#include <string>

namespace neve::app {

/// That of commands with --out whose outputs go into out_folder() without it.
inline constexpr const char* usual_other_place = "choose another folder with --out or NEVE_OUT";

/// Before the command runs. @param advice  "": it writes nowhere that a person chooses
void set_other_place(const std::string& advice);

/// "wait for it, or choose another folder with --out or NEVE_OUT".
/// @param first  what else helps; "": nothing
std::string or_other_place(const std::string& first = {});

}  // namespace neve::app

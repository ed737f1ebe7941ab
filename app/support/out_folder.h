#pragma once
/// The folder that outputs go into where no --out names one, and what a folder holds.

#include <cstdlib>
#include <filesystem>
#include <string>
#include <system_error>

namespace neve::app {

/// NEVE_OUT, or "out" in the current folder.
inline std::filesystem::path out_folder() {
  const char* chosen = std::getenv("NEVE_OUT");
  return chosen && *chosen ? std::filesystem::path(chosen) : std::filesystem::path("out");
}

/// "DIR" of "DIR/", as completion in a shell writes it.
inline std::filesystem::path without_slash(const std::filesystem::path& folder) {
  return folder.has_filename() ? folder : folder.parent_path();
}

/// True for a folder that holds a sweep, with its manifest.
inline bool is_sweep_folder(const std::filesystem::path& folder) {
  std::error_code error;
  return std::filesystem::is_regular_file(folder / "manifest.json", error);
}

/// The advice of commands with --out whose outputs go into out_folder() without it.
inline constexpr const char* usual_other_place = "choose another folder with --out or NEVE_OUT";

/// Sets the advice before the command runs. @param advice  "" if no person chooses where it writes
void set_other_place(const std::string& advice);

/// "wait for it, or choose another folder with --out or NEVE_OUT".
/// @param first  what else helps; "": nothing
std::string or_other_place(const std::string& first = {});

}  // namespace neve::app

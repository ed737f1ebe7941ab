#pragma once
/// Words over pictures, with values of the scene in braces: "{shot.name} {frame}".

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "app/scene/check.h"
#include "app/scene/live_change.h"
#include "app/scene/scene.h"

namespace neve::app::scene {

/// Values of a picture that its scene does not have.
struct PictureWords {
  int frame = 0;  ///< counted from 0
  double time = 0;
  std::string view, changes;
};

/// The six texts of burn_in with their values, in the order of its parameters. A brace that is
/// meant as one is written twice.
std::array<std::string, 6> burnt_in(const Scene& scene, const PictureWords& words);

/// "hardening = 5" for "material.snow.hardening=5", "post center = ..." for a value of a collider;
/// the whole address where two are named alike. None for other cameras, views and colours: these
/// are seen; and none of what a later one replaces, with its table say.
std::vector<std::string> override_lines(const std::vector<std::string>& overrides);

/// "hardening = 5 since step 120", "added collider.ball at step 120".
std::vector<std::string> change_lines(const std::vector<LiveChange>& changes);

/// All changes of a picture: those from the start, then those of a run.
std::vector<std::string> change_lines(const std::vector<std::string>& overrides,
                                      const std::vector<LiveChange>& changes);

/// The scene of a run that has these changes in it: its {changes} are these, since nothing will
/// tell it of others.
void write_changes(const std::vector<std::string>& overrides, Scene& scene);

inline bool has_burn_in(const BurnIn& b) {
  return !(b.top_left + b.top + b.top_right + b.bottom_left + b.bottom + b.bottom_right).empty();
}

/// Braces that name nothing, and time codes that are none.
std::optional<Problem> shot_problem(const Scene& scene);

/// "1001-1049": the numbers of the shot, without handles.
std::string range_text(const Scene& scene);

/// The time code of a frame with this number: that of its number, or counted from shot.time_code.
/// @param fps  of the movie
std::string time_code_of(const Scene& scene, int number, double fps);

/// @param movie_fps  rate that somebody asked for; 0: nobody did
/// @throws UsageError where shot.time_code is none of a movie at that rate
void require_time_code(const Scene& scene, double movie_fps);

/// Returns the time code of a movie of this scene; "" if neither its numbers nor its shot give one.
/// @param first      number of its first picture
/// @param movie_fps  rate that somebody asked for; 0: that of the scene
std::string time_code_of_movie(const Scene& scene, int first, double movie_fps);

}  // namespace neve::app::scene

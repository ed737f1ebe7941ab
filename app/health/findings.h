#pragma once
/// Questions of `neve check`; each adds its findings.

#include "app/health/check.h"
#include "app/setup/coarse_run.h"
#include "app/setup/seed_scene.h"
#include "sim/health/limits.h"

namespace neve::app::health {

/// "0.7 %", "31 %".
std::string percent_text(double share);

/// "[0, 1, 0]"
std::string vector_text(const sim::Vec3d& v);

/// "ball", or "body 1" of a body that has a number for a name.
std::string display_name(const std::string& kind, const std::string& name);

/// Key of the parameter that moves a collider most, ".velocity"; "" of a body that falls.
/// @param speed  m/s, its largest
const char* fastest_part(const sim::shapes::Collider& collider, double speed);

/// Particles: the grid cannot tell more of them apart in a cell.
inline constexpr double max_useful_per_cell = 40;

/// The thinnest part of a shape, m.
double thickness(const sim::shapes::Shape& shape);

/// Numbers that look like centimetres, grams or kilopascals, and those of a material of nothing.
/// @param coarsening the N of --coarsen, for advice
void check_units(const scene::Scene& scene, std::vector<Finding>& findings, double coarsening = 1);

/// Returns the doubts of the law of a material about its numbers.
std::vector<Finding> law_findings(const sim::Material& m);

/// Numbers that mean something else than they seem to: gravity in g, thresholds in thousandths,
/// radians, a turntable in degrees, a light from below. check_units asks it.
void check_senses(const scene::Scene& scene, std::vector<Finding>& findings);

/// Bodies and colliders a few cells thick, too few particles in a cell.
/// @param coarsening the N of --coarsen, for advice
void check_resolution(const scene::Scene& scene, std::vector<Finding>& findings,
                      double coarsening = 1);

/// Emitters that never open, are thinner than particles are apart, or are asked for more snow than
/// their velocity, or gravity, carries away.
void check_emitters(const scene::Scene& scene, std::vector<Finding>& findings,
                    double coarsening = 1);

/// Why snow of an emitter finds no room, and what lets it out.
struct Clogging {
  bool is_by_rate = false;  ///< check_emitters says it before the run
  std::string cause, remedy;
};
/// @param share  of what it was asked for so far, that found no room
/// @return nothing where the scene has no such emitter
std::optional<Clogging> clogging(const scene::Scene& scene, const std::string& emitter,
                                 double share);

/// Sinks that fast snow crosses between two tests. @param speed m/s, of the fastest snow
void check_sinks(const scene::Scene& scene, double speed, std::vector<Finding>& findings);

/// Settings without effect: bodies and emitters in sinks, keyframes after the last frame, slices
/// that no layer shows, values that other settings switch off.
/// @param coarsening the N of --coarsen
void check_unused(const scene::Scene& scene, double coarsening, std::vector<Finding>& findings);

/// Why a value at an address changes nothing in a scene: it belongs to another law, or to steps
/// that are chosen otherwise; "" where it may change something.
std::string why_idle(const scene::Scene& scene, const std::string& address);
/// Warns of values that somebody, or a curve, has set and that are idle.
void check_idle(const scene::Scene& scene, std::vector<std::string> addresses,
                std::vector<Finding>& findings);

/// "material.snow.dust = 0.02", of a material that snow of the scene has.
std::string advice_on_dust(const scene::Scene& scene);

/// Dust that never flies, that nothing shows, and that it takes time. @param speed m/s, of the
/// fastest snow
void check_dust(const scene::Scene& scene, double speed, std::vector<Finding>& findings);

/// Bodies in one another and in colliders, points that weigh too much.
void check_overlaps(const scene::Scene& scene, const setup::SeededScene& seeded,
                    std::vector<Finding>& findings);

/// Bodies that meet no collider and no other body, in free flight until the scene ends.
void check_meetings(const scene::Scene& scene, const setup::SeededScene& seeded,
                    std::vector<Finding>& findings);

/// Gravity that does not point down, along -y, for the cameras of the scene.
void check_gravity(const scene::Scene& scene, std::vector<Finding>& findings);

/// Bodies and emitters in colliders.
void check_collider_overlaps(const scene::Scene& scene, const setup::SeededScene& seeded,
                             std::vector<Finding>& findings);

/// Bodies whose joint or `hold` takes a part of the motion away that the scene gives them.
void check_starts_of_held(const scene::Scene& scene, std::vector<Finding>& findings);

/// Colliders that move by themselves: in one another, held by nothing or by everything, of a
/// density that nothing has, smaller than snow can feel.
/// @param moments  of a coarse run @param coarsening  of the scene
void check_moving_bodies(const scene::Scene& scene, const std::vector<setup::CoarseMoment>& moments,
                         double coarsening, std::vector<Finding>& findings);

/// Colliders that cross too much of a cell in a step, or outrun sound in the snow.
void check_motion(const scene::Scene& scene, const Check& check, std::vector<Finding>& findings);

/// Damping of the transfer per frame, spin that it stops.
void check_transfer(const scene::Scene& scene, const Check& check, std::vector<Finding>& findings);

/// Steps so short that float rounds away the motion of slow snow, or gravity.
/// @param coarsening the N of --coarsen, for advice
void check_rounding(const scene::Scene& scene, std::vector<Finding>& findings,
                    double coarsening = 1);

/// Fixed steps against the limits, the transfer, speed against sound.
void check_steps(const scene::Scene& scene, const Check& check, std::vector<Finding>& findings);

/// Says that sound crossed more cells in a fixed step than any step may; "" where it did not.
std::string unstable_steps(const sim::SolverSettings& settings, const sim::Warnings& warnings);

/// Snow that cameras named by the scene do not see. @param scene resolved
void check_cameras(const scene::Scene& scene, const std::vector<setup::CoarseMoment>& moments,
                   std::vector<Finding>& findings);

/// False for a body that is alone in the world.
bool has_something_to_hit(const scene::Scene& scene);

}  // namespace neve::app::health

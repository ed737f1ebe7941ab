/// Heights of snow at rest on planes, at every fraction of a cell and tilt, by both contacts.

#include "tests/support/rest.h"

#include <gtest/gtest.h>

#include <string>

#include "tests/support/snow.h"
#include "tests/support/verification.h"

namespace {

using namespace neve::sim;
using namespace neve::test;

TEST(RestTable, SnowRestsAtEveryFractionAndTilt) {
  for (const bool is_flip : {true, false})
    for (const double degrees : {0.0, 10.0, 20.0, 30.0, 45.0})
      for (const double fraction : {0.0, 0.05, 0.25, 0.5, 0.75, 0.95}) {
        const RestingPlace place = tilted_place(fraction, degrees);
        const std::string line = std::string(is_flip ? "FLIP cubic" : "MLS quadratic") + ", " +
                                 in_digits(degrees) + "°, " + in_digits(fraction) + " cells";
        Method method = is_flip ? flip_cubic() : mls_quadratic();
        method.contact_at = ContactAt::nodes;
        const shapes::Collider floor = plane(place.point, place.normal, 0.5);
        const Rest held = rest_on(floor, place, method);
        keep_number({"rest table", line, "gap by held nodes, cells"}, held.gap);
        keep_number({"rest table", line, "its spread"}, held.spread);
        method.contact_at = ContactAt::particles;
        const Rest pressed = rest_on(floor, place, method);
        // The bound is that of Rest: 0.15 cells is less than a third of the particles' spacing.
        verify_near({"rest table", line, "gap by contact at particles, cells"}, 0, pressed.gap,
                    0.15);
        verify_at_most({"rest table", line, "its spread, at particles"}, 0.15, pressed.spread);
        EXPECT_NEAR(pressed.rise, 0, 0.15) << line;
        EXPECT_GE(pressed.lowest, -0.1) << line;
      }
}

/// The same block in finer cells: what is left of the gap is a share of a cell.
TEST(RestTable, TheGapShrinksWithTheCells) {
  for (const ContactAt contact_at : {ContactAt::particles, ContactAt::nodes})
    for (const int finer : {1, 2, 4}) {
      const RestingPlace place = tilted_place(0.25, 20, finer);
      Method method = flip_cubic();
      method.contact_at = contact_at;
      const Rest rest = rest_on(plane(place.point, place.normal, 0.5), place, method);
      const double millimetres = 1000 * place.cell();
      const bool is_at_particles = contact_at == ContactAt::particles;
      const std::string line = std::string(is_at_particles ? "particles" : "nodes") +
                               ", cells of " + in_digits(millimetres) + " mm";
      keep_number({"rest in finer cells", line, "gap, mm"}, rest.gap * millimetres);
      keep_number({"rest in finer cells", line, "its spread, mm"}, rest.spread * millimetres);
      // The bound is that of Rest: less than a third of the particles' spacing at every h.
      if (is_at_particles) {
        EXPECT_NEAR(rest.gap, 0, 0.15) << line;
      }
    }
}

}  // namespace

#pragma once
/// Rounding to 1, 2 or 5 times a power of ten.

namespace neve::app {

/// The smallest of 1, 1.2, 1.5, 2, 2.5, 3, 4, 5, 6, 8 times a power of ten that is at least x; 0
/// for x <= 0.
double round_up(double x);
/// The largest of 1, 2, 5 times a power of ten that is at most x; 0 for x <= 0.
double round_down(double x);
/// x to so many significant digits of `scale`.
double round_to(double x, double scale, int digits);

}  // namespace neve::app

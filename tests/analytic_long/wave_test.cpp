/// Dispersion and damping of every transfer and kernel down to four cells a wavelength.

#include "tests/support/balls_checks.h"
#include "tests/support/plane_wave.h"
#include "tests/support/verification.h"

namespace {

using namespace neve::sim;
using namespace neve::test;

TEST(PlaneWaveLong, HasTheEigenvaluesOfItsSchemeAtEveryWavelength) {
  // 1 to 8 waves in 32 cells, 4 particles a cell. Linear theory; the rest is below 1e-5 at strains
  // of 1e-4.
  for (const Transfer transfer : {Transfer::flip, Transfer::apic, Transfer::mls})
    for (const Kernel kernel : {Kernel::cubic, Kernel::quadratic}) {
      Curve curve("dispersion_" + file_name(name(transfer) + " " + name(kernel)),
                  "k h (rad), omega / (c k) longitudinal, shear, predicted of both, decay / (c k) "
                  "longitudinal, shear, predicted of both");
      for (int waves = 1; waves <= 8; ++waves) {
        WaveCase wave;
        wave.transfer = transfer;
        wave.kernel = kernel;
        wave.cells = 32;
        wave.waves = waves;
        wave.cfl = transfer == Transfer::flip ? 0.05 : 0.2;
        Oscillation measured[2], expected[2];
        double ck[2], worst = 0;
        for (const int is_shear : {0, 1}) {
          wave.is_shear = is_shear == 1;
          expected[is_shear] = predicted_wave(wave);
          measured[is_shear] = measured_wave(wave);
          ck[is_shear] = wave.c() * wave.k();
          worst = std::max(
              {worst, std::abs(measured[is_shear].omega - expected[is_shear].omega) / ck[is_shear],
               std::abs(measured[is_shear].decay - expected[is_shear].decay) / ck[is_shear]});
        }
        curve.add({wave.k() * wave.h(), measured[0].omega / ck[0], measured[1].omega / ck[1],
                   expected[0].omega / ck[0], expected[1].omega / ck[1], measured[0].decay / ck[0],
                   measured[1].decay / ck[1], expected[0].decay / ck[0],
                   expected[1].decay / ck[1]});
        verify_at_most({"wave_long",
                        name(transfer) + " " + name(kernel) + ", wavelength " +
                            in_digits(32.0 / waves, 3) + " h",
                        "largest error of (ω, decay) / (c k), both polarisations"},
                       1e-4, worst);
      }
    }
}

}  // namespace

/// Dispersion and damping of every transfer and kernel down to four cells a wavelength.

#include "tests/support/plane_wave.h"
#include "tests/support/verification.h"

namespace {

using namespace neve::sim;
using namespace neve::test;

WaveCase wave_of(Transfer transfer, Kernel kernel, bool is_shear, double waves) {
  WaveCase wave;
  wave.transfer = transfer;
  wave.kernel = kernel;
  wave.is_shear = is_shear;
  wave.cells = 32;
  wave.waves = waves;
  wave.per_cell = 2;
  wave.cfl = transfer == Transfer::flip ? 0.1 : 0.2;
  return wave;
}

TEST(PlaneWaveLong, PlaneWaveHasTheEigenvaluesOfItsSchemeAtEveryWavelength) {
  // 1 to 8 waves in 32 cells, 2 particles a cell. Linear theory; the rest is below 1e-5 at strains
  // of 1e-4.
  for (const Transfer transfer : {Transfer::flip, Transfer::apic, Transfer::mls})
    for (const Kernel kernel : {Kernel::cubic, Kernel::quadratic}) {
      const std::string scheme = file_name(name(transfer) + " " + name(kernel));
      const std::string columns =
          "cells per wavelength^-1, omega / (c k) longitudinal, shear, decay / (c k) of both";
      Curve curve("dispersion_" + scheme, columns), theory("dispersion_theory_" + scheme, columns);
      double worst = 0;
      for (int waves = 1; waves <= 8; ++waves) {
        Oscillation measured[2], expected[2];
        double ck[2];
        for (const int is_shear : {0, 1}) {
          const WaveCase wave = wave_of(transfer, kernel, is_shear == 1, waves);
          expected[is_shear] = predicted_wave(wave);
          measured[is_shear] = measured_wave(wave);
          ck[is_shear] = wave.c() * wave.k();
          worst = std::max(
              {worst, std::abs(measured[is_shear].omega - expected[is_shear].omega) / ck[is_shear],
               std::abs(measured[is_shear].decay - expected[is_shear].decay) / ck[is_shear]});
        }
        curve.add({waves / 32.0, measured[0].omega / ck[0], measured[1].omega / ck[1],
                   measured[0].decay / ck[0], measured[1].decay / ck[1]});
      }
      for (double waves = 0.5; waves <= 8.2; waves += 0.25) {
        const WaveCase p = wave_of(transfer, kernel, false, waves);
        const WaveCase s = wave_of(transfer, kernel, true, waves);
        const Oscillation of_p = predicted_wave(p), of_s = predicted_wave(s);
        theory.add({waves / 32, of_p.omega / (p.c() * p.k()), of_s.omega / (s.c() * s.k()),
                    of_p.decay / (p.c() * p.k()), of_s.decay / (s.c() * s.k())});
      }
      verify_at_most({"wave_long", name(transfer) + " " + name(kernel),
                      "largest error of (ω, decay) / (c k), 16 waves"},
                     1e-4, worst);
    }
}

}  // namespace

/// Plane waves: the numerical dispersion and damping of every transfer and kernel.

#include "tests/support/plane_wave.h"
#include "tests/support/verification.h"

namespace {

using namespace neve::sim;
using namespace neve::test;

TEST(PlaneWave, PlaneWaveOfFlipFollowsTheClosedFormula) {
  // omega = c k sinc(kh/2)^(2q) is for endless particles and small steps. Four particles a cell
  // leave 1e-5 (cubic) and, at 8 cells a wavelength, 1.4e-3 (quadratic); the step (c dt/h = 0.05)
  // adds 1e-4.
  const auto check = [](Kernel kernel, bool is_shear, int cells) {
    WaveCase wave;
    wave.kernel = kernel;
    wave.is_shear = is_shear;
    wave.cells = cells;
    const Oscillation o = measured_wave(wave);
    verify_ratio({"wave_formula", wave.label() + ", wavelength " + std::to_string(cells) + " h",
                  "ω / (c k)"},
                 flip_dispersion(kernel, wave.k() * wave.h()), o.omega / (wave.c() * wave.k()),
                 kernel == Kernel::cubic ? 3e-4 : 2e-3);
  };
  for (const Kernel kernel : {Kernel::cubic, Kernel::quadratic}) {
    check(kernel, false, 8);
    check(kernel, false, 16);
    check(kernel, true, 8);
  }
}

void check_against_eigenvalues(const WaveCase& wave, double tolerance) {
  const Oscillation expected = predicted_wave(wave), o = measured_wave(wave);
  const std::string line = wave.label() + ", " + name(wave.precision) +
                           (wave.transfer == Transfer::flip && wave.flip_ratio < 1
                                ? ", alpha = " + in_digits(wave.flip_ratio)
                                : "");
  const double ck = wave.c() * wave.k();
  verify_near({"wave_exact", line, "ω / (c k)"}, expected.omega / ck, o.omega / ck, tolerance);
  verify_near({"wave_exact", line, "decay / (c k)"}, expected.decay / ck, o.decay / ck, tolerance);
}

/// Two particles a cell and steps of an ordinary size: the linear theory of the scheme needs
/// neither many nor small ones.
WaveCase ordinary_wave() {
  WaveCase wave;
  wave.cells = 8;
  wave.per_cell = 2;
  wave.cfl = 0.2;
  return wave;
}

TEST(PlaneWave, PlaneWaveHasTheEigenvaluesOfItsScheme) {
  // The theory is exact for small waves; at strains of 1e-4 the rest is 2e-6.
  for (const Transfer transfer : {Transfer::flip, Transfer::apic, Transfer::mls})
    for (const Kernel kernel : {Kernel::cubic, Kernel::quadratic})
      for (const bool is_shear : {false, true}) {
        WaveCase wave = ordinary_wave();
        wave.transfer = transfer;
        wave.kernel = kernel;
        wave.is_shear = is_shear;
        check_against_eigenvalues(wave, 1e-5);
      }
}

TEST(PlaneWave, PlaneWaveOfSmearedFlipHasTheEigenvaluesOfItsScheme) {
  WaveCase wave = ordinary_wave();
  wave.cells = 16;
  for (const double alpha : {0.95, 0.5, 0.0}) {
    wave.flip_ratio = alpha;
    check_against_eigenvalues(wave, 1e-5);
  }
}

TEST(PlaneWave, PlaneWaveInFloatHasTheEigenvaluesOfItsScheme) {
  // F near 1 is known to 6e-8, strains are 1e-3: 6e-5, partly averaged out.
  WaveCase wave = ordinary_wave();
  wave.precision = Precision::single;
  check_against_eigenvalues(wave, 1e-4);
  wave.transfer = Transfer::mls;
  wave.kernel = Kernel::quadratic;
  check_against_eigenvalues(wave, 1e-4);
}

TEST(FlipShare, FlipShareDampsWavesPerSecondNotPerStep) {
  // alpha^(dt/reference) takes the same share of a wave per second whatever the step; what FLIP
  // with alpha = 1 damps by itself, in proportion to dt, comes on top. An alpha per step damps
  // twice as much at half the step.
  WaveCase wave = ordinary_wave();
  wave.cells = 16;
  wave.flip_ratio = 0.95;
  std::vector<double> with_reference, per_step;
  for (const double cfl : {0.2, 0.1, 0.05}) {
    wave.cfl = cfl;
    for (const double reference_dt : {5e-4, 0.0}) {
      wave.flip_reference_dt = reference_dt;
      const double decay = measured_wave(wave).decay;
      (reference_dt > 0 ? with_reference : per_step).push_back(decay);
      verify_ratio({"flip_share",
                    std::string(reference_dt > 0 ? "flip_reference_dt = 0.5 ms" : "per step") +
                        ", c dt/h = " + in_digits(cfl),
                    "decay, 1/s"},
                   predicted_wave(wave).decay, decay, 1e-4);  // linear theory, as above
    }
  }
  // The theory gives 2.66, 2.56, 2.51 (FLIP's own share falls with dt) against 3.6, 7.0, 13.8.
  verify_near(
      {"flip_share", "flip_reference_dt = 0.5 ms, step cut to a quarter", "ratio of decays"}, 1,
      with_reference[2] / with_reference[0], 0.1);
  verify_near({"flip_share", "per step, step cut to a quarter", "ratio of decays"}, 4,
              per_step[2] / per_step[0], 0.4);
}

}  // namespace

#pragma once
/// Standing plane waves in a periodic elastic medium: what theory predicts, what the solver does.

#include <numbers>

#include "tests/support/elastic.h"

namespace neve::test {

struct WaveCase {
  Transfer transfer = Transfer::flip;
  Kernel kernel = Kernel::cubic;
  bool is_shear = false;
  int cells = 16;                ///< length of the box, a multiple of 4
  double waves = 1;              ///< wavelengths in it
  int per_cell = 4;              ///< particles per cell along the wave
  double cfl = 0.05;             ///< c dt / h of the longitudinal wave
  double flip_ratio = 1;         ///< alpha
  double flip_reference_dt = 0;  ///< s
  double beta = 0;               ///< of semi-implicit steps
  sim::Precision precision = sim::Precision::real64;

  static constexpr double density = 400, youngs_modulus = 1e5, poisson_ratio = 0.25;
  sim::Material material() const { return elastic(youngs_modulus, poisson_ratio, density); }
  double h() const { return 1.0 / cells; }
  double dt() const { return cfl * h() / sim::sound_speed(material()); }
  /// Speed of the wave in the continuum, m/s.
  double c() const {
    return is_shear ? std::sqrt(sim::lame(youngs_modulus, poisson_ratio).mu / density)
                    : sim::sound_speed(material());
  }
  double k() const { return 2 * std::numbers::pi * waves; }
  std::string label() const {
    return name(transfer) + " " + name(kernel) + ", " + (is_shear ? "shear" : "longitudinal");
  }
};

/// omega / (c k) of FLIP with alpha = 1, many particles and small steps: P2G, grad v, force and G2P
/// smooth once each by the transform of the B-spline, sinc(kh/2)^q, and two of the four act on one
/// period: sinc(kh/2)^(2q).
inline double flip_dispersion(Kernel kernel, double kh) {
  return std::pow(std::sin(kh / 2) / (kh / 2), kernel == Kernel::cubic ? 8 : 6);
}

/// The same of APIC, whose velocities live on the nodes: only grad v and force are left.
inline double apic_dispersion(Kernel kernel, double kh) {
  return std::sqrt(flip_dispersion(kernel, kh));
}

/// B-spline and its derivative, from the definition. @param x in cells
struct Spline {
  double value, slope;
};
inline Spline spline(Kernel kernel, double x) {
  const double r = std::abs(x), sign = x < 0 ? -1 : 1;
  if (kernel == Kernel::cubic) {
    if (r < 1) return {r * r * r / 2 - r * r + 2.0 / 3, sign * (1.5 * r * r - 2 * r)};
    if (r < 2) return {std::pow(2 - r, 3) / 6, -sign * (2 - r) * (2 - r) / 2};
    return {0, 0};
  }
  if (r < 0.5) return {0.75 - r * r, -2 * x};
  if (r < 1.5) return {(1.5 - r) * (1.5 - r) / 2, -sign * (1.5 - r)};
  return {0, 0};
}

/// Exact small oscillation of the discrete scheme: eigenvalues of the 2 x 2 matrix that takes a
/// wave on the nodes through one step. With W, S, A the sums over nodes of w, dw/dx, w (x_i - x_p)
/// times e^(ik x_i), averaged over the particles of a cell: M = |W|^2 smooths what goes to the
/// particles and back, G = |S|^2 (MLS: |A|^2/D^2) is what grad v and force make of it, and
/// R = M + |A|^2/D is the round trip of v and C.
inline Oscillation predicted_wave(const WaveCase& wave) {
  const double h = wave.h(), dt = wave.dt(), c = wave.c(), kh = wave.k() * h;
  const double D = h * h / (wave.kernel == Kernel::cubic ? 3 : 4);
  double M = 0, S2 = 0, A2 = 0;
  for (int p = 0; p < wave.per_cell; ++p) {
    std::complex<double> W, S, A;
    for (int i = -2; i <= 3; ++i) {
      const double x = (p + 0.5) / wave.per_cell;
      const Spline n = spline(wave.kernel, x - i);
      const std::complex<double> phase = std::polar(1.0, kh * i);
      W += n.value * phase, S += n.slope / h * phase, A += n.value * (i - x) * h * phase;
    }
    M += std::norm(W) / wave.per_cell;
    S2 += std::norm(S) / wave.per_cell;
    A2 += std::norm(A) / wave.per_cell;
  }
  const double G = wave.transfer == Transfer::mls ? A2 / (D * D) : S2;
  // v: velocity on the nodes before forces; e: strain, as the nodes feel it.
  // v_new = (v - dt c^2 e) / (1 + beta dt^2 c^2 G);  e' = e + dt G v_new;  v' = keep v + pass
  // v_new.
  double keep = 0, pass = M + A2 / D;
  if (wave.transfer == Transfer::flip) {
    const double alpha = wave.flip_reference_dt > 0
                             ? std::pow(wave.flip_ratio, dt / wave.flip_reference_dt)
                             : wave.flip_ratio;
    keep = alpha * (1 - M), pass = M;
  }
  const double f = dt * c * c, solved = 1 / (1 + wave.beta * dt * f * G);
  const Eigen::Matrix2d step{{keep + pass * solved, -pass * solved * f},
                             {dt * G * solved, 1 - dt * G * solved * f}};
  const std::complex<double> half_trace = 0.5 * step.trace();
  const std::complex<double> root =
      half_trace + std::sqrt(half_trace * half_trace - step.determinant());
  const std::complex<double> rate = std::log(root) / dt;
  return {std::abs(rate.imag()), -rate.real()};
}

/// Runs the solver for slightly more than a period. One particle per cell across the wave is
/// enough: there fields are constant and weights sum to 1.
inline Oscillation measured_wave(const WaveCase& wave) {
  sim::SolverSettings s;
  s.cell_size = wave.h();
  s.kernel = wave.kernel;
  s.transfer = wave.transfer;
  s.flip_ratio = wave.flip_ratio;
  s.flip_reference_dt = wave.flip_reference_dt;
  s.beta = wave.beta;
  s.solve_tolerance = 1e-12;
  s.precision = wave.precision;
  s.gravity.setZero();
  s.period = {wave.cells / 4, 1, 1};
  const double width = 4 * s.cell_size;
  ParticleArrays p = lattice(Vec3d::Zero(), {1, width, width}, {wave.per_cell * wave.cells, 4, 4},
                             WaveCase::density);
  // Strains of 1e-4 in double, 1e-3 in float: far above rounding, and what is not linear in them
  // changes the frequency by their square.
  const double strain = wave.precision == sim::Precision::real64 ? 1e-4 : 1e-3;
  const int axis = wave.is_shear ? 1 : 0;
  std::vector<double> shape;
  for (std::size_t q = 0; q < p.x.size(); ++q) {
    shape.push_back(std::sin(wave.k() * p.x[q][0]));
    p.v[q][axis] = strain * wave.c() * shape[q];
  }
  sim::Simulation simulation(s, {wave.material()}, {}, p, 1);
  const Oscillation expected = predicted_wave(wave);
  const double end = 1.2 * 2 * std::numbers::pi / expected.omega;
  std::vector<double> samples;
  for (double t = 0; t < end; t += wave.dt()) {
    simulation.step(wave.dt());
    const std::vector<Vec3d> v = simulation.particles().v;
    double sum = 0;
    for (std::size_t q = 0; q < v.size(); ++q) sum += v[q][axis] * shape[q];
    samples.push_back(sum);
  }
  return fit_oscillation(samples, wave.dt(), expected.omega);
}

}  // namespace neve::test

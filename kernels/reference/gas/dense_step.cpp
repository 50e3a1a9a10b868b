#include "kernels/reference/gas/dense_step.hpp"

#include <algorithm>

namespace drogue::reference {

namespace {

constexpr std::size_t ghosts = 3;

double squared(double x) { return x * x; }

/// WENO-JS value at i+1/2 from f[i-2..i+2].
double js_value(double a, double b, double c, double d, double e) {
  const double b0 = 13.0 / 12.0 * squared(a - 2.0 * b + c) + 0.25 * squared(a - 4.0 * b + 3.0 * c);
  const double b1 = 13.0 / 12.0 * squared(b - 2.0 * c + d) + 0.25 * squared(b - d);
  const double b2 = 13.0 / 12.0 * squared(c - 2.0 * d + e) + 0.25 * squared(3.0 * c - 4.0 * d + e);
  const double w0 = 0.1 / squared(1e-6 + b0);
  const double w1 = 0.6 / squared(1e-6 + b1);
  const double w2 = 0.3 / squared(1e-6 + b2);
  return (w0 * (2.0 * a - 7.0 * b + 11.0 * c) + w1 * (-b + 5.0 * c + 2.0 * d) +
          w2 * (2.0 * c + 5.0 * d - e)) /
         (6.0 * (w0 + w1 + w2));
}

/// Flux at the face between U[2] and U[3] of a six-cell stencil with fluxes F and wave speeds `speed`.
Conserved dense_flux(const Conserved* U, const Conserved* F, const std::array<double, 3>* speed,
                     double gamma) {
  const double u = 0.5 * (U[2][1] / U[2][0] + U[3][1] / U[3][0]);
  const double H =
      0.5 * ((U[2][2] + pressure(U[2], gamma)) / U[2][0] + (U[3][2] + pressure(U[3], gamma)) / U[3][0]);
  const double c = std::sqrt((gamma - 1.0) * (H - 0.5 * u * u));
  const double b2 = (gamma - 1.0) / (c * c);
  const double b1 = 0.5 * b2 * u * u;
  const double right[3][3] = {{1.0, 1.0, 1.0}, {u - c, u, u + c}, {H - u * c, 0.5 * u * u, H + u * c}};
  const double left[3][3] = {{0.5 * (b1 + u / c), -0.5 * (b2 * u + 1.0 / c), 0.5 * b2},
                             {1.0 - b1, b2 * u, -b2},
                             {0.5 * (b1 - u / c), -0.5 * (b2 * u - 1.0 / c), 0.5 * b2}};
  Conserved flux = {0.0, 0.0, 0.0};
  for (int s = 0; s < 3; ++s) {
    double alpha = 0.0;
    for (int k = 0; k < 6; ++k) alpha = std::max(alpha, speed[k][static_cast<std::size_t>(s)]);
    double plus[6];
    double minus[6];
    for (int k = 0; k < 6; ++k) {
      const double state = left[s][0] * U[k][0] + left[s][1] * U[k][1] + left[s][2] * U[k][2];
      const double physical = left[s][0] * F[k][0] + left[s][1] * F[k][1] + left[s][2] * F[k][2];
      plus[k] = 0.5 * (physical + alpha * state);
      minus[k] = 0.5 * (physical - alpha * state);
    }
    const double value = js_value(plus[0], plus[1], plus[2], plus[3], plus[4]) +
                         js_value(minus[5], minus[4], minus[3], minus[2], minus[1]);
    for (std::size_t q = 0; q < 3; ++q) flux[q] += right[q][s] * value;
  }
  return flux;
}

void dense_stage(std::vector<Conserved>& state, DenseWorkspace& w, double gamma, double keep, double lambda) {
  const std::size_t n = state.size();
  std::copy(state.begin(), state.end(), w.padded.begin() + ghosts);
  std::fill_n(w.padded.begin(), ghosts, state.front());
  std::fill_n(w.padded.end() - ghosts, ghosts, state.back());
  for (std::size_t i = 0; i < n + 2 * ghosts; ++i) {
    w.physical[i] = physical_flux(w.padded[i], gamma);
    w.speeds[i] = wave_speeds(w.padded[i], gamma);
  }
  for (std::size_t face = 0; face <= n; ++face)
    w.flux[face] = dense_flux(&w.padded[face], &w.physical[face], &w.speeds[face], gamma);
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t s = 0; s < 3; ++s)
      state[i][s] =
          keep * w.start[i][s] + (1.0 - keep) * (state[i][s] - lambda * (w.flux[i + 1][s] - w.flux[i][s]));
}

}  // namespace

double dense_step(std::vector<Conserved>& state, DenseWorkspace& w, double gamma, double dx, double cfl) {
  const std::size_t n = state.size();
  w.padded.resize(n + 2 * ghosts);
  w.physical.resize(n + 2 * ghosts);
  w.speeds.resize(n + 2 * ghosts);
  w.flux.resize(n + 1);
  w.start = state;
  double largest = 0.0;
  for (const Conserved& U : state) {
    const std::array<double, 3> speed = wave_speeds(U, gamma);
    largest = std::max({largest, speed[0], speed[2]});
  }
  const double dt = cfl * dx / largest;
  dense_stage(state, w, gamma, 0.0, dt / dx);
  dense_stage(state, w, gamma, 3.0 / 4.0, dt / dx);
  dense_stage(state, w, gamma, 1.0 / 3.0, dt / dx);
  return dt;
}

}  // namespace drogue::reference

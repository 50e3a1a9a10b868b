#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <memory>
#include <random>
#include <vector>

#include "kernels/gas/solver.hpp"
#include "kernels/reference/gas/face_flux.hpp"
#include "kernels/reference/gas/run.hpp"

namespace drogue::testing {

/// Density, momentum and energy of all cells.
using GasState = std::array<std::vector<double>, 3>;

inline gas::ConstConservedFields fields(const GasState& state) { return {state[0], state[1], state[2]}; }

/// Range of random states: density and pressure log-uniform, |u| <= speed.
struct GasRange {
  double density_low, density_high, pressure_low, pressure_high, speed;
};
inline constexpr GasRange rough{0.7, 1.4, 0.7, 1.4,
                                0.3};  ///< independent cells; no scheme fails within ten steps
inline constexpr GasRange extreme{1e-3, 10, 1e-4, 10, 3.0};  ///< requires the limiter

class RandomGas {
 public:
  explicit RandomGas(unsigned seed) : _random(seed) {}

  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(_random);
  }
  double log_uniform(double low, double high) { return std::exp(uniform(std::log(low), std::log(high))); }

  reference::Primitive primitive(const GasRange& range) {
    return {log_uniform(range.density_low, range.density_high), uniform(-range.speed, range.speed),
            log_uniform(range.pressure_low, range.pressure_high)};
  }

 private:
  std::mt19937_64 _random;
};

/// State with `value(i)` in cell i.
template <class Value>
GasState make_state(const gas::Parameters& p, const Value& value) {
  GasState state;
  for (std::int64_t i = 0; i < p.cells; ++i) {
    const reference::Conserved u = reference::to_conserved(value(i), p.gamma);
    for (std::size_t k = 0; k < 3; ++k) state[k].push_back(u[k]);
  }
  return state;
}

inline GasState random_state(const gas::Parameters& p, unsigned seed, const GasRange& range) {
  RandomGas random(seed);
  return make_state(p, [&](std::int64_t) { return random.primitive(range); });
}

inline double centre(const gas::Parameters& p, std::int64_t i) {
  return reference::cell_centre(p, static_cast<std::size_t>(i));
}

/// Two constant states separated at `x0`.
inline GasState riemann_state(const gas::Parameters& p, double x0, const reference::Primitive& left,
                              const reference::Primitive& right) {
  return make_state(p, [&](std::int64_t i) { return centre(p, i) < x0 ? left : right; });
}

inline std::unique_ptr<gas::Solver> started(device::Backend backend, const gas::Parameters& p,
                                            const GasState& state) {
  auto solver = gas::create_solver(backend, p);
  solver->upload(0, fields(state));
  solver->start();
  return solver;
}

inline GasState download(gas::Solver& solver, const gas::Parameters& p) {
  GasState state;
  for (auto& values : state) values.resize(static_cast<std::size_t>(p.cells));
  solver.download(0, {state[0], state[1], state[2]});
  return state;
}

inline bool same_bits(const GasState& a, const GasState& b) {
  for (std::size_t k = 0; k < 3; ++k)
    if (a[k].size() != b[k].size() ||
        std::memcmp(a[k].data(), b[k].data(), a[k].size() * sizeof(double)) != 0)
      return false;
  return true;
}

/// Largest difference of a field relative to its largest magnitude; infinite if a value is not finite.
inline double distance(const GasState& a, const GasState& b) {
  double worst = 0.0;
  for (std::size_t k = 0; k < 3; ++k) {
    double scale = 1e-300, difference = 0.0;
    for (std::size_t i = 0; i < b[k].size(); ++i) {
      scale = std::max(scale, std::abs(b[k][i]));
      const double d = std::abs(a[k].at(i) - b[k][i]);
      difference = d <= difference ? difference : std::isfinite(d) ? d : INFINITY;
    }
    worst = std::max(worst, difference / scale);
  }
  return worst;
}

/// Reference run that starts from `state`.
inline reference::GasRun reference_from(const GasState& state) {
  reference::GasRun run;
  for (std::size_t i = 0; i < state[0].size(); ++i)
    run.state.push_back({state[0][i], state[1][i], state[2][i]});
  return run;
}

inline GasState state_of(const reference::GasRun& run) {
  GasState state;
  for (const reference::Conserved& u : run.state)
    for (std::size_t k = 0; k < 3; ++k) state[k].push_back(u[k]);
  return state;
}

/// Time of about `steps` steps at the full Courant number, s.
inline double time_of(const gas::Parameters& p, const GasState& state, double steps) {
  const double dx = (p.x_max - p.x_min) / static_cast<double>(p.cells);
  return steps * p.cfl * dx / reference::speed_bounds(reference_from(state).state, p.gamma).largest;
}

}  // namespace drogue::testing

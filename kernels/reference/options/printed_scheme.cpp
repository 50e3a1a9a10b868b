#include "kernels/reference/options/printed_scheme.hpp"

#include <algorithm>
#include <cmath>

namespace drogue::reference {
namespace {

/// Solves -side u[i-1] + diagonal u[i] - side u[i+1] = right[i] at the inner nodes, with the values that `u`
/// has at both ends (Thomas).
void solve_diffusion(double diagonal, double side, std::vector<double> right, std::vector<double>& u) {
  const std::size_t last = u.size() - 1;
  right[1] += side * u[0];
  right[last - 1] += side * u[last];
  std::vector<double> pivot(u.size(), diagonal);
  for (std::size_t i = 2; i < last; ++i) {
    const double factor = side / pivot[i - 1];
    pivot[i] -= factor * side;
    right[i] += factor * right[i - 1];
  }
  u[last - 1] = right[last - 1] / pivot[last - 1];
  for (std::size_t i = last - 2; i >= 1; --i) u[i] = (right[i] + side * u[i + 1]) / pivot[i];
}

}  // namespace

std::vector<double> solve_printed_put(const PrintedPut& put) {
  const auto n = static_cast<std::size_t>(put.mesh);
  const double h = 2.0 * put.half_width / put.mesh, dt = put.maturity / put.steps, end = (put.mesh + 0.5) * h;
  const auto x = [&](std::size_t i) { return static_cast<double>(i) * h - put.half_width; };
  std::vector<double> up(n + 1), down(n + 1), exit_mass(n + 1), exit_price(n + 1), payoff(n + 1);
  double rate = 0.0, compensator = 0.0;
  for (std::size_t k = 1; k <= n; ++k) {
    const double y = static_cast<double>(k) * h, part = k == 1 ? 0.5 * h : h;
    up[k] = part * levy_density(put.jumps, y);
    down[k] = part * levy_density(put.jumps, -y);
    rate += up[k] + down[k];
    compensator += up[k] * std::expm1(y) + down[k] * std::expm1(-y);
    exit_mass[k] = levy_tail(put.jumps, y + 0.5 * h, -1, 0);
    exit_price[k] = std::exp(x(k)) * levy_tail(put.jumps, y + 0.5 * h, -1, 1);
  }
  for (const int side : {-1, 1}) {
    rate += levy_tail(put.jumps, end, side, 0);
    compensator += levy_tail(put.jumps, end, side, 1) - levy_tail(put.jumps, end, side, 0);
  }
  const double diffusion = (put.variance + levy_variance(put.jumps) - levy_tail_variance(put.jumps, h)) / 2.0;
  const double drift = put.rate - put.dividend - diffusion - compensator;
  for (std::size_t i = 0; i <= n; ++i) payoff[i] = std::max(0.0, -std::expm1(x(i)));
  std::vector<double> f = payoff;
  for (int step = 1; step <= put.steps; ++step) {
    const auto discount = [&](double yield, int time) {
      return put.american ? 1.0 : std::exp(-yield * time * dt);
    };
    const double strike = discount(put.rate, step - 1), asset = discount(put.dividend, step - 1);
    std::vector<double> right(n + 1);
    for (std::size_t i = 1; i < n; ++i) {
      double sum = strike * exit_mass[i] - asset * exit_price[i];
      for (std::size_t j = 0; j <= n; ++j)
        if (j != i) sum += (j > i ? up[j - i] : down[i - j]) * f[j];
      right[i] = f[i] / dt + drift * (f[i + 1] - f[i - 1]) / (2.0 * h) - (put.rate + rate) * f[i] + sum;
    }
    f[0] = discount(put.rate, step) - discount(put.dividend, step) * std::exp(-put.half_width);
    f[n] = 0.0;
    solve_diffusion(1.0 / dt + 2.0 * diffusion / (h * h), diffusion / (h * h), right, f);
    if (put.american)
      for (std::size_t i = 1; i < n; ++i) f[i] = std::max(f[i], payoff[i]);
  }
  return f;
}

}  // namespace drogue::reference

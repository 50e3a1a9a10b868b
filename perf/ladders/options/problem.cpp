#include "perf/ladders/options/problem.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "kernels/reference/linear/tridiagonal.hpp"

namespace drogue::perf::ladder {
namespace {

/// Jumps: number per year, mean and standard deviation of their logarithm.
constexpr double intensity = 0.5, mean_jump = -0.05, jump_deviation = 0.12;

/// Parameters of option k, per year.
struct Terms {
  double variance, rate, maturity;
};
Terms terms_of(int k) {
  const double t = k % 64 / 64.0;
  return {0.04 + 0.06 * t, 0.06 - 0.04 * t, 0.5 + 0.5 * t};
}

double mean_growth() { return std::exp(mean_jump + 0.5 * jump_deviation * jump_deviation) - 1.0; }

double normal(double x) { return 0.5 * std::erfc(-x / std::numbers::sqrt2); }

std::vector<double> solve(const OptionsProblem& problem, const OptionStep& step) {
  constexpr auto n = static_cast<std::size_t>(option_nodes);
  std::vector<double> below(n, -step.lower), diagonal(n, step.diagonal), above(n, -step.upper);
  below.front() = below.back() = above.front() = above.back() = 0.0;
  diagonal.front() = diagonal.back() = 1.0;
  std::vector<double> v = problem.payoff;
  for (int k = 1; k <= option_steps; ++k) {
    std::vector<double> right(n, 0.0);
    for (std::size_t i = 1; i + 1 < n; ++i) {
      double jumped = 0.0;
      for (std::size_t j = 0; j < n; ++j) jumped += problem.weights[j + n - 1 - i] * v[j];
      right[i] = v[i] + step.jumps * jumped;
    }
    right.front() = std::exp(-k * step.rate_dt) - std::exp(problem.low);
    v = reference::solve_tridiagonal(below, diagonal, above, right);
  }
  return v;
}

}  // namespace

OptionsProblem make_options_problem(int options) {
  OptionsProblem p;
  p.low = -2.0, p.h = 4.0 / option_nodes;
  for (int d = 1 - option_nodes; d < option_nodes; ++d) {
    const double z = (d * p.h - mean_jump) / jump_deviation;
    p.weights.push_back(p.h * std::exp(-0.5 * z * z) / (jump_deviation * std::sqrt(2.0 * std::numbers::pi)));
  }
  for (int i = 0; i < option_nodes; ++i) p.payoff.push_back(std::max(0.0, 1.0 - std::exp(p.low + i * p.h)));
  for (int k = 0; k < options; ++k) {
    const Terms t = terms_of(k);
    const double dt = t.maturity / option_steps, diffusion = 0.5 * t.variance / (p.h * p.h);
    const double drift = (t.rate - 0.5 * t.variance - intensity * mean_growth()) / (2.0 * p.h);
    p.steps.push_back({.lower = dt * (diffusion - drift),
                       .diagonal = 1.0 + dt * (2.0 * diffusion + t.rate + intensity),
                       .upper = dt * (diffusion + drift),
                       .jumps = dt * intensity,
                       .rate_dt = t.rate * dt});
    // Options whose terms repeat have the same values.
    if (k < 64) {
      const std::vector<double> values = solve(p, p.steps.back());
      p.expected.insert(p.expected.end(), values.begin(), values.end());
    } else {
      for (int i = 0; i < option_nodes; ++i)
        p.expected.push_back(p.expected[static_cast<std::size_t>((k % 64) * option_nodes + i)]);
    }
  }
  return p;
}

double merton_put(int k) {
  const Terms t = terms_of(k);
  const double growth = mean_growth(), jumps = intensity * (1.0 + growth) * t.maturity;
  double price = 0.0, probability = std::exp(-jumps);
  for (int n = 0; n < 40; probability *= jumps / ++n) {
    const double variance = t.variance * t.maturity + n * jump_deviation * jump_deviation;
    const double rate = (t.rate - intensity * growth) * t.maturity + n * std::log1p(growth);
    const double d1 = (rate + 0.5 * variance) / std::sqrt(variance), d2 = d1 - std::sqrt(variance);
    price += probability * (std::exp(-rate) * normal(-d2) - normal(-d1));
  }
  return price;
}

double difference(const OptionsProblem& problem, const std::vector<double>& values) {
  double worst = 0.0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double off = std::abs(values[i] - problem.expected[i]);
    if (!std::isfinite(off)) return std::numeric_limits<double>::infinity();
    worst = std::max(worst, off);
  }
  return worst;
}

Work options_work(const OptionsProblem& problem, double launches, double bytes) {
  const double node_steps = static_cast<double>(problem.options()) * option_nodes * option_steps;
  Work work;
  work.launches = launches;
  work.bytes = bytes * node_steps;
  // The sum over jumps, the right-hand side, and the elimination.
  work.flops = node_steps * (2.0 * option_nodes + 2.0 + elimination_operations);
  work.divisions = node_steps;
  return work;
}

}  // namespace drogue::perf::ladder

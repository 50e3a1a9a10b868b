#include "kernels/reference/options/scheme.hpp"

#include <algorithm>
#include <cmath>

namespace drogue::reference {
namespace {

using Real = long double;
using Values = std::vector<Real>;

/// Coefficients that are constant in time, 1/year. The drift makes the scheme exact for e^x.
struct Coefficients {
  Real diffusion, drift, jump_rate;
};

Coefficients coefficients(const PutProblem& p, const JumpTable& jumps) {
  const Real h = p.h;
  Real jump_rate = jumps.tail_up + jumps.tail_down;
  Real price = jumps.tail_up_price + jumps.tail_down_price - jump_rate;
  for (std::size_t d = 1; d < jumps.up.size(); ++d) {
    const Real y = static_cast<Real>(d) * h;
    jump_rate += jumps.up[d] + jumps.down[d];
    price += jumps.up[d] * std::expm1(y) + jumps.down[d] * std::expm1(-y);
  }
  const Real diffusion = std::max<Real>(0.0L, jumps.remaining_variance) / 2;
  const Real drift =
      (p.rate - p.dividend - price - diffusion * (2 * std::cosh(h) - 2) / (h * h)) * h / std::sinh(h);
  return {diffusion, drift, jump_rate};
}

/// Value strike - asset e^x of a put so deep in the money that it is exercised with certainty.
struct CertainPut {
  Real strike, asset;  ///< discount factors to the optimal exercise time
};

CertainPut certain_put(const PutProblem& p, Real tau) {
  const Real r = p.rate, q = p.dividend, x = -p.strike * static_cast<Real>(p.h);
  const auto value = [&](Real t) { return std::exp(-r * t) - std::exp(x - q * t); };
  Real best = tau;
  if (p.american) {
    Values times = {0.0L};
    if (r * q > 0.0L && r != q) times.push_back(std::clamp((std::log(r / q) - x) / (r - q), 0.0L, tau));
    for (const Real t : times)
      if (value(t) > value(best)) best = t;
  }
  return {std::exp(-r * best), std::exp(-q * best)};
}

/// Jump integral and discounting at all inner nodes, at time `tau` to expiry.
Values explicit_part(const PutProblem& p, const JumpTable& jumps, const Coefficients& op, const Values& v,
                     Real tau) {
  const CertainPut deep = certain_put(p, tau);
  Values out(v.size(), 0.0L);
  for (int i = 1; i < p.mesh; ++i) {
    Real sum = -(op.jump_rate + p.rate) * v[static_cast<std::size_t>(i)];
    const Real x = (i - p.strike) * static_cast<Real>(p.h);
    for (int d = 1; d <= p.mesh; ++d) {
      const auto k = static_cast<std::size_t>(d);
      if (i + d < p.mesh) sum += jumps.up[k] * v[static_cast<std::size_t>(i + d)];
      sum +=
          jumps.down[k] * (i - d >= 0 ? v[static_cast<std::size_t>(i - d)]
                                      : deep.strike - deep.asset * std::exp(x - d * static_cast<Real>(p.h)));
    }
    sum += jumps.tail_down * deep.strike - jumps.tail_down_price * deep.asset * std::exp(x);
    out[static_cast<std::size_t>(i)] = sum;
  }
  return out;
}

/// Implicit diffusion, in addition to D/h^2, that stabilizes the explicit jumps: 3 E <= 3.6/dt + I at sixteen
/// wave numbers, E and I the explicit and implicit symbols. A tenth below the limit of stability, 4/dt.
Real extra_diffusion(const PutProblem& p, const JumpTable& jumps, const Coefficients& op, Real dt) {
  Real extra = 0.0L;
  for (int k = 0; k < 16; ++k) {
    const Real angle = std::acos(-1.0L) * std::pow(2.0L, -k / 2.0L), form = 2 - 2 * std::cos(angle);
    Real symbol = jumps.tail_up + jumps.tail_down + p.rate;
    for (std::size_t d = 1; d < jumps.up.size(); ++d)
      symbol += (jumps.up[d] + jumps.down[d]) * (1 - std::cos(static_cast<Real>(d) * angle));
    extra = std::max(extra, (3 * symbol - op.diffusion / p.h / p.h * form - 3.6L / dt) / (4 * form));
  }
  return extra;
}

}  // namespace

std::vector<double> solve_put(const PutProblem& p, const JumpTable& jumps) {
  const Coefficients op = coefficients(p, jumps);
  const auto n = static_cast<std::size_t>(p.mesh);
  const Real h = p.h;
  Values payoff(n + 1, 0.0L), v, before, jump_before(n + 1, 0.0L);
  for (std::size_t i = 0; i < static_cast<std::size_t>(p.strike); ++i)
    payoff[i] = -std::expm1((static_cast<Real>(i) - p.strike) * h);
  v = payoff;
  const Real spread = 2 * (op.diffusion - jumps.moved) * p.maturity;
  v[static_cast<std::size_t>(p.strike)] = h / 12 * spread / (spread + h * h);
  before = v;
  Real tau = 0.0L, dt_before = 1.0L;
  for (int step = 1; step <= p.steps; ++step) {
    const Real end = p.maturity * std::pow(static_cast<Real>(step) / p.steps, 1.5L), dt = end - tau;
    const Real w = step <= 2 ? 0.0L : dt / dt_before;
    const Values jump = explicit_part(p, jumps, op, v, tau);
    const Real extra = extra_diffusion(p, jumps, op, dt);
    const Real lower = op.diffusion / h / h - op.drift / 2 / h + extra,
               upper = op.diffusion / h / h + op.drift / 2 / h + extra;
    const Real diagonal = (1 + 2 * w) / (1 + w) / dt + lower + upper;
    // Elimination from above on an unbounded line, for which the factors are constant.
    const Real pivot = (diagonal + std::sqrt(diagonal * diagonal - 4 * lower * upper)) / 2;
    Values y(n + 1, 0.0L);
    // The implicit part continues the solution beyond the last node with the factor lower/pivot. The explicit
    // part uses a fraction of it.
    const Real moved = jumps.moved / h / h, subtracted = extra + moved;
    const Real beyond =
        extra > 0 ? lower / pivot * std::max(0.0L, subtracted - 1.4L * (op.diffusion / h / h - moved)) / extra
                  : 0.0L;
    for (std::size_t i = n - 1; i >= 1; --i) {
      const auto second_difference = [&](const Values& f) {
        return f[i - 1] - 2 * f[i] + (i + 1 == n ? beyond * f[i] : f[i + 1]);
      };
      const Real right = ((1 + w) * v[i] - w * w / (1 + w) * before[i]) / dt + (1 + w) * jump[i] -
                         w * jump_before[i] -
                         extra * ((1 + w) * second_difference(v) - w * second_difference(before));
      y[i] = (right + upper * y[i + 1]) / pivot;
    }
    before = v;
    jump_before = jump;
    const CertainPut deep = certain_put(p, end);
    v[0] = std::max(0.0L, deep.strike - deep.asset * std::exp(-p.strike * h));
    for (std::size_t i = 1; i < n; ++i) {
      v[i] = lower / pivot * v[i - 1] + y[i];
      if (p.american) v[i] = std::max(v[i], payoff[i]);
    }
    v[n] = 0.0L;
    tau = end;
    dt_before = dt;
  }
  return {v.begin(), v.end()};
}

}  // namespace drogue::reference

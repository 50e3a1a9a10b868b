#pragma once

#include "kernels/options/pide/jumps.hpp"

/// Coefficients of the time steps. They do not depend on the solution.
namespace drogue::options {

/// Discount factors of the boundary value e^{-r t} - e^{x - q t} of a put whose exercise is certain. t <= tau
/// is the best exercise time at the x where e^x is `asset`; for European puts it is tau. A march uses the
/// factors of node 0 for all x below.
template <class R>
struct DiscountFactors {
  R strike, asset;  ///< e^{-r t}, e^{-q t}
};

/// Time at which e^{-r t} - e^{x - q t} is stationary, years: r/q = e^{x + (r - q) t}. 0 if there is none.
template <class R>
KOKKOS_INLINE_FUNCTION R optimal_exercise_time(const PutPack<R>& put, R x) {
  const R quotient = put.rate / put.dividend;
  const auto stationary = quotient > R(1e-300);
  return device::select(
      stationary,
      (logarithm(device::select(stationary, device::minimum(quotient, R(1e300)), R(1.0))) - x) /
          (put.rate - put.dividend),
      R(0.0));
}

/// Discount factors of the boundary value at time to expiry `tau`, years, where e^x is `asset`. `best`:
/// result of `optimal_exercise_time`, years.
template <class R>
KOKKOS_INLINE_FUNCTION DiscountFactors<R> boundary_discount(const PutPack<R>& put, R asset, R best, R tau) {
  const R late = exponential(-put.rate * tau), late_asset = exponential(-put.dividend * tau);
  R between = 1.0, between_asset = 1.0;
  if (!device::all(best <= R(0.0))) {
    const R t = device::maximum(R(0.0), device::minimum(best, tau));
    between = exponential(-put.rate * t);
    between_asset = exponential(-put.dividend * t);
  }
  const auto sooner = put.early * (between - between_asset * asset - (late - late_asset * asset)) > R(0.0);
  R strike = device::select(sooner, between, late), price = device::select(sooner, between_asset, late_asset);
  const auto now = put.early * (1.0 - asset - (strike - price * asset)) > R(0.0);
  return {device::select(now, R(1.0), strike), device::select(now, R(1.0), price)};
}

/// Coefficients that are the same in every step of a march.
template <class R>
struct Scheme {
  R lower, upper;   ///< l, u: D/h^2 -+ b/2h
  R exercise_time;  ///< best exercise time at node 0, years: `DiscountFactors`
  R lowest_asset;   ///< e^x at node 0
  int steps;
};

/// Coefficients of a march of `steps` steps on `grid`.
template <class R>
KOKKOS_INLINE_FUNCTION Scheme<R> scheme_of(const PutPack<R>& put, const Jumps<R>& jumps, const Grid<R>& grid,
                                           int steps) {
  const R h = grid.h, lowest = -grid.strike * h;
  const R advection = 0.5 * jumps.drift / h, diffusion = jumps.diffusion / (h * h);
  return {.lower = diffusion - advection,
          .upper = diffusion + advection,
          .exercise_time = optimal_exercise_time(put, lowest),
          .lowest_asset = exponential(lowest),
          .steps = steps};
}

/// Implicit diffusion beyond D that the explicit jumps require for stability; the same amount is subtracted
/// explicitly. A mode of implicit symbol I and explicit symbol E is multiplied by the roots z of
///   (3/2 z^2 - 2 z + 1/2)/dt + I z^2 + E (2 z - 1) = 0.
/// One of them is -1 where 3E = 4/dt + I: the limit of stability, at which the mode alternates without decay.
/// The scheme keeps a tenth below it, 3E <= 3.6/dt + I, so that such modes decay. The tenth is empirical:
/// docs/options-notebook.md, "Margin of stability".
template <class R>
KOKKOS_INLINE_FUNCTION R added_diffusion(const PutPack<R>& put, const Jumps<R>& jumps, R diffusion, R dt) {
  constexpr double limit = 4.0, margin = 0.9;
  const R bound = margin * limit * device::reciprocal(dt);
  R added[4] = {0.0, 0.0, 0.0, 0.0};  // independent maxima, for instruction-level parallelism
  AngleCosines::each([&](int k, double cosine) {
    const double form = 2.0 - 2.0 * cosine;
    const R need = 3.0 * (jumps.symbol[k] + put.rate) - diffusion * form - bound;
    added[k % 4] = device::maximum(added[k % 4], need * (0.25 / form));
  });
  return device::maximum(device::maximum(added[0], added[1]), device::maximum(added[2], added[3]));
}

/// End of step n of `steps`, years. Step lengths grow with the cube root of time, since the changes of the
/// solution decrease.
template <class R>
KOKKOS_INLINE_FUNCTION R step_end(R maturity, int n, int steps) {
  const double part = double(n) / steps;
  return maturity * (part * Kokkos::sqrt(part));
}

/// Length of step n, years, and its ratio to the previous one; a ratio of 0 selects IMEX-Euler.
template <class R>
struct StepLength {
  R dt, ratio;
};

/// Length of step n of `steps` until `maturity`, years.
template <class R>
KOKKOS_INLINE_FUNCTION StepLength<R> step_length(R maturity, int n, int steps) {
  const R begin = step_end(maturity, n - 1, steps), dt = step_end(maturity, n, steps) - begin;
  return {dt, n <= 2 ? R(0.0) : dt * device::reciprocal(begin - step_end(maturity, n - 2, steps))};
}

/// dV/dtau at the end of a step by the formula of the step, from the last three values; per year.
template <class R>
KOKKOS_INLINE_FUNCTION R bdf_derivative(const StepLength<R>& step, R value, R before, R oldest) {
  const R per = 1.0 / (step.dt * (1.0 + step.ratio));
  return (1.0 + 2.0 * step.ratio) * per * value - (1.0 + step.ratio) / step.dt * before +
         step.ratio * step.ratio * per * oldest;
}

/// Factors of a step, divided by the pivot of its matrix.
template <class R>
struct StepFactors {
  static constexpr int size = 13;
  R value, before;                      ///< of the values at the beginning of the step and one step before
  R explicit_now, explicit_before;      ///< of the explicit operator at these times
  R compensation, compensation_before;  ///< of the explicit subtraction of the added diffusion at these times
  R inverse_pivot, diagonal;            ///< 1/pivot; coefficient of the derivative, per year
  R from_left, from_right;              ///< slopes of the recurrences
  DiscountFactors<R> discount;          ///< at the end of the step
  R left_value;                         ///< value of node 0 at the end of the step
};

/// Ratio of the value beyond the last node (ghost node) to the value at the last node, where the added
/// diffusion is subtracted explicitly. The implicit part has the ratio from_left, that of an infinite line.
/// The same ratio in the explicit part would leave too little diffusion to stabilize the jumps at the last
/// node. A ghost value of 0 would subtract more diffusion than the implicit part adds, and the march would
/// grow without bound. The ratio in between, from_left times 1 - 1.4 D/added, and 0 for added <= 1.4 D, is
/// empirical. Stability is not proven; `OptionsProperty.StaysBoundedForAHundredYearsOfPureJumps` tests it. D
/// is meant without `moved` (1/year, `Jumps::moved`/h^2), which counts as added: it is subtracted by weights
/// whose ghost value is 0.
template <class R>
KOKKOS_INLINE_FUNCTION R ghost_factor(const StepFactors<R>& f, R moved) {
  constexpr double share = 1.4;
  const R added = f.compensation * f.inverse_pivot * device::reciprocal(f.explicit_now),
          whole = 0.5 * (f.from_left + f.from_right), subtracted = added + moved * f.inverse_pivot;
  const R per = device::reciprocal(device::maximum(added, R(1e-100)));
  return f.from_left * device::maximum(R(0.0), ((1.0 + share) * subtracted - share * whole) * per);
}

/// Factors of 32 steps, which the lanes compute in parallel; in scratch memory.
template <class R>
struct StepTable {
  R* factors;  ///< (StepFactors::size, max_lanes)

  KOKKOS_INLINE_FUNCTION void store(int n, const StepFactors<R>& f) const {
    const R row[] = {f.value,           f.before,          f.explicit_now,
                     f.explicit_before, f.compensation,    f.compensation_before,
                     f.inverse_pivot,   f.diagonal,        f.from_left,
                     f.from_right,      f.discount.strike, f.discount.asset,
                     f.left_value};
    for (int k = 0; k < StepFactors<R>::size; ++k) factors[k * max_lanes + (n - 1) % max_lanes] = row[k];
  }
  [[nodiscard]] KOKKOS_INLINE_FUNCTION StepFactors<R> load(int n) const {
    const R* at = factors + (n - 1) % max_lanes;
    return {.value = at[0],
            .before = at[max_lanes],
            .explicit_now = at[2 * max_lanes],
            .explicit_before = at[3 * max_lanes],
            .compensation = at[4 * max_lanes],
            .compensation_before = at[5 * max_lanes],
            .inverse_pivot = at[6 * max_lanes],
            .diagonal = at[7 * max_lanes],
            .from_left = at[8 * max_lanes],
            .from_right = at[9 * max_lanes],
            .discount = {at[10 * max_lanes], at[11 * max_lanes]},
            .left_value = at[12 * max_lanes]};
  }
};

/// Factors of step n of IMEX-BDF2, or of IMEX-Euler for the first steps.
template <class R>
KOKKOS_INLINE_FUNCTION StepFactors<R> step_factors(const PutPack<R>& put, const Jumps<R>& jumps,
                                                   const Scheme<R>& scheme, int n) {
  const StepLength<R> step = step_length(put.maturity, n, scheme.steps);
  const R per = device::reciprocal(step.dt * (1.0 + step.ratio));
  const R c0 = (1.0 + 2.0 * step.ratio) * per;
  const R added = added_diffusion(put, jumps, 0.5 * (scheme.lower + scheme.upper), step.dt);
  const R lower = scheme.lower + added, upper = scheme.upper + added;
  const R diagonal = c0 + lower + upper;
  const R inverse =
      device::reciprocal(0.5 * (diagonal + device::root(diagonal * diagonal - 4.0 * lower * upper).value));
  StepFactors<R> f;
  f.value = (1.0 + step.ratio) * device::reciprocal(step.dt) * inverse;
  f.before = step.ratio * step.ratio * per * inverse;
  f.explicit_now = (1.0 + step.ratio) * inverse;
  f.explicit_before = step.ratio * inverse;
  f.compensation = added * f.explicit_now;
  f.compensation_before = added * f.explicit_before;
  f.inverse_pivot = inverse;
  f.diagonal = c0;
  f.from_left = lower * inverse;
  f.from_right = upper * inverse;
  f.discount = boundary_discount(put, scheme.lowest_asset, scheme.exercise_time,
                                 step_end(put.maturity, n, scheme.steps));
  f.left_value = device::maximum(R(0.0), f.discount.strike - f.discount.asset * scheme.lowest_asset);
  return f;
}

/// Computes the factors of the steps n .. n + max_lanes - 1.
template <class ThreadGroup, class R>
KOKKOS_INLINE_FUNCTION void fill_table(const ThreadGroup& group, const PutPack<R>& put, const Jumps<R>& jumps,
                                       const Scheme<R>& scheme, const StepTable<R>& table, int n) {
  group.each([=, &put, &jumps, &scheme](int thread) {
    for (int k = n + thread; k < n + max_lanes && k <= scheme.steps; k += group.threads())
      table.store(k, step_factors(put, jumps, scheme, k));
  });
}

}  // namespace drogue::options

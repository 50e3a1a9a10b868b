#pragma once

#include "kernels/options/fourier_sum.hpp"
#include "kernels/options/jumps.hpp"

namespace drogue::options {

/// Values of the nodes, (node_count) each, and the rest that steps need; rows of the scratch memory.
template <class R>
struct March {
  R* value[3];  ///< of this step's end, its beginning, and of the step before
  R* jump[2];   ///< the explicit part of the operator, of the beginning and of the step before
  R* other;     ///< the other half of the sum over jumps; with `y` after it the memory of transforms
  R* y;
  R* floor;  ///< payoff; `-unbounded` where early exercise is not looked for
  R* force;  ///< what exercise pushes with, of split puts
  R* slot;   ///< (6 most_lanes)
};

/// The value e^{-r t} - e^{x - q t} of a put that will certainly be exercised, at the time t <= tau that is
/// best at some x (for European ones tau), where e^x is `asset`. A march takes that of node 0 for all x
/// below.
template <class R>
struct Certain {
  R strike, asset;  ///< e^{-r t}, e^{-q t}
};

/// The time at which e^{-r t} - e^{x - q t} is stationary, r/q = e^{x + (r - q) t}; 0 where there is none.
template <class R>
KOKKOS_INLINE_FUNCTION R best_time(const PutPack<R>& put, R x) {
  const R quotient = put.rate / put.dividend;
  const auto stationary = quotient > R(1e-300);
  return device::select(
      stationary,
      (logarithm(device::select(stationary, device::minimum(quotient, R(1e300)), R(1.0))) - x) /
          (put.rate - put.dividend),
      R(0.0));
}

template <class R>
KOKKOS_INLINE_FUNCTION Certain<R> certain(const PutPack<R>& put, R asset, R best, R tau) {
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

/// The sums over jumps w_{j-i} v_j, j = 0 .. mesh - 1, into `out` (j in the lower half) and `other`: 8 nodes
/// and half of the j a task, so that a value read serves 8 of them.
template <class Workers, class R>
KOKKOS_INLINE_FUNCTION void convolve(const Workers& workers, int mesh, const R* w, const R* v, R* out,
                                     R* other) {
  const WeightLayout<R> layout(mesh);
  const int octets = (mesh + 7) / 8, halved = (octets + 1) / 2;
  workers.each([=](int lane) {
    for (int task = lane; task < 2 * octets; task += workers.lanes) {
      const int part = task / octets, chunk = task % octets;
      const int begin = part == 0 ? 0 : halved, end = part == 0 ? halved : octets;
      R sum[8] = {0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0};
      if constexpr (WeightLayout<R>::interleaved) {
        R window[16];
        const R* place = w + layout.centre / 8 + (begin - chunk);
        for (int k = 0; k < 8; ++k) window[8 + k] = place[k * layout.stride - 1];
        for (int u = begin; u < end; ++u, ++place) {
          for (int k = 0; k < 8; ++k) {
            window[k] = window[8 + k];
            window[8 + k] = place[k * layout.stride];
          }
          for (int k = 0; k < 8; ++k) {
            const R value = v[8 * u + k];
            for (int m = 0; m < 8; ++m) sum[m] += window[8 + k - m] * value;
          }
        }
      } else {
        const R* from = w + layout.centre + 8 * (begin - chunk);
        const R* value = v + 8 * begin;
        for (int j = 8 * begin; j < 8 * end; ++j, ++from, ++value)
          for (int m = 0; m < 8; ++m) sum[m] += from[-m] * *value;
      }
      R* to = (part == 0 ? out : other) + 8 * chunk;
      for (int m = 0; m < 8; ++m) to[m] = sum[m];
    }
  });
}

/// What is the same in every step of a march.
template <class R>
struct Scheme {
  R lower, upper;  ///< l, u: D/h^2 -+ b/2h
  R best;          ///< time at which exercise of node 0 would be best: `Certain`
  R lowest;        ///< e^x at node 0
  int steps;
};

template <class R>
KOKKOS_INLINE_FUNCTION Scheme<R> scheme_of(const PutPack<R>& put, const Jumps<R>& jumps, const Grid<R>& grid,
                                           int steps) {
  const R h = grid.h, lowest = -grid.strike * h;
  const R advection = 0.5 * jumps.drift / h, diffusion = jumps.diffusion / (h * h);
  return {diffusion - advection, diffusion + advection, best_time(put, lowest), exponential(lowest), steps};
}

/// Implicit diffusion beyond D that the explicit jumps need, of which as much is taken back explicitly:
/// IMEX-BDF2 damps the highest mode of a symbol I implicit, E explicit while 3E <= 4/dt + I.
template <class R>
KOKKOS_INLINE_FUNCTION R added_diffusion(const PutPack<R>& put, const Jumps<R>& jumps, R diffusion, R dt) {
  const R most = 3.6 * device::reciprocal(dt);
  R added[4] = {0.0, 0.0, 0.0, 0.0};  // that do not wait for one another
  AngleCosines::each([&](int k, double cosine) {
    const double form = 2.0 - 2.0 * cosine;
    const R need = 3.0 * (jumps.symbol[k] + put.rate) - diffusion * form - most;
    added[k % 4] = device::maximum(added[k % 4], need * (0.25 / form));
  });
  return device::maximum(device::maximum(added[0], added[1]), device::maximum(added[2], added[3]));
}

/// The end of step n of `steps`, years: steps grow with the square root of time, as the solution's changes
/// shrink.
template <class R>
KOKKOS_INLINE_FUNCTION R step_end(R maturity, int n, int steps) {
  const double part = double(n) / steps;
  return maturity * (part * Kokkos::sqrt(part));
}

/// Length of step n, and its ratio to the one before; 0 while steps are IMEX-Euler's.
template <class R>
struct StepLength {
  R dt, ratio;
};

template <class R>
KOKKOS_INLINE_FUNCTION StepLength<R> step_length(R maturity, int n, int steps) {
  const R begin = step_end(maturity, n - 1, steps), dt = step_end(maturity, n, steps) - begin;
  return {dt, n <= 2 ? R(0.0) : dt * device::reciprocal(begin - step_end(maturity, n - 2, steps))};
}

/// dV/dtau at the end of a step by its formula, from the last three values.
template <class R>
KOKKOS_INLINE_FUNCTION R rate_of_change(const StepLength<R>& step, R value, R before, R oldest) {
  const R per = 1.0 / (step.dt * (1.0 + step.ratio));
  return (1.0 + 2.0 * step.ratio) * per * value - (1.0 + step.ratio) / step.dt * before +
         step.ratio * step.ratio * per * oldest;
}

/// Whether a put's value is its payoff `nodes` above the strike: what differs by less than rounding is
/// exercised.
KOKKOS_INLINE_FUNCTION bool is_exercised(double value, int nodes, double h) {
  return !(value - (1.0 - exponential(nodes * h)) > 1e-13);
}

/// What a step multiplies with, divided by the pivot of its matrix.
template <class R>
struct StepFactors {
  static constexpr int size = 13;
  R value, before;          ///< of the values at the step's beginning, and a step before
  R fresh, stale;           ///< of the explicit part, likewise
  R bend, bend_before;      ///< of what is taken back of added diffusion, likewise
  R inverse, diagonal;      ///< 1/pivot; of the derivative
  R from_left, from_right;  ///< slopes of the recurrences
  Certain<R> certain;       ///< at the step's end
  R edge;                   ///< value of node 0 at its end
};

/// What the value beyond the last node is of that at it where added diffusion is taken back. The implicit
/// part takes from_left, being that of a line without an end, and all of it would leave the explicit part too
/// little of that diffusion to bear the jumps at the last node, and none, a value of 0, would give it more
/// than the implicit part has: there the march would grow without bound where most of the diffusion is added.
/// The part 1 - 1.4 D/added keeps all modes of the truncated matrices bounded (docs/options.md); up to 1.4 D
/// the value is 0.
template <class R>
KOKKOS_INLINE_FUNCTION R taken_beyond(const StepFactors<R>& f) {
  constexpr double share = 1.4;
  const R added = f.bend * f.inverse * device::reciprocal(f.fresh),
          whole = 0.5 * (f.from_left + f.from_right);
  const R per = device::reciprocal(device::maximum(added, R(1e-100)));
  return f.from_left * device::maximum(R(0.0), ((1.0 + share) * added - share * whole) * per);
}

/// The factors of 32 steps, which lanes compute side by side; in scratch memory.
template <class R>
struct StepTable {
  R* place;  ///< (StepFactors::size, most_lanes)

  KOKKOS_INLINE_FUNCTION void store(int n, const StepFactors<R>& f) const {
    const R row[] = {f.value,          f.before,        f.fresh,    f.stale,     f.bend,
                     f.bend_before,    f.inverse,       f.diagonal, f.from_left, f.from_right,
                     f.certain.strike, f.certain.asset, f.edge};
    for (int k = 0; k < StepFactors<R>::size; ++k) place[k * most_lanes + (n - 1) % most_lanes] = row[k];
  }
  [[nodiscard]] KOKKOS_INLINE_FUNCTION StepFactors<R> load(int n) const {
    const R* at = place + (n - 1) % most_lanes;
    return {at[0],
            at[most_lanes],
            at[2 * most_lanes],
            at[3 * most_lanes],
            at[4 * most_lanes],
            at[5 * most_lanes],
            at[6 * most_lanes],
            at[7 * most_lanes],
            at[8 * most_lanes],
            at[9 * most_lanes],
            {at[10 * most_lanes], at[11 * most_lanes]},
            at[12 * most_lanes]};
  }
};

/// The factors of step n of IMEX-BDF2, or of IMEX-Euler at first.
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
  f.fresh = (1.0 + step.ratio) * inverse;
  f.stale = step.ratio * inverse;
  f.bend = added * f.fresh;
  f.bend_before = added * f.stale;
  f.inverse = inverse;
  f.diagonal = c0;
  f.from_left = lower * inverse;
  f.from_right = upper * inverse;
  f.certain = certain(put, scheme.lowest, scheme.best, step_end(put.maturity, n, scheme.steps));
  f.edge = device::maximum(R(0.0), f.certain.strike - f.certain.asset * scheme.lowest);
  return f;
}

/// Fills the table with the factors of the steps from n on.
template <class Workers, class R>
KOKKOS_INLINE_FUNCTION void fill_table(const Workers& workers, const PutPack<R>& put, const Jumps<R>& jumps,
                                       const Scheme<R>& scheme, const StepTable<R>& table, int n) {
  workers.each([=, &put, &jumps, &scheme](int lane) {
    for (int k = n + lane; k < n + most_lanes && k <= scheme.steps; k += workers.lanes)
      table.store(k, step_factors(put, jumps, scheme, k));
  });
}

/// What a march begins with at a node, and below what it never falls there.
template <class R>
struct AtExpiry {
  R value, floor;
};

/// The payoff, `kink` at the strike; no floor where early exercise is not looked for or split off.
template <class R>
KOKKOS_INLINE_FUNCTION AtExpiry<R> at_expiry(const PutPack<R>& put, const Grid<R>& grid, int i, R kink) {
  const R x = (double(i) - grid.strike) * grid.h;
  const R payoff = device::maximum(R(0.0), 1.0 - exponential(x));
  return {device::select(device::absolute(x) < 0.5 * grid.h, kink, payoff),
          device::select(put.early * (1.0 - put.split) > R(0.0), payoff, R(-unbounded))};
}

/// The explicit part of the operator at a node: jumps to nodes, jumps away and -rV, jumps to below the grid.
template <class R>
KOKKOS_INLINE_FUNCTION R explicit_part(const Certain<R>& begun, R jumps, R away, R left, R left_price) {
  return jumps + (away + (begun.strike * left - begun.asset * left_price));
}

/// The right side of a step's equations at a node, but for added diffusion and split exercise.
template <class R>
KOKKOS_INLINE_FUNCTION R right_side(const StepFactors<R>& f, R value, R before, R fresh, R stale) {
  return f.value * value - f.before * before + f.fresh * fresh - f.stale * stale;
}

/// What exercise adds to a step of split puts.
template <class Workers, class R>
KOKKOS_INLINE_FUNCTION void split_exercise(const Workers& workers, const PutPack<R>& put, const Grid<R>& grid,
                                           R diagonal, R* now, R* force) {
  workers.each([=, &put, &grid](int lane) {
    for (int i = 1 + lane; i < grid.mesh; i += workers.lanes) {
      const R payoff = device::maximum(R(0.0), 1.0 - exponential((double(i) - grid.strike) * grid.h));
      const R pushed = device::maximum(payoff, now[i] - force[i] / diagonal);
      force[i] = put.split * device::maximum(R(0.0), force[i] + diagonal * (payoff - now[i]));
      now[i] = device::select(put.split > R(0.0), pushed, now[i]);
    }
  });
}

/// One step: jumps and -r f explicit and extrapolated, diffusion and drift implicit. Exercise is the linear
/// complementarity problem, solved exactly where it pays on a half line (Brennan and Schwartz 1977): the
/// matrix is eliminated from above, where its factors are those of the whole line, and
/// x_i = max(payoff_i, a x_{i-1} + y_i). Where exercise pays between two boundaries it is split off (Ikonen
/// and Toivanen 2004).
template <class Workers, class R>
KOKKOS_INLINE_FUNCTION void step(const Workers& workers, const PutPack<R>& put, const Jumps<R>& jumps,
                                 const Grid<R>& grid, const JumpSpectrum<R>& spectrum, const March<R>& march,
                                 const StepFactors<R>& f, const Certain<R>& begun) {
  const int mesh = grid.mesh, block = block_of(mesh, workers.lanes);
  R* const now = march.value[0];
  const R *value = march.value[1], *before = march.value[2];
  R* const jump = march.jump[0];
  const R* jump_before = march.jump[1];
  R *other = march.other, *y = march.y, *force = march.force;
  const R *left = jumps.left, *left_price = jumps.left_price;
  const bool transformed = is_transformed(mesh, workers.lanes);
  if (transformed) {
    sum_by_transforms(workers, mesh, spectrum, value, jump, reinterpret_cast<ComplexNumber<R>*>(other));
  } else {
    convolve(workers, mesh, jumps.w, value, jump, other);
  }
  const R stay = -jumps.rate - put.rate;
  const bool bends = !workers.all(f.bend <= R(0.0));
  const R beyond = bends ? taken_beyond(f) : R(0.0);
  workers.each([=, &f, &put, &begun](int lane) {
    for (int i = lane * block; i < (lane + 1) * block; ++i) {
      if (i == 0 || i >= mesh) {
        y[i] = 0.0;
        continue;
      }
      const R sum = transformed ? jump[i] : jump[i] + other[i];
      const R fresh = explicit_part(begun, sum, stay * value[i], left[i], left_price[i]);
      jump[i] = fresh;
      R right = right_side(f, value[i], before[i], fresh, jump_before[i]);
      if (bends) {
        const bool last = i + 1 == mesh;
        const R bend = value[i - 1] - 2.0 * value[i] + (last ? beyond * value[i] : value[i + 1]);
        const R bend_before = before[i - 1] - 2.0 * before[i] + (last ? beyond * before[i] : before[i + 1]);
        right = right - (f.bend * bend - f.bend_before * bend_before);
      }
      if (put.any_split) right += f.inverse * force[i];
      y[i] = right;
    }
  });
  recur_backward(workers, {y}, block, f.from_right, march.slot);
  recur_forward(workers, now, y, march.floor, block, mesh, f.from_left, f.edge, march.slot);
  if (put.any_split) split_exercise(workers, put, grid, f.diagonal, now, force);
}

}  // namespace drogue::options

#pragma once

#include "kernels/options/pide/scheme.hpp"
#include "kernels/options/transforms/fourier_sum.hpp"

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
  R* slot;   ///< (9 most_lanes)
};

/// The sums over jumps w_{j-i} v_j, j = 0 .. mesh - 1, into `out` (j in the lower half) and `other`: 8 nodes
/// and half of the j a task, so that a value read serves 8 of them.
template <class ThreadGroup, class R>
KOKKOS_INLINE_FUNCTION void convolve(const ThreadGroup& workers, int mesh, const R* w, const R* v, R* out,
                                     R* other) {
  const WeightLayout<R> layout(mesh);
  const int octets = (mesh + 7) / 8, halved = (octets + 1) / 2;
  workers.each([=](int thread) {
    for (int task = thread; task < 2 * octets; task += workers.threads()) {
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

/// Time value, of the strike, that may be rounding alone.
inline constexpr double no_time_value = 1e-13;

/// Whether a put's value is its payoff `nodes` above the strike: what differs by less than rounding is
/// exercised.
KOKKOS_INLINE_FUNCTION bool is_exercised(double value, int nodes, double h) {
  return !(value - (1.0 - exponential(nodes * h)) > no_time_value);
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
template <class ThreadGroup, class R>
KOKKOS_INLINE_FUNCTION void split_exercise(const ThreadGroup& workers, const PutPack<R>& put,
                                           const Grid<R>& grid, R diagonal, R* now, R* force) {
  workers.each([=, &put, &grid](int thread) {
    for (int i = 1 + thread; i < grid.mesh; i += workers.threads()) {
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
template <class ThreadGroup, class R>
KOKKOS_INLINE_FUNCTION void step(const ThreadGroup& workers, const PutPack<R>& put, const Jumps<R>& jumps,
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

#pragma once

#include "kernels/options/pide/scheme.hpp"
#include "kernels/options/transforms/fourier_sum.hpp"

namespace drogue::options {

/// Node arrays of a march, (node_count) each, and the other work arrays of a step; rows of the scratch
/// memory.
template <class R>
struct March {
  R* value[3];  ///< at the end of the step, at its beginning, and one step before
  R* jump[2];   ///< explicit operator at the beginning of the step and one step before
  R* other;     ///< second half of the sum over jumps; with the following `y` the memory of transforms
  R* y;
  R* floor;       ///< payoff; `-unbounded` without early exercise
  R* multiplier;  ///< Lagrange multiplier of split exercise, per year
  R* scratch;     ///< (9 max_lanes)
};

/// Sums over jumps w_{j-i} v_j, j = 0 .. mesh - 1, into `out` (lower half of the j) and `other` (upper half).
/// A task computes 8 nodes for one half, so that a loaded value serves 8 sums.
template <class ThreadGroup, class R>
KOKKOS_INLINE_FUNCTION void convolve(const ThreadGroup& group, int mesh, const R* w, const R* v, R* out,
                                     R* other) {
  const WeightLayout<R> layout(mesh);
  const int octets = (mesh + 7) / 8, halved = (octets + 1) / 2;
  group.each([=](int thread) {
    for (int task = thread; task < 2 * octets; task += group.threads()) {
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

/// Time values up to this, as a fraction of the strike, may be rounding.
inline constexpr double time_value_tolerance = 1e-13;

/// Whether the value `nodes` nodes above the strike equals the payoff up to rounding, which means exercise.
KOKKOS_INLINE_FUNCTION bool is_exercised(double value, int nodes, double h) {
  return !(value - (1.0 - exponential(nodes * h)) > time_value_tolerance);
}

/// Initial value at a node, and the lower bound of its value during the march.
template <class R>
struct InitialNode {
  R value, floor;
};

/// Payoff at a node; `strike_value` replaces it at the strike. No lower bound without early exercise or with
/// split exercise.
template <class R>
KOKKOS_INLINE_FUNCTION InitialNode<R> initial_node(const PutPack<R>& put, const Grid<R>& grid, int i,
                                                   R strike_value) {
  const R x = (double(i) - grid.strike) * grid.h;
  const R payoff = device::maximum(R(0.0), 1.0 - exponential(x));
  return {device::select(device::absolute(x) < 0.5 * grid.h, strike_value, payoff),
          device::select(put.early * (1.0 - put.split) > R(0.0), payoff, R(-unbounded))};
}

/// Explicit operator at a node: jumps to nodes, jumps away and -rV (`away`), and jumps to below the grid.
template <class R>
KOKKOS_INLINE_FUNCTION R explicit_part(const DiscountFactors<R>& discount, R jumps, R away, R exit_mass,
                                       R exit_price) {
  return jumps + (away + (discount.strike * exit_mass - discount.asset * exit_price));
}

/// Right-hand side of a step's equations at a node, without added diffusion and split exercise.
template <class R>
KOKKOS_INLINE_FUNCTION R right_side(const StepFactors<R>& f, R value, R before, R explicit_now,
                                    R explicit_before) {
  return f.value * value - f.before * before + f.explicit_now * explicit_now -
         f.explicit_before * explicit_before;
}

/// Projection step of split exercise (Ikonen and Toivanen 2004): updates the values and the multipliers.
template <class ThreadGroup, class R>
KOKKOS_INLINE_FUNCTION void apply_split_exercise(const ThreadGroup& group, const PutPack<R>& put,
                                                 const Grid<R>& grid, R diagonal, R* now, R* multiplier) {
  group.each([=, &put, &grid](int thread) {
    for (int i = 1 + thread; i < grid.mesh; i += group.threads()) {
      const R payoff = device::maximum(R(0.0), 1.0 - exponential((double(i) - grid.strike) * grid.h));
      const R pushed = device::maximum(payoff, now[i] - multiplier[i] / diagonal);
      multiplier[i] = put.split * device::maximum(R(0.0), multiplier[i] + diagonal * (payoff - now[i]));
      now[i] = device::select(put.split > R(0.0), pushed, now[i]);
    }
  });
}

/// One time step: jumps and -r V explicit and extrapolated, diffusion and drift implicit. Exercise on a half
/// line is a linear complementarity problem, which is solved exactly (Brennan and Schwartz 1977). The matrix
/// is eliminated from above, with the factors of the infinite line, and x_i = max(payoff_i, a x_{i-1} + y_i).
/// Exercise between two boundaries is split off (Ikonen and Toivanen 2004).
template <class ThreadGroup, class R>
KOKKOS_INLINE_FUNCTION void step(const ThreadGroup& group, const PutPack<R>& put, const Jumps<R>& jumps,
                                 const Grid<R>& grid, const JumpSpectrum<R>& spectrum, const March<R>& march,
                                 const StepFactors<R>& f, const DiscountFactors<R>& discount) {
  const int mesh = grid.mesh, block = block_of(mesh, group.lanes);
  R* const now = march.value[0];
  const R *value = march.value[1], *before = march.value[2];
  R* const jump = march.jump[0];
  const R* jump_before = march.jump[1];
  R *other = march.other, *y = march.y, *multiplier = march.multiplier;
  const R *exit_mass = jumps.exit_mass, *exit_price = jumps.exit_price;
  const bool transformed = is_transformed(mesh, group.lanes);
  if (transformed) {
    sum_by_transforms(group, mesh, spectrum, value, jump, reinterpret_cast<ComplexNumber<R>*>(other));
  } else {
    convolve(group, mesh, jumps.w, value, jump, other);
  }
  const R reaction = -jumps.rate - put.rate;
  const bool compensates = !group.all(f.compensation <= R(0.0));
  const R ghost = compensates ? ghost_factor(f, jumps.moved / (grid.h * grid.h)) : R(0.0);
  group.each([=, &f, &put, &discount](int lane) {
    for (int i = lane * block; i < (lane + 1) * block; ++i) {
      if (i == 0 || i >= mesh) {
        y[i] = 0.0;
        continue;
      }
      const R sum = transformed ? jump[i] : jump[i] + other[i];
      const R explicit_now = explicit_part(discount, sum, reaction * value[i], exit_mass[i], exit_price[i]);
      jump[i] = explicit_now;
      R right = right_side(f, value[i], before[i], explicit_now, jump_before[i]);
      if (compensates) {
        const bool last = i + 1 == mesh;
        const R difference = value[i - 1] - 2.0 * value[i] + (last ? ghost * value[i] : value[i + 1]);
        const R difference_before =
            before[i - 1] - 2.0 * before[i] + (last ? ghost * before[i] : before[i + 1]);
        right = right - (f.compensation * difference - f.compensation_before * difference_before);
      }
      if (put.any_split) right += f.inverse_pivot * multiplier[i];
      y[i] = right;
    }
  });
  recur_backward(group, {y}, block, f.from_right, march.scratch);
  recur_forward(group, now, y, march.floor, block, mesh, f.from_left, f.left_value, march.scratch);
  if (put.any_split) apply_split_exercise(group, put, grid, f.diagonal, now, multiplier);
}

}  // namespace drogue::options

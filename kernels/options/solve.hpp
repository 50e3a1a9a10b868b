#pragma once

#include "kernels/options/answer.hpp"

namespace drogue::options {

/// Rows of scratch memory for the solves of one team.
template <class R>
struct Memory {
  R *s, *c, *slot;
  ClampedMap<R>* maps;
  R* w;
  R* nodes;         ///< 11 rows of `node_count`
  Put* puts;        ///< of the members, as the next
  Answer* answers;  ///< on the grid and on the coarser one

  [[nodiscard]] KOKKOS_INLINE_FUNCTION static std::size_t bytes(int mesh) {
    return sizeof(R) * static_cast<std::size_t>(2 * Mixture::size + 5 * lanes + 6 * lanes +
                                                WeightLayout<R>(mesh).size() + 11 * node_count(mesh)) +
           device::Access<R>::lanes * (sizeof(Put) + 2 * sizeof(Answer));
  }
  KOKKOS_INLINE_FUNCTION Memory(void* place, int mesh)
      : s(static_cast<R*>(place)),
        c(s + Mixture::size),
        slot(c + Mixture::size),
        maps(reinterpret_cast<ClampedMap<R>*>(slot + 5 * lanes)),
        w(slot + 11 * lanes),
        nodes(w + WeightLayout<R>(mesh).size()),
        puts(reinterpret_cast<Put*>(nodes + 11 * node_count(mesh))),
        answers(reinterpret_cast<Answer*>(puts + device::Access<R>::lanes)) {}
  [[nodiscard]] KOKKOS_INLINE_FUNCTION R* row(int k, int count) const { return nodes + k * count; }
};

/// Where more of a solve's first member is left than its answer, in the memory of the backend; or nowhere.
struct Record {
  double* time = nullptr;  ///< (steps): to expiry, years
  double* boundary;        ///< (steps): x at these times
  double* x;               ///< (mesh + 1): nodes, at maturity
  double* value;           ///< (mesh + 1)
};

/// The end of step n of `steps`, years: steps grow with the square root of time, as the solution's changes
/// shrink.
template <class R>
KOKKOS_INLINE_FUNCTION R step_end(R maturity, int n, int steps) {
  const double part = double(n) / steps;
  return maturity * (part * Kokkos::sqrt(part));
}

/// Marches from expiry to the puts' maturities on `grid`; `answers` gets one for each member. Returns the
/// values of the nodes, which stay in the memory until the next solve.
template <class Workers, class R>
KOKKOS_INLINE_FUNCTION const R* solve(const Workers& workers, const PutPack<R>& put, const Law<R>& law,
                                      const Tails<R>& tails, const Grid<R>& grid, int steps,
                                      const Memory<R>& memory, const Record& record, Answer* answers) {
  constexpr int members = device::Access<R>::lanes;
  const int mesh = grid.mesh, count = node_count(mesh);
  const R h = grid.h;
  const Jumps<R> jumps = jumps_of(workers, put, law, tails, grid,
                                  {memory.w, memory.row(9, count), memory.row(10, count), memory.slot});
  March<R> march{{memory.row(0, count), memory.row(1, count), memory.row(2, count)},
                 {memory.row(3, count), memory.row(4, count)},
                 memory.row(5, count),
                 memory.row(6, count),
                 memory.row(7, count),
                 memory.row(8, count),
                 memory.maps,
                 memory.slot};
  // The kink of the payoff, as far as it gets smoothed out: h/12 is what the rule of trapezoids, which sums
  // over nodes amount to, lacks there.
  const R spread = 2.0 * jumps.diffusion * put.maturity;
  const R kink = h * (1.0 / 12) * spread / (spread + h * h);
  workers.each([=](int lane) {
    for (int k = lane; k < 9 * count; k += lanes) memory.nodes[k] = 0.0;
  });
  workers.each([=, &put](int lane) {
    for (int i = lane; i < mesh; i += lanes) {
      const R x = (double(i) - grid.strike) * h;
      const R payoff = device::maximum(R(0.0), 1.0 - exponential(x));
      march.value[1][i] = device::select(device::absolute(x) < 0.5 * h, kink, payoff);
      march.floor[i] = device::select(put.early * (1.0 - put.split) > R(0.0), payoff, R(-unbounded));
    }
  });
  const R advection = 0.5 * jumps.drift / h, diffusion = jumps.diffusion / (h * h);
  const R lowest = -grid.strike * h;
  // e^{-r t} - e^{x - q t} is stationary where r/q = e^{x + (r - q) t}.
  const R quotient = put.rate / put.dividend;
  const auto stationary = quotient > R(1e-300);
  const R best = device::select(
      stationary,
      (logarithm(device::select(stationary, device::minimum(quotient, R(1e300)), R(1.0))) - lowest) /
          (put.rate - put.dividend),
      R(0.0));
  const Scheme<R> scheme{diffusion - advection, diffusion + advection, best, lowest};
  R begin = 0.0, dt_before = 1.0, dt = 1.0, ratio = 0.0;
  for (int n = 1; n <= steps; ++n) {
    const R end = step_end(put.maturity, n, steps);
    dt = end - begin;
    ratio = n <= 2 ? R(0.0) : dt / dt_before;
    step(workers, put, jumps, grid, scheme, march, end, dt, ratio);
    if (record.time != nullptr) {
      workers.each([=](int lane) {
        if (lane != 0) return;
        const auto at_strike = static_cast<int>(device::Access<R>::lane(grid.strike, 0));
        const double width = device::Access<R>::lane(h, 0);
        record.time[n - 1] = device::Access<R>::lane(end, 0);
        record.boundary[n - 1] =
            memory.puts[0].early
                ? boundary_of({reinterpret_cast<const double*>(march.value[0]), members}, at_strike, width)
                : device::portable::not_a_number();
      });
    }
    R* const oldest = march.value[2];
    march.value[2] = march.value[1];
    march.value[1] = march.value[0];
    march.value[0] = oldest;
    R* const jump = march.jump[0];
    march.jump[0] = march.jump[1];
    march.jump[1] = jump;
    dt_before = dt;
    begin = end;
  }
  // dV/dtau by the formula of the step; after the rotation value[0] is what value[2] was.
  const R per = 1.0 / (dt * (1.0 + ratio));
  workers.each([=](int lane) {
    for (int i = lane; i < mesh; i += lanes)
      march.y[i] = (1.0 + 2.0 * ratio) * per * march.value[1][i] - (1.0 + ratio) / dt * march.value[2][i] +
                   ratio * ratio * per * march.value[0][i];
  });
  if (record.time != nullptr) {
    workers.each([=](int lane) {
      for (int i = lane; i <= mesh; i += lanes) {
        record.x[i] = device::Access<R>::lane((double(i) - grid.strike) * h, 0);
        record.value[i] = device::Access<R>::lane(march.value[1][i], 0);
      }
    });
  }
  const Certain<R> ended = certain(put, lowest, scheme.best, put.maturity);
  workers.each([=](int lane) {
    for (int k = lane; k < members; k += lanes) {
      const auto member = [k](const R& number) { return device::Access<R>::lane(number, k); };
      answers[k] = answer_of(memory.puts[k], {reinterpret_cast<const double*>(march.value[1]) + k, members},
                             {reinterpret_cast<const double*>(march.y) + k, members},
                             {mesh,
                              static_cast<int>(member(grid.strike)),
                              member(h),
                              {member(ended.strike), member(ended.asset)}});
    }
  });
  return march.value[1];
}

}  // namespace drogue::options

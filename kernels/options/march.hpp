#pragma once

#include "kernels/options/jumps.hpp"

namespace drogue::options {

/// Values of the nodes, (node_count) each, and the rest that steps need; rows of the scratch memory.
template <class R>
struct March {
  R* value[3];  ///< of this step's end, its beginning, and of the step before
  R* jump[2];   ///< the explicit part of the operator, of the beginning and of the step before
  R* other;     ///< the other half of the sum over jumps
  R* y;
  R* floor;             ///< payoff; `-unbounded` where early exercise is not looked for
  R* force;             ///< what exercise pushes with, of split puts
  ClampedMap<R>* maps;  ///< (2 lanes)
  R* slot;              ///< (2 lanes)
};

/// The value e^{-r t} - e^{x - q t} of a put that will certainly be exercised, at the time t <= tau that is
/// best for node 0 (for European ones tau); below node 0 it is the value at all x.
template <class R>
struct Certain {
  R strike, asset;  ///< e^{-r t}, e^{-q t}
};

template <class R>
KOKKOS_INLINE_FUNCTION Certain<R> certain(const PutPack<R>& put, R x, R best, R tau) {
  const R late = exponential(-put.rate * tau), late_asset = exponential(-put.dividend * tau);
  const R t = device::maximum(R(0.0), device::minimum(best, tau));
  const R between = exponential(-put.rate * t), between_asset = exponential(-put.dividend * t);
  const R asset = exponential(x);
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
    for (int task = lane; task < 2 * octets; task += lanes) {
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
  R lowest;        ///< x of node 0
};

/// Implicit diffusion beyond D that the explicit jumps need, of which as much is taken back explicitly:
/// IMEX-BDF2 damps the highest mode of a symbol I implicit, E explicit while 3E <= 4/dt + I.
template <class R>
KOKKOS_INLINE_FUNCTION R added_diffusion(const PutPack<R>& put, const Jumps<R>& jumps, R diffusion, R dt) {
  R added = 0.0;
  for (int k = 0; k < 16; ++k) {
    const double form = 2.0 - 2.0 * angle_cosine(k);
    const R need = 3.0 * (jumps.symbol[k] + put.rate) - diffusion * form - 3.6 / dt;
    added = device::maximum(added, need * (0.25 / form));
  }
  return added;
}

/// One step of IMEX-BDF2, or of IMEX-Euler while `ratio` is 0: jumps and -r f explicit and extrapolated,
/// diffusion and drift implicit. Exercise is the linear complementarity problem, solved exactly where it
/// pays on a half line (Brennan and Schwartz 1977): the matrix is eliminated from above, where its factors
/// are those of the whole line, and x_i = max(payoff_i, a x_{i-1} + y_i). Where exercise pays between two
/// boundaries it is split off (Ikonen and Toivanen 2004).
template <class Workers, class R>
KOKKOS_INLINE_FUNCTION void step(const Workers& workers, const PutPack<R>& put, const Jumps<R>& jumps,
                                 const Grid<R>& grid, const Scheme<R>& scheme, const March<R>& march, R tau,
                                 R dt, R ratio) {
  const int mesh = grid.mesh, block = block_of(mesh);
  R* const now = march.value[0];
  const R *value = march.value[1], *before = march.value[2];
  R* const jump = march.jump[0];
  const R* jump_before = march.jump[1];
  R *other = march.other, *y = march.y, *force = march.force;
  const R *left = jumps.left, *left_price = jumps.left_price, *floor = march.floor;
  convolve(workers, mesh, jumps.w, value, jump, other);

  const R per = 1.0 / (dt * (1.0 + ratio));
  const R c0 = (1.0 + 2.0 * ratio) * per, c1 = (1.0 + ratio) / dt, c2 = ratio * ratio * per;
  const R diffusion = 0.5 * (scheme.lower + scheme.upper);
  const R added = added_diffusion(put, jumps, diffusion, dt);
  const R lower = scheme.lower + added, upper = scheme.upper + added;
  const R diagonal = c0 + lower + upper;
  const R pivot = 0.5 * (diagonal + device::square_root(diagonal * diagonal - 4.0 * lower * upper));
  const R inverse = 1.0 / pivot;
  const Certain<R> begun = certain(put, scheme.lowest, scheme.best, tau - dt);
  const R stay = -jumps.rate - put.rate;
  workers.each([=](int lane) {
    for (int m = 0; m < block; ++m) {
      const int i = 1 + lane * block + m;
      if (i >= mesh) {
        y[i] = 0.0;
        continue;
      }
      const R outside = begun.strike * left[i] - begun.asset * left_price[i];
      const R explicit_part = (jump[i] + other[i]) + (stay * value[i] + outside);
      jump[i] = explicit_part;
      const R bend = value[i - 1] - 2.0 * value[i] + value[i + 1];
      const R bend_before = before[i - 1] - 2.0 * before[i] + before[i + 1];
      const R right = c1 * value[i] - c2 * before[i] + (1.0 + ratio) * explicit_part -
                      ratio * jump_before[i] - added * ((1.0 + ratio) * bend - ratio * bend_before) +
                      force[i];
      y[i] = right * inverse;
    }
  });
  recur_backward(workers, y, 1, block, upper * inverse, march.slot);
  const Certain<R> ended = certain(put, scheme.lowest, scheme.best, tau);
  const R edge = device::maximum(R(0.0), ended.strike - ended.asset * exponential(scheme.lowest));
  recur_forward(workers, now, y, floor, 1, block, mesh, lower * inverse, edge, march.maps);
  workers.each([=](int lane) {
    if (lane == 0) now[0] = edge;
    if (!put.any_split) return;
    for (int i = 1 + lane; i < mesh; i += lanes) {
      const R payoff = device::maximum(R(0.0), 1.0 - exponential((double(i) - grid.strike) * grid.h));
      const R pushed = device::maximum(payoff, now[i] - force[i] / c0);
      force[i] = put.split * device::maximum(R(0.0), force[i] + c0 * (payoff - now[i]));
      now[i] = device::select(put.split > R(0.0), pushed, now[i]);
    }
  });
}

}  // namespace drogue::options

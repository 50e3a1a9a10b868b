#pragma once

#include "kernels/options/levy/levy_measure.hpp"

namespace drogue::options {

/// Jumps longer than the grid: masses, a year, of those downwards and upwards, the same of e^y, and the
/// integral of y^2.
template <class R>
struct Tails {
  R down, down_price, up, up_price, variance;
};

/// Of a mixture they are exponential integrals, of the others closed forms. `length` is that of the grid.
template <class ThreadGroup, class R>
KOKKOS_INLINE_FUNCTION Tails<R> tails_of(const ThreadGroup& workers, const PutPack<R>& put,
                                         const LevyMeasure<R>& law, R length) {
  if (put.model == Model::kou) {
    const R p = put.jump[1], up = put.jump[2], down = put.jump[3];
    const R a = put.jump[0] * p * exponential(-up * length),
            b = put.jump[0] * (1.0 - p) * exponential(-down * length);
    const R i = 1.0 / up, j = 1.0 / down;
    return {b, b * down / (down + 1.0) * exponential(-length), a, a * up / (up - 1.0) * exponential(length),
            a * (length * length + 2.0 * i * (length + i)) + b * (length * length + 2.0 * j * (length + j))};
  }
  if (put.model == Model::merton) {
    const R rate = put.jump[0], m = put.jump[1], s = merton_deviation(put);
    const R price = rate * exponential(m + 0.5 * s * s), square = m * m + s * s;
    const R z_up = (length - m) / s, z_down = (length + m) / s;
    const R up = normal_above(z_up), down = normal_above(z_down);
    const auto density = [](R z) { return 0.3989422804014327 * exponential(-0.5 * z * z); };
    return {
        rate * down, price * normal_above(z_down + s), rate * up, price * normal_above(z_up - s),
        rate * (square * (up + down) + s * ((length + m) * density(z_up) + (length - m) * density(z_down)))};
  }
  if (put.model != Model::generalized_hyperbolic) return {R(0.0), R(0.0), R(0.0), R(0.0), R(0.0)};
  const R shrink = exponential(-length);
  const Kokkos::Array<R, 5> tails = sums(workers, [&](int lane) {
    Kokkos::Array<R, 5> sum = {R(0.0), R(0.0), R(0.0), R(0.0), R(0.0)};
    for (int q = lane; q < Mixture::low; q += workers.lanes) {
      const R a = law.s[q] - put.jump[2], b = law.s[q] + put.jump[2], c = law.c[q];
      const R rate[4] = {b * length, (b + 1.0) * length, a * length, (a - 1.0) * length};
      const R down = exponential(-rate[0]), up = exponential(-rate[2]);
      const R decay[4] = {down, down * shrink, up, exponential(-rate[3])};
      R tail[4];
      exponential_integrals(rate, decay, tail);
      for (int k = 0; k < 4; ++k) sum[k] += c * tail[k];
      const R far_up = law.up[q], far_down = law.down[q];
      sum[4] += c * ((length + far_down) * far_down * down + (length + far_up) * far_up * up);
    }
    return sum;
  });
  return {tails[0], tails[1], tails[2], tails[3], tails[4]};
}

}  // namespace drogue::options

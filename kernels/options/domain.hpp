#pragma once

#include "kernels/options/law.hpp"

namespace drogue::options {

/// How far the grid reaches below and above the strike, in ln(spot/strike).
template <class R>
struct Domain {
  R below, above;
};

/// What a cut of the grid may change of the price, of the strike.
KOKKOS_INLINE_FUNCTION double cut_error(int mesh) { return 0.03 / (double(mesh) * mesh); }

/// The value at a cut is wrong only as far as a path gets back to the strike from there, so a path has to go
/// to the cut and back. By Chernoff's bound that has a probability below
///   exp(-tu (above - x0) - td above) (exp(T psi(tu)) + exp(T psi(-td)) - 2)
/// for any tilts tu, td > 0, and likewise for the lower end: both ends are the least over 12 x 12 tilts. (The
/// 2 is what paths that hardly move contribute, nearly all of a short maturity.) An
/// early exercise boundary of a put with r > 0 lies above ln(t/(1+t)) for every t with psi(-t) <= r
/// (Lundberg's bound on the infimum, Mordecki 2002), and below it the value is known.
/// `scratch` holds 5 lanes values.
template <class Workers, class R>
KOKKOS_INLINE_FUNCTION Domain<R> domain_of(const Workers& workers, const PutPack<R>& put, const Law<R>& law,
                                           double error, R* scratch) {
  constexpr int n = 12;
  R *tilt = scratch, *cumulant = scratch + lanes, *best = scratch + 2 * lanes, *grown = scratch + 4 * lanes;
  const R up = decay_up(put), down = decay_down(put), maturity = put.maturity, rate = put.rate;
  const R variance = put.variance + law.variance;
  const double depth = -device::portable::log(error);
  const R gaussian = device::square_root(2.0 * depth / (device::maximum(variance, R(1e-12)) * maturity));
  workers.each([&, tilt, cumulant](int lane) {
    if (lane > 2 * n) return;
    R theta = 1.0;
    if (lane < 2 * n) {
      R t = 2.0 * gaussian;
      for (int k = lane % n; k > 0; --k) t = t * 0.7071067811865476;
      theta = lane < n ? t * up * device::reciprocal(t + up) : -(t * down * device::reciprocal(t + down));
    }
    tilt[lane] = theta;
    cumulant[lane] = 0.5 * put.variance * theta * theta + jump_cumulant(put, law, theta);
  });
  const R mean = put.rate - put.dividend - cumulant[2 * n];
  // What a path earns on its way: a discount, or, where r < 0, the opposite.
  const R base = depth + device::maximum(R(0.0), -rate * maturity);
  const R spot_above = device::maximum(put.log_spot, R(0.0)),
          spot_below = device::maximum(-put.log_spot, R(0.0));
  workers.each([&, tilt, cumulant, grown](int lane) {
    if (lane < 2 * n)
      grown[lane] =
          exponential(device::maximum(R(0.0), maturity * (cumulant[lane] + mean * tilt[lane] - rate)));
  });
  workers.each([&, tilt, grown, best](int lane) {
    if (lane >= n) return;
    const R tu = tilt[lane];
    R below = 1e30, above = 1e30;
    for (int k = 0; k < n; ++k) {
      const R td = -tilt[n + k];
      const R moved = grown[lane] + grown[n + k] - 2.0;
      const R need = base + logarithm(device::maximum(moved, R(1e-3))), per = device::reciprocal(tu + td);
      above = device::minimum(above, (need + tu * spot_above) * per);
      below = device::minimum(below, (need + td * spot_below) * per);
    }
    best[lane] = below;
    best[lanes + lane] = above;
  });
  Domain<R> domain{best[0], best[lanes]};
  for (int k = 1; k < n; ++k) {
    domain.below = device::minimum(domain.below, best[k]);
    domain.above = device::minimum(domain.above, best[lanes + k]);
  }
  // psi is convex, so a chord lies above it: where the chord between two tilts meets r, psi is no larger.
  R root = 0.0, at = 0.0, value = 0.0;
  for (int k = n - 1; k >= 0; --k) {
    const R t = -tilt[n + k], psi = cumulant[n + k] - mean * t;
    const R chord =
        at + (t - at) * (rate - value) * device::reciprocal(device::maximum(psi - value, R(1e-300)));
    const auto inside = psi <= rate;
    root = device::select(inside, t, device::select(root > at, root, device::minimum(chord, t)));
    value = device::select(inside, psi, value);
    at = device::select(inside, t, at);
  }
  const R exercised =
      device::select(root > R(1e-6), logarithm(1.0 + 1.0 / device::maximum(root, R(1e-6))), R(1e30));
  const R limit = device::select(put.early * rate > R(0.0), exercised, R(1e30));
  domain.below = device::minimum(domain.below, limit);
  workers.meet();
  return domain;
}

}  // namespace drogue::options

#pragma once

#include "kernels/options/levy/levy_measure.hpp"

namespace drogue::options {

/// How far the grid reaches below and above the strike, in ln(spot/strike).
template <class R>
struct Domain {
  R below, above;
};

/// What a cut of the grid may change of the price by the estimate that chooses it, of the strike.
KOKKOS_INLINE_FUNCTION double cut_error(int mesh) { return 0.03 / (double(mesh) * mesh); }

/// What it does change, of the strike. Chernoff's bounds of the legs lack what a tail is short of its bound,
/// for a normal one 1/(t s sqrt(2 pi)), t the tilt and s the deviation, below 0.09 for each path that gets to
/// a cut and back, and what such a path finds below the strike, less than all of it. So the ends are chosen
/// with care to spare, and the part is fitted.
KOKKOS_INLINE_FUNCTION double cut_doubt(int mesh) { return 0.04 * cut_error(mesh); }

inline constexpr int tilts = 12;  ///< of a bound, upwards and downwards each

/// A tilt that is t where it is small, and short of where the law decays no faster.
template <class R>
KOKKOS_INLINE_FUNCTION R tilt_upwards(R t, R decay) {
  return t * decay * device::reciprocal(t + decay);
}

/// ln E e^{theta X} of a year without the drift.
template <class R>
KOKKOS_INLINE_FUNCTION R cumulant_of(const PutPack<R>& put, const LevyMeasure<R>& law, R theta) {
  return 0.5 * put.variance * theta * theta + jump_cumulant(put, law, theta);
}

/// How far below the strike a grid has to reach for a premium of early exercise that does not begin at the
/// strike; 0 where it does. Exercise gains r - q e^x a year: if q < r < 0 above the x = -onset where that is
/// 0, if 0 < r < q below it. What is assumed at the cut lacks at most that premium, so it matters if a path
/// gets to the cut and from there, by the same bound, back up to -onset in the one case, and in the other if
/// it gets to the cut, unless not even -onset is within reach.
template <class ThreadGroup, class R>
KOKKOS_INLINE_FUNCTION R reach_of_premium(const ThreadGroup& workers, const PutPack<R>& put, R spot_below,
                                          R base, const R* tilt, const R* grown) {
  constexpr int n = tilts;
  const R farther = put.early * (put.dividend - put.rate) * put.rate;
  if (workers.all(farther <= R(0.0))) return 0.0;
  const auto late = farther > R(0.0);
  const R quotient = device::select(late, put.dividend / put.rate, R(1.0));
  const R onset = logarithm(device::minimum(quotient, R(1e300)));
  const auto between = put.rate < R(0.0);
  const R gain = put.maturity * device::select(between, put.rate - put.dividend, put.rate);
  const R most = base + rough_logarithm(device::maximum(device::minimum(gain, R(1.0)), R(1e-300)));
  const auto least_reach = [&, tilt, grown](int lane) {
    Kokkos::Array<R, 1> least = {R(1e30)};
    for (int pair = lane; pair < n * n; pair += workers.lanes) {
      const int k = pair / n, m = n + pair % n;
      const R back = device::select(between, tilt[k], R(0.0)), td = -tilt[m];
      const R need = most + rough_logarithm(device::maximum(grown[k] + grown[m] - 2.0, R(1e-3)));
      least[0] = device::minimum(least[0], (need + td * spot_below + back * onset) / (back + td));
    }
    return least;
  };
  const R reach = minima(workers, least_reach)[0];
  return device::select(late & (between | (reach > onset)), reach, R(0.0));
}

/// The ends of a domain that is wide since tilts on the scale of the deviation do not suit both sides of the
/// law, one of which may decay ever so slowly: from tilts 100 4^{-k} and 0, which is a path that need not get
/// to the cut, or need not come back. `base` and `mean` are those of `domain_of`; `tilt` and `growth` hold
/// `most_lanes` values.
template <class ThreadGroup, class R>
KOKKOS_INLINE_FUNCTION Domain<R> wide_domain(const ThreadGroup& workers, const PutPack<R>& put,
                                             const LevyMeasure<R>& law, R base, R mean, R* tilt, R* growth) {
  constexpr int n = tilts;
  const R up = decay_up(put), down = decay_down(put);
  workers.each([=, &put, &law](int thread) {
    for (int m = thread; m < 2 * n; m += workers.threads()) {
      const double t = 100.0 * power_of_two(rounding_shift - 2 * (m % n));
      const R theta = m < n ? tilt_upwards(R(t), up) : -tilt_upwards(R(t), down);
      tilt[m] = theta;
      growth[m] =
          device::maximum(R(0.0), put.maturity * (cumulant_of(put, law, theta) + mean * theta - put.rate));
    }
  });
  const R spot_above = device::maximum(put.log_spot, R(0.0)),
          spot_below = device::maximum(-put.log_spot, R(0.0));
  const auto least_ends = [=](int lane) {
    Kokkos::Array<R, 2> least = {R(1e30), R(1e30)};
    for (int pair = lane; pair < n * (n + 2); pair += workers.lanes) {
      const int k = pair / (n + 1), m = n + pair % (n + 1);  // the last k and m stand for the tilt 0
      const R tu = k < n ? tilt[k] : R(0.0), td = m < 2 * n ? -tilt[m] : R(0.0);
      const R grown =
          device::maximum(k < n ? growth[k] : R(0.0), m < 2 * n ? growth[m] : R(0.0)) + 0.6931471805599453;
      const R per = device::reciprocal(tu + td);
      least[0] = device::minimum(least[0], (base + grown + td * spot_below) * per);
      least[1] = device::minimum(least[1], (base + grown + tu * spot_above) * per);
    }
    return least;
  };
  const Kokkos::Array<R, 2> ends = minima(workers, least_ends);
  return {ends[0], ends[1]};
}

/// An error at a cut matters only if a path reaches the cut and then returns to the strike. Chernoff's bounds
/// of both legs, with tilts tu, td > 0, suggest the error
///   exp(-tu (above - x0) - td above) (|g(tu) - 1| + |g(-td) - 1|),   g(t) = exp(T (psi(t) - r)),
/// times e^{-r T} where r < 0, and likewise for the lower end: both ends are the least over 12 x 12 tilts.
/// The bounds themselves have max(1, g); the 1 is what paths that hardly move contribute, nearly all of a
/// short maturity. Taking it off, though not less than 1e-3 is left, makes this an estimate and no bound. An
/// early exercise boundary of a put with r > 0 lies above ln(t/(1+t)) for every t with psi(-t) <= r
/// (Lundberg's bound on the infimum, Mordecki 2002), and below it the value is known. `scratch` holds 3
/// `most_lanes` values.
template <class ThreadGroup, class R>
KOKKOS_INLINE_FUNCTION Domain<R> domain_of(const ThreadGroup& workers, const PutPack<R>& put,
                                           const LevyMeasure<R>& law, double error, R* scratch) {
  constexpr int n = tilts;
  R *tilt = scratch, *cumulant = scratch + most_lanes, *grown = scratch + 2 * most_lanes;
  const R up = decay_up(put), down = decay_down(put), maturity = put.maturity, rate = put.rate;
  const R variance = put.variance + law.variance;
  const double depth = -device::portable::log(error);
  const R gaussian = device::square_root(2.0 * depth / (device::maximum(variance, R(1e-12)) * maturity));
  workers.each([&, tilt, cumulant](int thread) {
    for (int m = thread; m <= 2 * n; m += workers.threads()) {
      R theta = 1.0;
      if (m < 2 * n) {
        const int k = m % n;
        const R t =
            2.0 * gaussian * ((k % 2 == 0 ? 1.0 : 0.7071067811865476) * power_of_two(rounding_shift - k / 2));
        theta = m < n ? tilt_upwards(t, up) : -tilt_upwards(t, down);
      }
      tilt[m] = theta;
      cumulant[m] = cumulant_of(put, law, theta);
    }
  });
  const R mean = put.rate - put.dividend - cumulant[2 * n];
  // What a path earns on its way: a discount, or, where r < 0, the opposite.
  const R base = depth + device::maximum(R(0.0), -rate * maturity);
  const R spot_above = device::maximum(put.log_spot, R(0.0)),
          spot_below = device::maximum(-put.log_spot, R(0.0));
  workers.each([&, tilt, cumulant, grown](int thread) {
    for (int m = thread; m < 2 * n; m += workers.threads()) {
      const R g = exponential(maturity * (cumulant[m] + mean * tilt[m] - rate));
      grown[m] = device::maximum(g, 2.0 - g);
    }
  });
  const auto least_ends = [&, tilt, grown](int lane) {
    Kokkos::Array<R, 2> least = {R(1e30), R(1e30)};
    for (int pair = lane; pair < n * n; pair += workers.lanes) {
      const int k = pair / n, m = n + pair % n;
      const R tu = tilt[k], td = -tilt[m], per = device::reciprocal(tu + td);
      const R grow = rough_logarithm(device::maximum(grown[k] + grown[m] - 2.0, R(1e-3)));
      const R need = base + device::select(grow < R(690.0), grow, R(1e30));  // beyond it `grown` is cut
      least[0] = device::minimum(least[0], (need + td * spot_below) * per);
      least[1] = device::minimum(least[1], (need + tu * spot_above) * per);
    }
    return least;
  };
  const Kokkos::Array<R, 2> ends = minima(workers, least_ends);
  Domain<R> domain{ends[0], ends[1]};
  const R premium = reach_of_premium(workers, put, spot_below, base, tilt, grown);
  // psi is convex, so a chord lies above it: where the chord between the last tilt at which psi is not above
  // r and the next one meets r, psi is no larger.
  R at = 0.0, value = 0.0, beyond = 0.0, above = 0.0;
  for (int k = n - 1; k >= 0; --k) {
    const R t = -tilt[n + k], psi = cumulant[n + k] - mean * t;
    const auto inside = psi <= rate;
    const auto first = beyond <= at;
    at = device::select(inside, t, at);
    value = device::select(inside, psi, value);
    beyond = device::select(inside | first, t, beyond);
    above = device::select(inside | first, psi, above);
  }
  const R rise = device::reciprocal(device::maximum(above - value, R(1e-300)));
  const R root =
      device::select(beyond > at, device::minimum(at + (beyond - at) * (rate - value) * rise, beyond), at);
  const R exercised =
      device::select(root > R(1e-6), logarithm(1.0 + 1.0 / device::maximum(root, R(1e-6))), R(1e30));
  const R limit = device::select(put.early * rate > R(0.0), exercised, R(1e30));
  workers.meet();
  // Beyond these variances what differences get is rounding, or overflows.
  const auto known = (law.variance < R(1e11)) & (put.variance < R(1e100));
  const auto wide = known & (domain.below + domain.above > R(20.0));
  if (!workers.all(device::select(wide, R(1.0), R(0.0)) <= R(0.0))) {
    const Domain<R> other = wide_domain(workers, put, law, base, mean, tilt, grown);
    domain.below = device::select(wide, device::minimum(domain.below, other.below), domain.below);
    domain.above = device::select(wide, device::minimum(domain.above, other.above), domain.above);
    workers.meet();
  }
  domain.below = device::minimum(device::maximum(domain.below, premium), limit);
  return domain;
}

}  // namespace drogue::options

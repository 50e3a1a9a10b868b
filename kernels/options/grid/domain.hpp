#pragma once

#include "kernels/options/levy/levy_measure.hpp"

namespace drogue::options {

/// Distances of the grid's ends below and above the strike, in ln(spot/strike).
template <class R>
struct Domain {
  R below, above;
};

/// Target of the estimated truncation error that determines the ends of the grid, as a fraction of the
/// strike.
KOKKOS_INLINE_FUNCTION double truncation_target(int mesh) { return 0.03 / (double(mesh) * mesh); }

/// Truncation error that is reported, as a fraction of the strike. The Chernoff bounds omit the prefactor of
/// a tail. For a normal tail it is 1/(t s sqrt(2 pi)), t the tilt and s the standard deviation, below 0.09
/// for a path to the end of the grid and back. Such a path also gains less than the strike. The factor 0.04
/// is empirical: calibrated on random contracts against Fourier prices (docs/options-error.md);
/// `OptionsError.EqualsTheTruncationErrorFarOutOfTheMoney` tests it.
KOKKOS_INLINE_FUNCTION double truncation_error(int mesh) { return 0.04 * truncation_target(mesh); }

inline constexpr int tilt_count = 12;  ///< per direction of a Chernoff bound

/// Tilt close to t for small t, and below `decay`, the rate of exponential decay of the tail.
template <class R>
KOKKOS_INLINE_FUNCTION R tilt_upwards(R t, R decay) {
  return t * decay * device::reciprocal(t + decay);
}

/// Cumulant ln E e^{theta X} of one year without the drift.
template <class R>
KOKKOS_INLINE_FUNCTION R cumulant_of(const PutPack<R>& put, const LevyMeasure<R>& measure, R theta) {
  return 0.5 * put.variance * theta * theta + jump_cumulant(put, measure, theta);
}

/// Cutoff distance below the strike for an early exercise premium that does not start at the strike; 0 if it
/// does. Exercise gains r - q e^x per year, which is 0 at x = -onset. If q < r < 0 it is positive above
/// -onset, if 0 < r < q below. The boundary value at the lower end omits at most this premium. If q < r < 0
/// the error requires a path to the end and, by the same bound, back up to -onset. If 0 < r < q it requires a
/// path to the end only, and -onset within the distance.
template <class ThreadGroup, class R>
KOKKOS_INLINE_FUNCTION R premium_cutoff_distance(const ThreadGroup& group, const PutPack<R>& put,
                                                 R spot_below, R base, const R* tilt, const R* grown) {
  constexpr int n = tilt_count;
  const R farther = put.early * (put.dividend - put.rate) * put.rate;
  if (group.all(farther <= R(0.0))) return 0.0;
  const auto late = farther > R(0.0);
  const R quotient = device::select(late, put.dividend / put.rate, R(1.0));
  const R onset = logarithm(device::minimum(quotient, R(1e300)));
  const auto between = put.rate < R(0.0);
  const R gain = put.maturity * device::select(between, put.rate - put.dividend, put.rate);
  const R most = base + rough_logarithm(device::maximum(device::minimum(gain, R(1.0)), R(1e-300)));
  const auto smallest_distance = [&, tilt, grown](int lane) {
    Kokkos::Array<R, 1> least = {R(1e30)};
    for (int pair = lane; pair < n * n; pair += group.lanes) {
      const int k = pair / n, m = n + pair % n;
      const R back = device::select(between, tilt[k], R(0.0)), td = -tilt[m];
      const R need = most + rough_logarithm(device::maximum(grown[k] + grown[m] - 2.0, R(1e-3)));
      least[0] = device::minimum(least[0], (need + td * spot_below + back * onset) / (back + td));
    }
    return least;
  };
  const R distance = minima(group, smallest_distance)[0];
  return device::select(late & (between | (distance > onset)), distance, R(0.0));
}

/// Ends of a wide domain. Tilts on the scale of the deviation do not suit a measure with one slowly decaying
/// tail. The candidates are 100 4^{-k} and 0, which stands for a path without one of its two legs. `base` and
/// `mean` are those of `domain_of`; `tilt` and `growth` hold `max_lanes` values each.
template <class ThreadGroup, class R>
KOKKOS_INLINE_FUNCTION Domain<R> wide_domain(const ThreadGroup& group, const PutPack<R>& put,
                                             const LevyMeasure<R>& measure, R base, R mean, R* tilt,
                                             R* growth) {
  constexpr int n = tilt_count;
  const R up = decay_up(put), down = decay_down(put);
  group.each([=, &put, &measure](int thread) {
    for (int m = thread; m < 2 * n; m += group.threads()) {
      const double t = 100.0 * power_of_two(rounding_shift - 2 * (m % n));
      const R theta = m < n ? tilt_upwards(R(t), up) : -tilt_upwards(R(t), down);
      tilt[m] = theta;
      growth[m] = device::maximum(
          R(0.0), put.maturity * (cumulant_of(put, measure, theta) + mean * theta - put.rate));
    }
  });
  const R spot_above = device::maximum(put.log_spot, R(0.0)),
          spot_below = device::maximum(-put.log_spot, R(0.0));
  const auto least_ends = [=](int lane) {
    Kokkos::Array<R, 2> least = {R(1e30), R(1e30)};
    for (int pair = lane; pair < n * (n + 2); pair += group.lanes) {
      const int k = pair / (n + 1), m = n + pair % (n + 1);  // the last k and m denote the tilt 0
      const R tu = k < n ? tilt[k] : R(0.0), td = m < 2 * n ? -tilt[m] : R(0.0);
      const R grown =
          device::maximum(k < n ? growth[k] : R(0.0), m < 2 * n ? growth[m] : R(0.0)) + 0.6931471805599453;
      const R per = device::reciprocal(tu + td);
      least[0] = device::minimum(least[0], (base + grown + td * spot_below) * per);
      least[1] = device::minimum(least[1], (base + grown + tu * spot_above) * per);
    }
    return least;
  };
  const Kokkos::Array<R, 2> ends = minima(group, least_ends);
  return {ends[0], ends[1]};
}

/// Ends of the grid for a truncation error `error`, as a fraction of the strike. Truncation matters only for
/// paths that travel to the end and return to the strike. Chernoff bounds of both legs, with tilts tu, td >
/// 0, suggest the error
///   exp(-tu (above - x0) - td above) (|g(tu) - 1| + |g(-td) - 1|),   g(t) = exp(T (psi(t) - r)),
/// times e^{-r T} if r < 0, and likewise for the lower end. Each end is the minimum over 12 x 12 pairs of
/// tilts. The bounds themselves contain max(1, g); the 1 comes from paths that hardly move, and dominates for
/// short maturities. Subtracting it, with a remainder of at least 1e-3, makes the result an estimate and not
/// a bound. An early exercise boundary of a put with r > 0 lies above ln(t/(1+t)) for every t with psi(-t) <=
/// r (Lundberg's bound on the infimum; Mordecki 2002). Below it the value is known. `scratch` holds 3
/// `max_lanes` values.
template <class ThreadGroup, class R>
KOKKOS_INLINE_FUNCTION Domain<R> domain_of(const ThreadGroup& group, const PutPack<R>& put,
                                           const LevyMeasure<R>& measure, double error, R* scratch) {
  constexpr int n = tilt_count;
  R *tilt = scratch, *cumulant = scratch + max_lanes, *grown = scratch + 2 * max_lanes;
  const R up = decay_up(put), down = decay_down(put), maturity = put.maturity, rate = put.rate;
  const R variance = put.variance + measure.variance;
  const double depth = -device::portable::log(error);
  const R gaussian = device::square_root(2.0 * depth / (device::maximum(variance, R(1e-12)) * maturity));
  group.each([&, tilt, cumulant](int thread) {
    for (int m = thread; m <= 2 * n; m += group.threads()) {
      R theta = 1.0;
      if (m < 2 * n) {
        const int k = m % n;
        const R t =
            2.0 * gaussian * ((k % 2 == 0 ? 1.0 : 0.7071067811865476) * power_of_two(rounding_shift - k / 2));
        theta = m < n ? tilt_upwards(t, up) : -tilt_upwards(t, down);
      }
      tilt[m] = theta;
      cumulant[m] = cumulant_of(put, measure, theta);
    }
  });
  const R mean = put.rate - put.dividend - cumulant[2 * n];
  // Discount along the path; growth if r < 0.
  const R base = depth + device::maximum(R(0.0), -rate * maturity);
  const R spot_above = device::maximum(put.log_spot, R(0.0)),
          spot_below = device::maximum(-put.log_spot, R(0.0));
  group.each([&, tilt, cumulant, grown](int thread) {
    for (int m = thread; m < 2 * n; m += group.threads()) {
      const R g = exponential(maturity * (cumulant[m] + mean * tilt[m] - rate));
      grown[m] = device::maximum(g, 2.0 - g);
    }
  });
  const auto least_ends = [&, tilt, grown](int lane) {
    Kokkos::Array<R, 2> least = {R(1e30), R(1e30)};
    for (int pair = lane; pair < n * n; pair += group.lanes) {
      const int k = pair / n, m = n + pair % n;
      const R tu = tilt[k], td = -tilt[m], per = device::reciprocal(tu + td);
      const R grow = rough_logarithm(device::maximum(grown[k] + grown[m] - 2.0, R(1e-3)));
      const R need = base + device::select(grow < R(690.0), grow, R(1e30));  // `grown` is clamped there
      least[0] = device::minimum(least[0], (need + td * spot_below) * per);
      least[1] = device::minimum(least[1], (need + tu * spot_above) * per);
    }
    return least;
  };
  const Kokkos::Array<R, 2> ends = minima(group, least_ends);
  Domain<R> domain{ends[0], ends[1]};
  const R premium = premium_cutoff_distance(group, put, spot_below, base, tilt, grown);
  // psi is convex, so a chord lies above it. The root of the chord between the last tilt with psi <= r and
  // the next one is therefore a valid tilt.
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
  group.sync();
  // Beyond these variances finite differences are dominated by rounding or overflow.
  const auto representable = (measure.variance < R(1e11)) & (put.variance < R(1e100));
  const auto wide = representable & (domain.below + domain.above > R(20.0));
  if (!group.all(device::select(wide, R(1.0), R(0.0)) <= R(0.0))) {
    const Domain<R> other = wide_domain(group, put, measure, base, mean, tilt, grown);
    domain.below = device::select(wide, device::minimum(domain.below, other.below), domain.below);
    domain.above = device::select(wide, device::minimum(domain.above, other.above), domain.above);
    group.sync();
  }
  domain.below = device::minimum(device::maximum(domain.below, premium), limit);
  return domain;
}

}  // namespace drogue::options

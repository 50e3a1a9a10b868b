#pragma once

#include "kernels/device/portable_math.hpp"
#include "kernels/options/cos/bermudan.hpp"
#include "kernels/options/cos/fft.hpp"

namespace drogue::options {

namespace portable = device::portable;

/// Work arrays of one put with N = 2^log_terms cosines.
struct CosWorkspace {
  double* value;              ///< V_k, cosine coefficients of the value, shape (N)
  ComplexArray growth;        ///< e^(dt (psi - rate)) of the present interval, shape (N)
  ComplexArray continuation;  ///< w_j of the continuation value, or its transform, shape (2 N)
  ComplexArray reversed;      ///< w_j in reversed order, or its transform, shape (2 N)
  ComplexArray toeplitz;      ///< generator of the Toeplitz matrix, or its transform, shape (2 N)
  ComplexArray hankel;        ///< generator of the Hankel matrix, or its transform, shape (2 N)

  /// Number of doubles of the work arrays.
  KOKKOS_INLINE_FUNCTION static constexpr int size(int log_terms) { return 19 << log_terms; }

  KOKKOS_INLINE_FUNCTION CosWorkspace(double* memory, int log_terms) {
    const int n = 1 << log_terms;
    value = memory;
    growth = {memory + n, memory + 2 * n};
    continuation = {memory + 3 * n, memory + 5 * n};
    reversed = {memory + 7 * n, memory + 9 * n};
    toeplitz = {memory + 11 * n, memory + 13 * n};
    hankel = {memory + 15 * n, memory + 17 * n};
  }
};

/// Exercise region within [low, low + width], in angles 0 .. pi; empty unless `from` < `to`.
struct ExerciseRegion {
  double from;
  double to;
};

/// Cosine coefficient k of the payoff 1 - e^x over `region`: 2/width times the integral of
/// (1 - e^x) cos(u (x - low)) dx, u = pi k / width (Fang and Oosterlee 2008, eqs. (22) and (23)).
KOKKOS_INLINE_FUNCTION double payoff_coefficient(const BermudanPut& put, int k, ExerciseRegion region) {
  if (!(region.from < region.to)) return 0.0;
  const double u = portable::pi * k / put.width;
  const double sin_to = portable::sin(k * region.to), sin_from = portable::sin(k * region.from);
  const double cos_to = portable::cos(k * region.to), cos_from = portable::cos(k * region.from);
  const double scale = put.width / portable::pi;
  const double e_to = portable::exp(put.low + scale * region.to);
  const double e_from = portable::exp(put.low + scale * region.from);
  const double of_one = k == 0 ? scale * (region.to - region.from) : (sin_to - sin_from) / u;
  const double of_exp =
      (cos_to * e_to - cos_from * e_from + u * (sin_to * e_to - sin_from * e_from)) / (1.0 + u * u);
  return 2.0 / put.width * (of_one - of_exp);
}

/// Integral of e^(i n angle) over the angles outside `region`, n >= 0.
KOKKOS_INLINE_FUNCTION void continuation_integral(int n, ExerciseRegion region, double& re, double& im) {
  const bool is_empty = !(region.from < region.to);
  if (n == 0) {
    re = is_empty ? portable::pi : portable::pi - (region.to - region.from);
    im = 0.0;
    return;
  }
  // e^(i n pi) - 1, less the contribution of the region
  double difference_re = n % 2 == 0 ? 0.0 : -2.0;
  double difference_im = 0.0;
  if (!is_empty) {
    difference_re += portable::cos(n * region.from) - portable::cos(n * region.to);
    difference_im += portable::sin(n * region.from) - portable::sin(n * region.to);
  }
  re = difference_im / n;
  im = -difference_re / n;
}

/// Backward induction of one put by one team (Fang and Oosterlee 2009, section 2).
template <class Team>
class BackwardInduction {
 public:
  KOKKOS_INLINE_FUNCTION BackwardInduction(const Team& team, const BermudanPut& put, ConstComplexArray psi,
                                           ConstComplexArray roots, int log_roots, double* memory)
      : _team(team),
        _put(put),
        _psi(psi),
        _roots(roots),
        _log_roots(log_roots),
        _terms(1 << put.log_terms),
        _work(memory, put.log_terms) {}

  KOKKOS_INLINE_FUNCTION BermudanValue solve() const {
    const auto work = _work;
    const auto put = _put;
    // At maturity the exercise region is x <= 0.
    for_team(_team, _terms, [=](int k) {
      work.value[k] = payoff_coefficient(put, k, {0.0, -put.low * (portable::pi / put.width)});
    });
    for (int date = _put.dates - 1; date > 0; --date) step_back(date);
    load_growth(0);
    return value_at(-(_put.low - _put.x) * (portable::pi / _put.width), true);
  }

 private:
  /// Computes the growth factors of the interval from `date` to the next date.
  KOKKOS_INLINE_FUNCTION void load_growth(int date) const {
    const auto work = _work;
    const auto put = _put;
    const auto psi = _psi;
    const double dt =
        exercise_date(put.maturity, date + 1, put.dates) - exercise_date(put.maturity, date, put.dates);
    for_team(_team, _terms, [=](int k) {
      const double size = portable::exp(dt * (psi.re[k] - put.rate));
      work.growth.re[k] = size * portable::cos(dt * psi.im[k]);
      work.growth.im[k] = size * portable::sin(dt * psi.im[k]);
    });
  }

  /// Replaces the cosine coefficients at the date after `date` by those at `date`.
  KOKKOS_INLINE_FUNCTION void step_back(int date) const {
    load_growth(date);
    load_continuation();
    const ExerciseRegion region = exercise_region();
    load_matrices(region);
    multiply_transforms();
    const auto work = _work;
    const auto put = _put;
    const double scale = 1.0 / (portable::pi * (2 * _terms));
    for_team(_team, _terms, [=](int k) {
      work.value[k] = scale * work.continuation.re[k] + payoff_coefficient(put, k, region);
    });
  }

  /// Computes w_j = e^(dt (psi_j - rate)) V_j, with half the weight at j = 0, and its transform: the
  /// continuation value at the angles pi n / terms, in bit-reversed order.
  KOKKOS_INLINE_FUNCTION void load_continuation() const {
    const auto work = _work;
    const int terms = _terms;
    for_team(_team, terms, [=](int j) {
      const double weight = j == 0 ? 0.5 : 1.0;
      const double re = weight * work.growth.re[j] * work.value[j];
      const double im = weight * work.growth.im[j] * work.value[j];
      work.continuation.re[j] = re;
      work.continuation.im[j] = im;
      work.continuation.re[j + terms] = 0.0;
      work.continuation.im[j + terms] = 0.0;
      work.reversed.re[terms - 1 - j] = re;
      work.reversed.im[terms - 1 - j] = im;
      work.reversed.re[j + terms] = 0.0;
      work.reversed.im[j + terms] = 0.0;
    });
    fft_to_reversed(_team, work.continuation, _put.log_terms + 1, _roots, _log_roots);
  }

  KOKKOS_INLINE_FUNCTION static int bit_reversed(int n, int bits) {
    int result = 0;
    for (int bit = 0; bit < bits; ++bit) result |= ((n >> bit) & 1) << (bits - 1 - bit);
    return result;
  }

  /// Payoff minus continuation value at a node.
  KOKKOS_INLINE_FUNCTION double gain_at_node(int n) const {
    const double x = _put.low + _put.width / _terms * n;
    return 1.0 - portable::exp(x) - _work.continuation.re[bit_reversed(n, _put.log_terms + 1)];
  }

  /// Exercise region: from the outermost nodes with a positive gain to the adjacent roots of the gain.
  KOKKOS_INLINE_FUNCTION ExerciseRegion exercise_region() const {
    int first = 0, last = 0;
    Kokkos::parallel_reduce(
        Kokkos::TeamThreadRange(_team, _terms),
        [&](int n, int& lowest) {
          if (n < lowest && gain_at_node(n) > 0.0) lowest = n;
        },
        Kokkos::Min<int>(first));
    Kokkos::parallel_reduce(
        Kokkos::TeamThreadRange(_team, _terms),
        [&](int n, int& highest) {
          if (n > highest && gain_at_node(n) > 0.0) highest = n;
        },
        Kokkos::Max<int>(last));
    _team.team_barrier();
    if (first > last) return {0.0, 0.0};
    // `value_at` overwrites the arrays of the matrices, which are loaded later.
    return {first == 0 ? 0.0 : root_between(first, first - 1), root_between(last, last + 1)};
  }

  /// Root of the gain between the nodes `inside` and `outside` of the exercise region: Newton's method from
  /// the secant's root, with bisection if a step leaves the interval.
  KOKKOS_INLINE_FUNCTION double root_between(int inside, int outside) const {
    const double spacing = portable::pi / _terms;
    double in = spacing * inside, out = spacing * outside;
    const double gain_in = gain_at_node(inside), gain_out = gain_at_node(outside);
    _team.team_barrier();
    double angle = gain_in > gain_out ? in + (out - in) * (gain_in / (gain_in - gain_out)) : 0.5 * (in + out);
    for (int iteration = 0; iteration < 4; ++iteration) {
      const BermudanValue continuation = value_at(angle, false);
      const double e = portable::exp(_put.low + _put.width / portable::pi * angle);
      const double gain = 1.0 - e - continuation.value;
      (gain > 0.0 ? in : out) = angle;
      const double slope = (-e - continuation.first_derivative) * (_put.width / portable::pi);
      const double next = angle - gain / slope;
      const bool between = (next - in) * (next - out) <= 0.0;
      angle = between ? next : 0.5 * (in + out);
    }
    return angle;
  }

  /// Arranges E(n) = `continuation_integral(n)` as circulant generators of the matrices E(j - k) (Toeplitz)
  /// and E(j + k) (Hankel).
  KOKKOS_INLINE_FUNCTION void load_matrices(ExerciseRegion region) const {
    const auto work = _work;
    const int terms = _terms;
    for_team(_team, 2 * terms, [=](int n) {
      double re = 0.0, im = 0.0;
      if (n < 2 * terms - 1) continuation_integral(n, region, re, im);
      if (n < terms) {
        work.toeplitz.re[n] = re;
        work.toeplitz.im[n] = -im;
        if (n > 0) {
          work.toeplitz.re[2 * terms - n] = re;
          work.toeplitz.im[2 * terms - n] = im;
        }
        // n = terms - 1 - m of index -m, the largest m for n = 0
        if (n < terms - 1) {
          work.hankel.re[terms + 1 + n] = re;
          work.hankel.im[terms + 1 + n] = im;
        }
      } else if (n == 2 * terms - 1) {
        work.toeplitz.re[terms] = work.toeplitz.im[terms] = 0.0;
        work.hankel.re[terms] = work.hankel.im[terms] = 0.0;
      }
      if (n >= terms - 1 && n < 2 * terms - 1) {
        work.hankel.re[n - terms + 1] = re;
        work.hankel.im[n - terms + 1] = im;
      }
    });
  }

  /// continuation = Toeplitz matrix * continuation + Hankel matrix * continuation, up to a factor, by
  /// transforms.
  KOKKOS_INLINE_FUNCTION void multiply_transforms() const {
    const auto work = _work;
    const int log_size = _put.log_terms + 1;
    fft_to_reversed(_team, work.reversed, log_size, _roots, _log_roots);
    fft_to_reversed(_team, work.toeplitz, log_size, _roots, _log_roots);
    fft_to_reversed(_team, work.hankel, log_size, _roots, _log_roots);
    for_team(_team, 2 * _terms, [=](int n) {
      const double re =
          work.continuation.re[n] * work.toeplitz.re[n] - work.continuation.im[n] * work.toeplitz.im[n];
      const double im =
          work.continuation.re[n] * work.toeplitz.im[n] + work.continuation.im[n] * work.toeplitz.re[n];
      work.continuation.re[n] =
          re + (work.reversed.re[n] * work.hankel.re[n] - work.reversed.im[n] * work.hankel.im[n]);
      work.continuation.im[n] =
          im + (work.reversed.re[n] * work.hankel.im[n] + work.reversed.im[n] * work.hankel.re[n]);
    });
    fft_from_reversed(_team, work.continuation, log_size, _roots, _log_roots);
  }

  /// Continuation value and its first derivative at an angle; the other derivatives too if
  /// `all_derivatives`. Overwrites the arrays of the matrices.
  KOKKOS_INLINE_FUNCTION BermudanValue value_at(double angle, bool all_derivatives) const {
    const auto work = _work;
    const auto put = _put;
    const auto psi = _psi;
    for_team(_team, _terms, [=](int j) {
      const double weight = j == 0 ? 0.5 : 1.0;
      const double cosine = portable::cos(j * angle), sine = portable::sin(j * angle);
      const double w = weight * work.value[j];
      const double re = w * (work.growth.re[j] * cosine - work.growth.im[j] * sine);
      const double im = w * (work.growth.re[j] * sine + work.growth.im[j] * cosine);
      const double u = portable::pi * j / put.width;
      work.toeplitz.re[j] = re;
      work.toeplitz.im[j] = -u * im;
      if (!all_derivatives) return;
      work.hankel.re[j] = -u * u * re;
      work.hankel.im[j] = (put.rate - psi.re[j]) * re + psi.im[j] * im;
    });
    BermudanValue value;
    value.value = sum_pairwise(_team, work.toeplitz.re, put.log_terms);
    value.first_derivative = sum_pairwise(_team, work.toeplitz.im, put.log_terms);
    if (!all_derivatives) return value;
    value.second_derivative = sum_pairwise(_team, work.hankel.re, put.log_terms);
    value.theta = sum_pairwise(_team, work.hankel.im, put.log_terms);
    return value;
  }

  const Team& _team;
  BermudanPut _put;
  ConstComplexArray _psi;
  ConstComplexArray _roots;
  int _log_roots;
  int _terms;
  CosWorkspace _work;
};

}  // namespace drogue::options

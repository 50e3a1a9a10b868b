#pragma once

#include "kernels/device/portable_math.hpp"
#include "kernels/options/cos/bermudan.hpp"
#include "kernels/options/cos/fft.hpp"

namespace drogue::options {

namespace portable = device::portable;

/// Memory that one put works in: arrays of 2 terms, but `value` of terms.
struct CosWorkspace {
  double* value;        ///< V_k, cosine coefficients of the put's value
  ComplexArray growth;  ///< e^(dt (psi - rate)), of terms
  ComplexArray wait;    ///< w_j, coefficients of the value of waiting; its transform
  ComplexArray mirrored;
  ComplexArray toeplitz;
  ComplexArray hankel;

  /// Doubles that a put of 2^log_terms cosines needs.
  KOKKOS_INLINE_FUNCTION static constexpr int size(int log_terms) { return 19 << log_terms; }

  KOKKOS_INLINE_FUNCTION CosWorkspace(double* memory, int log_terms) {
    const int n = 1 << log_terms;
    value = memory;
    growth = {memory + n, memory + 2 * n};
    wait = {memory + 3 * n, memory + 5 * n};
    mirrored = {memory + 7 * n, memory + 9 * n};
    toeplitz = {memory + 11 * n, memory + 13 * n};
    hankel = {memory + 15 * n, memory + 17 * n};
  }
};

/// A part of [low, low + width] in angles 0 .. pi; empty where `from` is not below `to`.
struct Exercise {
  double from;
  double to;
};

/// Cosine coefficient of 1 - e^x over `part`: 2/width integral (1 - e^x) cos(u (x - low)) dx (Fang and
/// Oosterlee 2008, eq. 22, 23).
KOKKOS_INLINE_FUNCTION double payoff_coefficient(const BermudanPut& put, int k, Exercise part) {
  if (!(part.from < part.to)) return 0.0;
  const double u = portable::pi * k / put.width;
  const double sin_to = portable::sin(k * part.to), sin_from = portable::sin(k * part.from);
  const double cos_to = portable::cos(k * part.to), cos_from = portable::cos(k * part.from);
  const double scale = put.width / portable::pi;
  const double e_to = portable::exp(put.low + scale * part.to);
  const double e_from = portable::exp(put.low + scale * part.from);
  const double of_one = k == 0 ? scale * (part.to - part.from) : (sin_to - sin_from) / u;
  const double of_exp =
      (cos_to * e_to - cos_from * e_from + u * (sin_to * e_to - sin_from * e_from)) / (1.0 + u * u);
  return 2.0 / put.width * (of_one - of_exp);
}

/// integral of e^(i n angle) over the angles outside `part`, n >= 0.
KOKKOS_INLINE_FUNCTION void waiting_integral(int n, Exercise part, double& re, double& im) {
  const bool whole = !(part.from < part.to);
  if (n == 0) {
    re = whole ? portable::pi : portable::pi - (part.to - part.from);
    im = 0.0;
    return;
  }
  // e^(i n pi) - 1, and what the part takes away
  double difference_re = n % 2 == 0 ? 0.0 : -2.0;
  double difference_im = 0.0;
  if (!whole) {
    difference_re += portable::cos(n * part.from) - portable::cos(n * part.to);
    difference_im += portable::sin(n * part.from) - portable::sin(n * part.to);
  }
  re = difference_im / n;
  im = -difference_re / n;
}

/// What one team does for one put.
template <class Team>
class CosBackward {
 public:
  KOKKOS_INLINE_FUNCTION CosBackward(const Team& team, const BermudanPut& put, ConstComplexArray psi,
                                     ConstComplexArray roots, int log_roots, double* memory)
      : _team(team),
        _put(put),
        _psi(psi),
        _roots(roots),
        _log_roots(log_roots),
        _terms(1 << put.log_terms),
        _work(memory, put.log_terms) {}

  KOKKOS_INLINE_FUNCTION BermudanValue solve() const {
    const double dt = _put.maturity / _put.dates;
    const auto work = _work;
    const auto put = _put;
    const auto psi = _psi;
    for_team(_team, _terms, [=](int k) {
      const double size = portable::exp(dt * (psi.re[k] - put.rate));
      work.growth.re[k] = size * portable::cos(dt * psi.im[k]);
      work.growth.im[k] = size * portable::sin(dt * psi.im[k]);
      // in the money at maturity: up to x = 0
      work.value[k] = payoff_coefficient(put, k, {0.0, -put.low * (portable::pi / put.width)});
    });
    for (int date = _put.dates - 1; date > 0; --date) step_back();
    return value_at(-(_put.low - _put.x) * (portable::pi / _put.width), true);
  }

 private:
  /// From the value just before a date's decision to that before the date before.
  KOKKOS_INLINE_FUNCTION void step_back() const {
    load_waiting();
    const Exercise part = exercise_part();
    load_kernels(part);
    multiply_transforms();
    const auto work = _work;
    const auto put = _put;
    const double scale = 1.0 / (portable::pi * (2 * _terms));
    for_team(_team, _terms,
             [=](int k) { work.value[k] = scale * work.wait.re[k] + payoff_coefficient(put, k, part); });
  }

  /// w_j = e^(dt (psi_j - rate)) V_j, half of it at j = 0, and its transform: the value of waiting at the
  /// angles pi n / terms, in bit-reversed order.
  KOKKOS_INLINE_FUNCTION void load_waiting() const {
    const auto work = _work;
    const int terms = _terms;
    for_team(_team, terms, [=](int j) {
      const double weight = j == 0 ? 0.5 : 1.0;
      const double re = weight * work.growth.re[j] * work.value[j];
      const double im = weight * work.growth.im[j] * work.value[j];
      work.wait.re[j] = re;
      work.wait.im[j] = im;
      work.wait.re[j + terms] = 0.0;
      work.wait.im[j + terms] = 0.0;
      work.mirrored.re[terms - 1 - j] = re;
      work.mirrored.im[terms - 1 - j] = im;
      work.mirrored.re[j + terms] = 0.0;
      work.mirrored.im[j + terms] = 0.0;
    });
    fft_to_reversed(_team, work.wait, _put.log_terms + 1, _roots, _log_roots);
  }

  KOKKOS_INLINE_FUNCTION static int reversed(int n, int bits) {
    int result = 0;
    for (int bit = 0; bit < bits; ++bit) result |= ((n >> bit) & 1) << (bits - 1 - bit);
    return result;
  }

  /// What exercise gives more than waiting, where both are known.
  KOKKOS_INLINE_FUNCTION double gain_at_node(int n) const {
    const double x = _put.low + _put.width / _terms * n;
    return 1.0 - portable::exp(x) - _work.wait.re[reversed(n, _put.log_terms + 1)];
  }

  /// Where exercise is right: between the outermost nodes at which it is, and on to where both are equal.
  KOKKOS_INLINE_FUNCTION Exercise exercise_part() const {
    int first = 0, last = 0;
    Kokkos::parallel_reduce(
        Kokkos::TeamThreadRange(_team, _terms),
        [&](int n, int& least) {
          if (n < least && gain_at_node(n) > 0.0) least = n;
        },
        Kokkos::Min<int>(first));
    Kokkos::parallel_reduce(
        Kokkos::TeamThreadRange(_team, _terms),
        [&](int n, int& most) {
          if (n > most && gain_at_node(n) > 0.0) most = n;
        },
        Kokkos::Max<int>(last));
    _team.team_barrier();
    if (first > last) return {0.0, 0.0};
    // The kernels are not loaded yet: their memory serves the sums.
    return {first == 0 ? 0.0 : root_between(first, first - 1), root_between(last, last + 1)};
  }

  /// The angle at which exercise and waiting are equal, between the nodes `inside` and `outside`: Newton's
  /// steps from where the secant points, bisection where they leave the interval.
  KOKKOS_INLINE_FUNCTION double root_between(int inside, int outside) const {
    const double spacing = portable::pi / _terms;
    double in = spacing * inside, out = spacing * outside;
    const double gain_in = gain_at_node(inside), gain_out = gain_at_node(outside);
    _team.team_barrier();
    double angle = gain_in > gain_out ? in + (out - in) * (gain_in / (gain_in - gain_out)) : 0.5 * (in + out);
    for (int iteration = 0; iteration < 4; ++iteration) {
      const BermudanValue wait = value_at(angle, false);
      const double e = portable::exp(_put.low + _put.width / portable::pi * angle);
      const double gain = 1.0 - e - wait.value;
      (gain > 0.0 ? in : out) = angle;
      const double slope = (-e - wait.slope) * (_put.width / portable::pi);
      const double next = angle - gain / slope;
      const bool between = (next - in) * (next - out) <= 0.0;
      angle = between ? next : 0.5 * (in + out);
    }
    return angle;
  }

  /// The transforms of E(n) = integral over where one waits, arranged for w_j E(j - k) and w_j E(j + k).
  KOKKOS_INLINE_FUNCTION void load_kernels(Exercise part) const {
    const auto work = _work;
    const int terms = _terms;
    for_team(_team, 2 * terms, [=](int n) {
      double re = 0.0, im = 0.0;
      if (n < 2 * terms - 1) waiting_integral(n, part, re, im);
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

  /// wait = conv(wait, toeplitz) + conv(mirrored, hankel), but for a factor.
  KOKKOS_INLINE_FUNCTION void multiply_transforms() const {
    const auto work = _work;
    const int log_size = _put.log_terms + 1;
    fft_to_reversed(_team, work.mirrored, log_size, _roots, _log_roots);
    fft_to_reversed(_team, work.toeplitz, log_size, _roots, _log_roots);
    fft_to_reversed(_team, work.hankel, log_size, _roots, _log_roots);
    for_team(_team, 2 * _terms, [=](int n) {
      const double re = work.wait.re[n] * work.toeplitz.re[n] - work.wait.im[n] * work.toeplitz.im[n];
      const double im = work.wait.re[n] * work.toeplitz.im[n] + work.wait.im[n] * work.toeplitz.re[n];
      work.wait.re[n] =
          re + (work.mirrored.re[n] * work.hankel.re[n] - work.mirrored.im[n] * work.hankel.im[n]);
      work.wait.im[n] =
          im + (work.mirrored.re[n] * work.hankel.im[n] + work.mirrored.im[n] * work.hankel.re[n]);
    });
    fft_from_reversed(_team, work.wait, log_size, _roots, _log_roots);
  }

  /// The value of waiting at an angle, from V: sums over the cosines, in the memory of the kernels.
  KOKKOS_INLINE_FUNCTION BermudanValue value_at(double angle, bool all) const {
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
      if (!all) return;
      work.hankel.re[j] = -u * u * re;
      work.hankel.im[j] = (put.rate - psi.re[j]) * re + psi.im[j] * im;
    });
    BermudanValue value;
    value.value = sum_pairwise(_team, work.toeplitz.re, put.log_terms);
    value.slope = sum_pairwise(_team, work.toeplitz.im, put.log_terms);
    if (!all) return value;
    value.curvature = sum_pairwise(_team, work.hankel.re, put.log_terms);
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

#pragma once

#include <Kokkos_Core.hpp>

namespace drogue::options {

/// Real and imaginary parts of a complex sequence, in separate arrays.
struct ComplexArray {
  double* re;
  double* im;
};

/// As `ComplexArray`, read-only.
struct ConstComplexArray {
  const double* re;
  const double* im;
};

/// Calls `body(i)` for i in [0, count) on the threads of a team, followed by a barrier.
template <class Team, class Body>
KOKKOS_INLINE_FUNCTION void for_team(const Team& team, int count, const Body& body) {
  Kokkos::parallel_for(Kokkos::TeamThreadRange(team, count), body);
  team.team_barrier();
}

/// Indices of the two elements of a butterfly, 2^log_distance apart, and of its root of unity.
struct Butterfly {
  int first, second, root;
};
/// Butterfly k of a pass.
KOKKOS_INLINE_FUNCTION Butterfly butterfly(int k, int log_distance, int log_roots) {
  const int distance = 1 << log_distance, j = k & (distance - 1),
            first = ((k >> log_distance) << (log_distance + 1)) + j;
  return {first, first + distance, j << (log_roots - 1 - log_distance)};
}

/// In-place transform x_n = sum_j x_j e^(2 pi i j n / 2^log_size), with the result in bit-reversed order
/// (decimation in frequency, Gentleman and Sande 1966). `roots` holds e^(2 pi i k / 2^log_roots).
template <class Team>
KOKKOS_INLINE_FUNCTION void fft_to_reversed(const Team& team, ComplexArray x, int log_size,
                                            ConstComplexArray roots, int log_roots) {
  for (int log_distance = log_size - 1; log_distance >= 0; --log_distance) {
    for_team(team, 1 << (log_size - 1), [=](int k) {
      const auto [first, second, root] = butterfly(k, log_distance, log_roots);
      const double re = x.re[first] - x.re[second];
      const double im = x.im[first] - x.im[second];
      x.re[first] += x.re[second];
      x.im[first] += x.im[second];
      x.re[second] = re * roots.re[root] - im * roots.im[root];
      x.im[second] = re * roots.im[root] + im * roots.re[root];
    });
  }
}

/// Inverse of `fft_to_reversed`, without the factor 1 / 2^log_size.
template <class Team>
KOKKOS_INLINE_FUNCTION void fft_from_reversed(const Team& team, ComplexArray x, int log_size,
                                              ConstComplexArray roots, int log_roots) {
  for (int log_distance = 0; log_distance < log_size; ++log_distance) {
    for_team(team, 1 << (log_size - 1), [=](int k) {
      const auto [first, second, root] = butterfly(k, log_distance, log_roots);
      const double re = x.re[second] * roots.re[root] + x.im[second] * roots.im[root];
      const double im = x.im[second] * roots.re[root] - x.re[second] * roots.im[root];
      x.re[second] = x.re[first] - re;
      x.im[second] = x.im[first] - im;
      x.re[first] += re;
      x.im[first] += im;
    });
  }
}

/// Sum of 2^log_size values in an order that does not depend on the team size. Overwrites `values`.
template <class Team>
KOKKOS_INLINE_FUNCTION double sum_pairwise(const Team& team, double* values, int log_size) {
  for (int log_distance = log_size - 1; log_distance >= 0; --log_distance) {
    const int distance = 1 << log_distance;
    for_team(team, distance, [=](int k) { values[k] += values[k + distance]; });
  }
  const double sum = values[0];
  team.team_barrier();  // all threads have read the sum before `values` is reused
  return sum;
}

}  // namespace drogue::options

#pragma once

#include <Kokkos_Core.hpp>

namespace drogue::options {

/// Real and imaginary parts of a sequence in the memory of a kernel.
struct ComplexArray {
  double* re;
  double* im;
};

struct ConstComplexArray {
  const double* re;
  const double* im;
};

/// Calls `body(i)` for i in [0, count) by the threads of a team, which meet afterwards.
template <class Team, class Body>
KOKKOS_INLINE_FUNCTION void for_team(const Team& team, int count, const Body& body) {
  Kokkos::parallel_for(Kokkos::TeamThreadRange(team, count), body);
  team.team_barrier();
}

/// The two numbers that butterfly k of a pass joins, 2^log_distance apart, and their root.
struct Butterfly {
  int first, second, root;
};
KOKKOS_INLINE_FUNCTION Butterfly butterfly(int k, int log_distance, int log_roots) {
  const int distance = 1 << log_distance, j = k & (distance - 1),
            first = ((k >> log_distance) << (log_distance + 1)) + j;
  return {first, first + distance, j << (log_roots - 1 - log_distance)};
}

/// x_n = sum_j x_j e^(2 pi i j n / 2^log_size), in place, the result in bit-reversed order (decimation in
/// frequency, Gentleman and Sande 1966). `roots` are the e^(2 pi i k / 2^log_roots).
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

/// The inverse of `fft_to_reversed` but for the factor 1 / 2^log_size.
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

/// The sum of 2^log_size values, spoiling them, in an order that does not depend on the team.
template <class Team>
KOKKOS_INLINE_FUNCTION double sum_pairwise(const Team& team, double* values, int log_size) {
  for (int log_distance = log_size - 1; log_distance >= 0; --log_distance) {
    const int distance = 1 << log_distance;
    for_team(team, distance, [=](int k) { values[k] += values[k + distance]; });
  }
  const double sum = values[0];
  team.team_barrier();  // the next use of `values` must not come before the slowest thread has read
  return sum;
}

}  // namespace drogue::options

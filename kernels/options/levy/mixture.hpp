#pragma once

#include "kernels/options/levy/elementary.hpp"
#include "kernels/options/levy/hankel_table.hpp"
#include "kernels/options/normalized_put.hpp"

namespace drogue::options {

/// A generalized hyperbolic Levy density as a mixture of exponentials,
///   |x| e^{-beta x} g(x) = sum_q c_q e^{-s_q |x|},
/// the sum over the nodes of HankelGrid that replaces the integral over the phase of the Hankel function of
/// order |lambda| (Prause 1999, with the Wronskian): s = sqrt((z/delta)^2 + alpha^2), c = step/pi m(z). What
/// lies below z = `lowest_of`, and the part max(lambda, 0) e^{-alpha|x|}, are the one term s = alpha.
struct Mixture {
  static constexpr int size = 64;
  static constexpr int low = 32;  ///< terms after which s exceeds 450 alpha, or is far beyond all that decays
                                  ///< slowly

  /// s - alpha is below 2e-6 alpha there, and where a tail, or its mean of e^x, decays slower than a tenth of
  /// alpha, below 2e-5 of that decay; as far as terms reach. Orders from 1.5 on have less than 1e-8 of their
  /// weight below the former, and what lies closer to alpha is of no account.
  [[nodiscard]] KOKKOS_INLINE_FUNCTION static double lowest_of(double order, double alpha, double beta,
                                                               double delta) {
    const double usual = delta * (2e-3 * alpha);
    const double tilt = device::maximum(device::portable::magnitude(beta), beta + 1.0);
    const double left = 10.0 * (1.0 - tilt / alpha);
    return order < 1.5 && left < 1.0 ? usual * Kokkos::sqrt(device::maximum(1e-7, left)) : usual;
  }
};

/// A Chebyshev series at t in [-1, 1], by Clenshaw's recurrence.
KOKKOS_INLINE_FUNCTION double chebyshev(const double* series, double t) {
  double next = 0.0, value = 0.0;
  for (int k = HankelGrid::terms - 1; k >= 1; --k) {
    const double before = 2.0 * t * value - next + series[k];
    next = value;
    value = before;
  }
  return t * value - next + series[0];
}

/// One term of a mixture.
struct Term {
  double rate;    ///< s, 1
  double weight;  ///< c, 1/year
};

/// Where the terms of a generalized hyperbolic put lie on the grid.
struct MixtureGrid {
  const double* panel;  ///< its panel of orders
  double t;             ///< its order's place in the panel
  int first;            ///< node of the panel that term 1 belongs to
};

KOKKOS_INLINE_FUNCTION MixtureGrid mixture_grid(const NormalizedPut& put, const double* panels,
                                                const int* slot) {
  const double order = device::portable::magnitude(put.jump[0]);
  if (put.jump[3] == 0.0 || !(order < HankelGrid::largest_order)) return {nullptr, 0.0, 0};
  const int panel = panel_of(order);
  const double begin = panel_begin(panel), end = panel_end(panel);
  const double* const table = panels + slot[panel] * std::size_t(HankelGrid::panel_size);
  const double z = Mixture::lowest_of(order, put.jump[1], put.jump[2], put.jump[3]);
  int first = 0;
  if (z > 4e-18) {
    // Where nodes lie even this is the one; where some lie closer the one is before it.
    const double log_z = device::portable::log(z);
    first = static_cast<int>(Kokkos::ceil(log_z * (1.0 / HankelGrid::step))) - HankelGrid::first -
            static_cast<int>(table[HankelGrid::shift]);
    if (first < 0) first = 0;
    if (table[HankelGrid::shift] != 0.0)
      while (first > 0 && first <= HankelGrid::count && table[HankelGrid::log_z + first - 1] >= log_z)
        --first;
  }
  return {table, (2.0 * order - begin - end) / (end - begin), first};
}

/// Term q of the mixture of `put`, a generalized hyperbolic one; not a number beyond the largest order.
KOKKOS_INLINE_FUNCTION Term mixture_term(const NormalizedPut& put, const MixtureGrid& grid, int q) {
  const double lambda = put.jump[0], alpha = put.jump[1], delta = put.jump[3];
  if (delta == 0.0) return {alpha, q == 0 ? lambda : 0.0};
  if (grid.panel == nullptr) return {alpha, device::portable::not_a_number()};
  const int node = grid.first + q - 1;  // of term 0 the last one that is lumped
  const double positive = lambda > 0.0 ? lambda : 0.0;
  if (q == 0) {
    const int beyond = node + 1 < HankelGrid::count ? node + 1 : HankelGrid::count - 1;
    const double* below = grid.panel + HankelGrid::log_below + beyond * HankelGrid::terms;
    return {alpha, positive + exponential(chebyshev(below, grid.t))};
  }
  double z = 0.0, density = 0.0;
  if (node < HankelGrid::count) {
    z = exponential(grid.panel[HankelGrid::log_z + node]);
    density = exponential(chebyshev(grid.panel + HankelGrid::log_m + node * HankelGrid::terms, grid.t));
  } else {
    const double mu = 4.0 * lambda * lambda;
    z = exponential((node + HankelGrid::first + static_cast<int>(grid.panel[HankelGrid::shift])) *
                    HankelGrid::step);
    density = z / (1.0 + (mu - 1.0) / (8.0 * z * z));
  }
  const double w = z / delta;
  return {Kokkos::sqrt(w * w + alpha * alpha), HankelGrid::step / device::portable::pi * density};
}

}  // namespace drogue::options

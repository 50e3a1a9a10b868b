#pragma once

#include "kernels/options/levy/elementary.hpp"
#include "kernels/options/levy/hankel_table.hpp"
#include "kernels/options/normalized_put.hpp"

namespace drogue::options {

/// Generalized hyperbolic Levy density as a mixture of exponentials,
///   |x| e^{-beta x} g(x) = sum_q c_q e^{-s_q |x|}.
/// The sum over the nodes of HankelGrid approximates the integral of [Shi], section 4.6.1 (Prause 1999, eq.
/// (2.34)), over the phase of the Hankel function of order |lambda|: s = sqrt((z/delta)^2 + alpha^2),
/// c = step/pi m(z). One term, s = alpha, holds the nodes below z = `lowest_node` and the summand
/// max(lambda, 0) e^{-alpha|x|}.
struct Mixture {
  static constexpr int size = 64;  ///< number of terms
  static constexpr int low = 32;   ///< index from which s exceeds 450 alpha or all slow decay rates by far

  /// Lower bound of z for nodes with terms of their own. There s - alpha is below 2e-6 alpha. If a tail, or
  /// the tail of e^x g, decays slower than alpha/10, it is below 2e-5 of that decay rate, as far as the
  /// number of terms allows. Orders from 1.5 on have less than 1e-8 of their weight below the first bound.
  [[nodiscard]] KOKKOS_INLINE_FUNCTION static double lowest_node(double order, double alpha, double beta,
                                                                 double delta) {
    const double usual = delta * (2e-3 * alpha);
    const double tilt = device::maximum(device::portable::magnitude(beta), beta + 1.0);
    const double left = 10.0 * (1.0 - tilt / alpha);
    return order < 1.5 && left < 1.0 ? usual * Kokkos::sqrt(device::maximum(1e-7, left)) : usual;
  }
};

/// Value of a Chebyshev series at t in [-1, 1], by Clenshaw's recurrence.
KOKKOS_INLINE_FUNCTION double chebyshev(const double* series, double t) {
  double next = 0.0, value = 0.0;
  for (int k = HankelGrid::terms - 1; k >= 1; --k) {
    const double before = 2.0 * t * value - next + series[k];
    next = value;
    value = before;
  }
  return t * value - next + series[0];
}

/// Term of a mixture.
struct MixtureTerm {
  double rate;    ///< s, dimensionless
  double weight;  ///< c, 1/year
};

/// Nodes of the mixture of a generalized hyperbolic put.
struct MixtureGrid {
  const double* panel;  ///< table of the panel of its order; null if terms need no table
  double t;             ///< its order, mapped from the panel to [-1, 1]
  int first;            ///< node of term 1
};

/// Nodes of the mixture of `put`. `panels` and `slot` are those of `HankelPanels`.
KOKKOS_INLINE_FUNCTION MixtureGrid mixture_grid(const NormalizedPut& put, const double* panels,
                                                const int* slot) {
  const double order = device::portable::magnitude(put.jump[0]);
  if (put.jump[3] == 0.0 || !(order < HankelGrid::largest_order)) return {nullptr, 0.0, 0};
  const int panel = panel_of(order);
  const double begin = panel_begin(panel), end = panel_end(panel);
  const double* const table = panels + slot[panel] * std::size_t(HankelGrid::panel_size);
  const double z = Mixture::lowest_node(order, put.jump[1], put.jump[2], put.jump[3]);
  int first = 0;
  if (z > 4e-18) {
    // Exact for equidistant nodes; for dense nodes the first one lies below.
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

/// Term q of the mixture of a generalized hyperbolic put; the weight is NaN beyond the largest order.
KOKKOS_INLINE_FUNCTION MixtureTerm mixture_term(const NormalizedPut& put, const MixtureGrid& grid, int q) {
  const double lambda = put.jump[0], alpha = put.jump[1], delta = put.jump[3];
  if (delta == 0.0) return {alpha, q == 0 ? lambda : 0.0};
  if (grid.panel == nullptr) return {alpha, device::portable::not_a_number()};
  const int node = grid.first + q - 1;  // for term 0, the last node below
  const double positive = lambda > 0.0 ? lambda : 0.0;
  if (q == 0) {
    const int next_node = node + 1 < HankelGrid::count ? node + 1 : HankelGrid::count - 1;
    const double* below = grid.panel + HankelGrid::log_below + next_node * HankelGrid::terms;
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

#pragma once

#include <Kokkos_Core.hpp>
#include <cmath>
#include <vector>

namespace drogue::options {

/// Layout of the table of a panel of orders, doubles.
///
/// The table holds the spectral density m(z) = 2 / (pi (J^2 + Y^2)) of the generalized hyperbolic Levy
/// measure
/// ([Shi], section 4.6.1), J and Y of order |lambda|, at the nodes of a trapezoidal rule in ln z, and the sum
/// of the rule's weights below each node. Both are logarithms, expanded in Chebyshev series in the order.
///
/// For orders below 2 the nodes are z = e^(k step). The density is analytic in ln z only up to the zero of
/// the Hankel function closest to the order. For larger orders the nodes are denser there
/// (`hankel_table.cpp`), and `log_m` includes the ratio of the spacings. From node `count` on they are z =
/// e^(k step) again.
struct HankelGrid {
  static constexpr double step = 0.4;
  static constexpr int first = -100;  ///< exponent k of node 0: z = 4e-18
  static constexpr int count = 131;   ///< nodes, to z = 1.6e5 or more; beyond, Hankel's expansion holds
  static constexpr int terms = 14;    ///< Chebyshev coefficients per node
  static constexpr int log_m = 0;     ///< offset of ln m, shape (count, terms)
  static constexpr int log_below =
      count * terms;  ///< offset of ln of the weights below, shape (count, terms)
  static constexpr int log_z = 2 * count * terms;  ///< offset of ln z, shape (count)
  static constexpr int shift = log_z + count;      ///< offset of an integer: node k >= count is
                                                   ///< e^((k + first + shift) step)
  static constexpr int panel_size = shift + 1;
  static constexpr double largest_order = 128.0;
  static constexpr int panels = 6 + 127;  ///< number of panels below the largest order
};

/// Panel of an order. Panels end at 1/16, 1/8, 1/4, 1/2, 1, 2, 3, ..., since the density at small z varies
/// fast for small orders. Branch-free, because the orders of a batch make branches unpredictable.
KOKKOS_INLINE_FUNCTION int panel_of(double order) {
  return int(order >= 0.0625) + int(order >= 0.125) + int(order >= 0.25) + int(order >= 0.5) +
         static_cast<int>(order);
}
/// Lowest order of a panel.
KOKKOS_INLINE_FUNCTION double panel_begin(int panel) {
  if (panel >= 5) return panel - 4.0;
  double begin = 0.0;
  for (int k = 1; k <= panel; ++k) begin = k == 1 ? 0.0625 : 2.0 * begin;
  return begin;
}
/// End of the orders of a panel, exclusive.
KOKKOS_INLINE_FUNCTION double panel_end(int panel) { return panel_begin(panel + 1); }

/// Table of a panel in the layout of `HankelGrid`. Takes some milliseconds.
[[nodiscard]] std::vector<double> hankel_panel(int panel);

}  // namespace drogue::options

#pragma once

#include <Kokkos_Core.hpp>
#include <cmath>
#include <vector>

namespace drogue::options {

/// The spectral density m(z) = 2 / (pi (J^2 + Y^2)) of the generalized hyperbolic Levy measure, J and Y of
/// order |lambda|, at the nodes of a rule of trapezoids that all contracts of a panel of orders share, and
/// the sum of its weights below a node. Both are logarithms, and Chebyshev series in the order.
///
/// Below the order 2 the nodes are z = e^(k step). The density is regular in ln z only as far as the zero of
/// the Hankel function next to the order, so for larger ones nodes lie closer there (`hankel_table.cpp`), and
/// `log_m` includes what they lie closer. From the node `count` on they are z = e^(k step) again.
struct HankelGrid {
  static constexpr double step = 0.4;
  static constexpr int first = -100;  ///< z = 4e-18
  static constexpr int count = 131;   ///< to z = 1.6e5 or more, beyond which Hankel's expansion holds
  static constexpr int terms = 14;
  static constexpr int log_m = 0;                  ///< (count, terms)
  static constexpr int log_below = count * terms;  ///< (count, terms)
  static constexpr int log_z = 2 * count * terms;  ///< (count)
  static constexpr int shift = log_z + count;      ///< a whole number: from `count` on
                                                   ///< node k is e^((k + first + shift) step)
  static constexpr int panel_size = shift + 1;
  static constexpr double largest_order = 128.0;
  static constexpr int panels = 6 + 127;
};

/// Panels end at 1/16, 1/8, 1/4, 1/2, 1, 2, 3, ...: towards 0 the density of small z varies fast. Without a
/// branch, which a host that looks through a batch would mostly guess wrongly.
KOKKOS_INLINE_FUNCTION int panel_of(double order) {
  return int(order >= 0.0625) + int(order >= 0.125) + int(order >= 0.25) + int(order >= 0.5) +
         static_cast<int>(order);
}
KOKKOS_INLINE_FUNCTION double panel_begin(int panel) {
  if (panel >= 5) return panel - 4.0;
  double begin = 0.0;
  for (int k = 1; k <= panel; ++k) begin = k == 1 ? 0.0625 : 2.0 * begin;
  return begin;
}
KOKKOS_INLINE_FUNCTION double panel_end(int panel) { return panel_begin(panel + 1); }

/// What HankelGrid says of a panel. Takes some milliseconds.
[[nodiscard]] std::vector<double> hankel_panel(int panel);

}  // namespace drogue::options

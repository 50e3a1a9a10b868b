#pragma once

#include <vector>

namespace drogue::reference {

/// Chain of nodes with unknowns u: node k is connected to its neighbours by the conductances c[k] and c[k +
/// 1] and to zero by a shunt s[k], and q[k] is its source: c[k] (u[k] - u[k-1]) + c[k+1] (u[k] - u[k+1]) +
/// s[k] u[k] = q[k].
struct Chain {
  std::vector<double> conductances;  ///< n + 1; those at the ends lead to zero, or in a ring to each other
  std::vector<double> shunts;        ///< n
  bool is_ring = false;              ///< c[0] and c[n] are then the same
  /// Without shunts and conductances of ends u is determined up to a constant: the weights of the nodes in
  /// two means, n. That of the source is subtracted, as a part of each node by its weight, and that of u is
  /// zero. Empty: there are some.
  std::vector<double> weights;
};

/// Unknowns for a source, by Gaussian elimination of the dense matrix with 50 digits: of order n^3. Throws
/// only std::bad_alloc.
[[nodiscard]] std::vector<double> solve_chain(const Chain& chain, const std::vector<double>& source);

}  // namespace drogue::reference

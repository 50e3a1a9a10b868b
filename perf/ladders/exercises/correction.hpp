#pragma once

#include <Kokkos_Core.hpp>

namespace drogue::perf::ladder {

/// Exercise `correction`, a gap in rung 4 of the WENO ladder: w_0/3 (a - 2b + c) + (w_2 - 1/2)/6 (b - 2c + d)
/// from four differences d of neighbours. Here the weights are the linear ones, 0.1 and 0.3, for which a
/// shock oscillates. Give them the indicators of smoothness of Jiang and Shu 1996, eq. (2.17): w_k = l_k /
/// (1e-6 + beta_k)^2 over their sum, with l = 0.1, 0.6, 0.3.
struct CorrectionExercise {
  template <class R>
  KOKKOS_FUNCTION static R of(const R (&d)[4]) {
    const R left = d[0] - d[1], middle = d[1] - d[2], right = d[2] - d[3];
    const double w0 = 0.1, w2 = 0.3;
    return w0 / 3.0 * (left - middle) + (w2 - 0.5) / 6.0 * (middle - right);
  }
};

}  // namespace drogue::perf::ladder

#pragma once

#include "perf/ladders/springs/tension.hpp"

namespace drogue::perf::ladder {

/// Exercise `tension`, a fault in rung 3 of the spring ladder: tensions of a triangle's edges e to its
/// vertex, S_e = w/16 (2 (lambda + mu) w^2/16 n_e sum(n q) + mu (2 q_e - sum(q))). Each edge must feel the
/// changes of the other two. Find the term that is missing.
struct TensionExercise {
  KOKKOS_FUNCTION static Tensions tensions(const EdgeChanges& change, const double* rest, double w,
                                           double two_lambda_mu, double mu) {
    const auto n = [&](int e) { return rest[(e + 1) % 3] + rest[(e + 2) % 3] - rest[e]; };
    double along[3], area_change = 0.0;
    for (int e = 0; e < 3; ++e) area_change += n(e) * change.q[e];
    for (int e = 1; e < 3; ++e)
      along[e] = w / 16.0 * (two_lambda_mu * w * w / 16.0 * n(e) * area_change + 2.0 * mu * change.q[e]);
    return {along[1], along[2]};
  }
};

}  // namespace drogue::perf::ladder

#pragma once

#include <Kokkos_Core.hpp>

namespace drogue::perf::ladder {

/// Exercise `divisions`, from rung 4 to rung 5 of the WENO ladder: the correction with five divisions, three
/// for the weights and two by their sum. Leave one of them. Which products of the squares of `beta` do the
/// weights become when all are multiplied by the same number?
struct DivisionsExercise {
  template <class R>
  KOKKOS_FUNCTION static R of(const R (&d)[4]) {
    const R second[3] = {d[1] - d[0], d[2] - d[1], d[3] - d[2]};
    const R first[3] = {3.0 * d[1] - d[0], d[1] + d[2], d[3] - 3.0 * d[2]};
    constexpr double linear[3] = {0.1, 0.6, 0.3};
    R weight[3];
    for (int k = 0; k < 3; ++k) {
      const R beta = 13.0 / 12.0 * (second[k] * second[k]) + 0.25 * (first[k] * first[k]) + 1e-6;
      weight[k] = R(linear[k]) / (beta * beta);
    }
    const R sum = weight[0] + weight[1] + weight[2];
    return weight[0] / sum * ((1.0 / 3.0) * (second[1] - second[0])) +
           (weight[2] / sum - 0.5) * ((1.0 / 6.0) * (second[2] - second[1]));
  }
};

}  // namespace drogue::perf::ladder

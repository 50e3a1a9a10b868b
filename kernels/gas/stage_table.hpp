#pragma once

#include "kernels/gas/parameters.hpp"

namespace drogue::gas {

inline constexpr int max_stages = 4;

/// One Euler sub-step of a Runge-Kutta method: out = U^n + share (U_in + dt_factor dt L(U_in) - U^n). In this
/// form a state at rest keeps its bits, where the sum of a third and two thirds of it would lose one now and
/// then: 4e-11 of the mass in 10^6 steps.
struct StageWeights {
  double share, dt_factor;
  double boundary;  ///< weight of this stage's flux in U^{n+1} - U^n, in units of dt
  int in, out;      ///< buffers, counted from the one that holds U^n
};

struct StageTable {
  int stages;
  StageWeights stage[max_stages];
};

/// Shu and Osher 1988 (SSP-RK3); Spiteri and Ruuth 2002 (SSPRK(4,3)). U^n is never written: a rejected step
/// costs nothing but its time.
constexpr StageTable stage_table(TimeScheme scheme) {
  if (scheme == TimeScheme::ssprk3)
    return {3,
            {{1.0, 1.0, 1.0 / 6.0, 0, 1}, {0.25, 1.0, 1.0 / 6.0, 1, 2}, {2.0 / 3.0, 1.0, 2.0 / 3.0, 2, 1}}};
  return {4,
          {{1.0, 0.5, 1.0 / 6.0, 0, 1},
           {1.0, 0.5, 1.0 / 6.0, 1, 2},
           {1.0 / 3.0, 0.5, 1.0 / 6.0, 2, 1},
           {1.0, 0.5, 0.5, 1, 2}}};
}

}  // namespace drogue::gas

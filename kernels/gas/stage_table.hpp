#pragma once

#include "kernels/gas/parameters.hpp"

namespace drogue::gas {

inline constexpr int max_stages = 4;

/// One Euler sub-step of a Runge-Kutta method: out = a_n U^n + a_in (U_in + dt_factor dt L(U_in)).
struct StageWeights {
  double a_n, a_in, dt_factor;
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
            {{0.0, 1.0, 1.0, 1.0 / 6.0, 0, 1},
             {0.75, 0.25, 1.0, 1.0 / 6.0, 1, 2},
             {1.0 / 3.0, 2.0 / 3.0, 1.0, 2.0 / 3.0, 2, 1}}};
  return {4,
          {{0.0, 1.0, 0.5, 1.0 / 6.0, 0, 1},
           {0.0, 1.0, 0.5, 1.0 / 6.0, 1, 2},
           {2.0 / 3.0, 1.0 / 3.0, 0.5, 1.0 / 6.0, 2, 1},
           {0.0, 1.0, 0.5, 0.5, 1, 2}}};
}

}  // namespace drogue::gas

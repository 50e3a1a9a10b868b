#pragma once

#include "kernels/gas/parameters.hpp"

namespace drogue::gas {

inline constexpr int max_stages = 4;

/// Euler sub-step of a Runge-Kutta method: out = U^n + share (U_in + dt_factor dt L(U_in) - U^n). This form
/// preserves the bits of a state at rest. A sum of one third and two thirds of it would lose 4e-11 of the
/// mass in 10^6 steps.
struct StageWeights {
  double share, dt_factor;
  double boundary;  ///< weight of the flux of this stage in U^{n+1} - U^n, in units of dt
  int in, out;      ///< buffers, relative to the buffer of U^n
};

struct StageTable {
  int stages;
  StageWeights stage[max_stages];
};

/// Stages of SSP-RK3 (Shu and Osher 1988) or SSPRK(4,3) (Spiteri and Ruuth 2002). No stage writes U^n, so a
/// rejected step needs no restoration. Does not throw.
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

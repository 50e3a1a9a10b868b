#include "kernels/coupling/sheet/corrections.hpp"

#include <algorithm>
#include <cmath>

namespace drogue::coupling {

double standard_edge_inset(DeltaFunction delta, double courant) {
  const double of_cbs43 = std::clamp(0.59 - 0.07 * std::log2(2.0 * courant), 0.45, 0.9);
  // First absolute moments of the autocorrelations of the functions across: 0.467, 0.569 and 0.827 cells.
  const double ratio = delta == DeltaFunction::cbs32 ? 0.82 : delta == DeltaFunction::ib4 ? 1.45 : 1.0;
  return std::min(ratio * of_cbs43, 1.0);
}

}  // namespace drogue::coupling

#pragma once

#include "kernels/flow/schemes.hpp"

namespace drogue::flow {

/// True if direct solvers of the pressure and of implicit diffusion use fast transforms where they can. In
/// the preset exact they do so on request only: FFTW and cuFFT sum in different orders, while products with
/// matrices have one on all backends. Does not throw.
constexpr bool prefers_transforms(PressureSolver solver) {
#if defined(DROGUE_EXACT)
  return solver == PressureSolver::fft;
#else
  return solver != PressureSolver::diagonalization;
#endif
}

}  // namespace drogue::flow
